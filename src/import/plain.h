/* import/plain.h: what formats of plain geometry (OBJ, PLY) share. */
#ifndef IMPORT_PLAIN_H
#define IMPORT_PLAIN_H

#include "scene/scene.h"

/* No camera and no light: the scene asks for them (vl_scene_complete). */
void vl_import_plain_settings(vlScene *scene);

#endif
