/* import/plain.h: defaults shared by the formats of plain geometry (OBJ, PLY). */
#ifndef IMPORT_PLAIN_H
#define IMPORT_PLAIN_H

#include "scene/scene.h"

/* Marks camera and lights as missing: vl_scene_complete adds them. */
void vl_import_plain_settings(vlScene *scene);

#endif
