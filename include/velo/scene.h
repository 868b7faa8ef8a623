/** @file
 * velo/scene.h: the editable description of a world. A scene file or a program adds textures, materials, media, lights
 * and shapes to it; everything is copied. A scene keeps its first error: from then on every vl_scene_add_* returns an
 * id of index 0, and vl_scene_result returns the error. A scene is not thread-safe. */
#ifndef VELO_SCENE_H
#define VELO_SCENE_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/filter.h"
#include "velo/ids.h"
#include "velo/image.h"
#include "velo/light.h"
#include "velo/load.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/sampler.h"
#include "velo/shape.h"
#include "velo/spectrum.h"
#include "velo/texture.h"
#include "velo/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The scene's defs, never null. The scene owns them and what their pointers point at. May be changed until the scene
 * is destroyed. */
VL_API vlSceneDefs *vl_scene_defs(vlScene *scene);
/** Copies camera, image size and crop from another scene of the same context. The objects of the camera's lens are
 * copied, too, so that `from` may be destroyed afterwards. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error);
/** Focuses the scene's camera, which must have a lens of many elements, at a distance from its film, in scene units.
 * ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error);

/** Creates an empty scene. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_create(vlContext *context, vlScene **scene);
/** Null is allowed. */
VL_API void vl_scene_destroy(vlScene *scene);
/** The scene's first error; VL_OK if there is none. error may be null. */
VL_API vlResult vl_scene_result(const vlScene *scene, vlError *error);

/** The size of a scene. */
typedef struct vlSceneInfo {
  /** Numbers of objects. Objects of a group count once, however many instances it has; emissive_shapes also count as
   * shapes. */
  uint64_t shapes, triangles, vertices, textures, materials, lights, emissive_shapes, groups, instances, media;
} vlSceneInfo;
/** Counts the contents of a scene. */
VL_API void vl_scene_info(const vlScene *scene, vlSceneInfo *info);
/** The number of objects of a kind in the scene. family: name of a family of velo/schema.h: "materials", "textures",
 * "media", "lights" or "shapes"; the result for other names is 0. */
VL_API uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind);

#ifdef __cplusplus
}
#endif
#endif
