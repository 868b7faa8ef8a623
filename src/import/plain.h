/* import/plain.h: defaults shared by formats that hold geometry alone (OBJ, PLY). */
#ifndef IMPORT_PLAIN_H
#define IMPORT_PLAIN_H

#include "scene/scene.h"

/* Marks camera and lights as missing, so that vl_scene_complete adds them. */
void vl_import_plain_settings(vlScene *scene);

#endif
