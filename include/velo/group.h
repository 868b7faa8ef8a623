/** @file
 * velo/group.h: loads a model's file as one group of a scene, which instances place. */
#ifndef VELO_GROUP_H
#define VELO_GROUP_H

#include "velo/base.h"
#include "velo/load.h"
#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What vl_scene_load_group made. */
typedef struct vlLoadedGroup {
  vlGroupId group;        /**< all shapes of the file */
  uint32_t shapes;        /**< their number */
  uint32_t first_object;  /**< the id.object of the first; the others follow */
  double low[3], high[3]; /**< the bounding box, in the group's space: the world space of the
                             file; scene units */
  /** what the group lacks: lights of the file; emission of its surfaces */
  uint32_t lights, emitters;
} vlLoadedGroup;

/** Adds a new group with the shapes of a file, placed as in the file's own world space;
 * instances of the file are copied, moving ones at their first time. Camera, lights,
 * environment and image size of the file are ignored, as is the emission of its surfaces;
 * *loaded counts them. Materials and textures become the scene's. def: as for vl_scene_load.
 * name: the name of the group, and of its instances for vl_world_id_info; null: none. Errors:
 * as vl_scene_load; SCENE: the file has no shapes. */
VL_API vlResult vl_scene_load_group(vlScene *scene, const char *path, const vlLoadDef *def,
                                    const char *name, vlLoadedGroup *loaded, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
