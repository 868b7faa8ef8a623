/** @file
 * velo/scene_base.h: the scene itself, and what its parts have in common: ids, locations in
 * files, labels. A header that only points at parts includes this one instead of all of
 * velo/scene.h.
 */
#ifndef VELO_SCENE_BASE_H
#define VELO_SCENE_BASE_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The description of a world and of how its image is taken. Made from a context, which must
 * outlive it. */
typedef struct vlScene vlScene;

/** Id of a texture. The rules for all ids: index 0 means none, the first object has index 1,
 * and an id is valid in its own scene only. */
typedef struct vlTextureId {
  uint32_t index; /**< from 1; 0: none */
} vlTextureId;
/** Id of a material. */
typedef struct vlMaterialId {
  uint32_t index; /**< from 1; 0: none */
} vlMaterialId;
/** Id of an emission. */
typedef struct vlEmissionId {
  uint32_t index; /**< from 1; 0: none */
} vlEmissionId;
/** Id of a light. */
typedef struct vlLightId {
  uint32_t index; /**< from 1; 0: none */
} vlLightId;
/** Id of a shape. */
typedef struct vlShapeId {
  uint32_t index; /**< from 1; 0: none */
} vlShapeId;
/** Id of a group of shapes. */
typedef struct vlGroupId {
  uint32_t index; /**< from 1; 0: the world itself */
} vlGroupId;
/** Id of an instance. */
typedef struct vlInstanceId {
  uint32_t index; /**< from 1; 0: none */
} vlInstanceId;
/** Id of a participating medium. */
typedef struct vlMediumId {
  uint32_t index; /**< from 1; 0: vacuum */
} vlMediumId;

/** Describes a texture (velo/texture.h). */
typedef struct vlTextureDef vlTextureDef;
/** Describes a material (velo/material.h). */
typedef struct vlMaterialDef vlMaterialDef;
/** Describes a medium (velo/medium.h). */
typedef struct vlMediumDef vlMediumDef;
/** Describes the emission of shapes (velo/light.h). */
typedef struct vlEmissionDef vlEmissionDef;
/** Describes a light (velo/light.h). */
typedef struct vlLightDef vlLightDef;
/** Describes a shape (velo/shape.h). */
typedef struct vlShapeDef vlShapeDef;
/** The defs of camera, film, build, render and develop as the scene's file gives them
 * (velo/render.h). */
typedef struct vlSceneDefs vlSceneDefs;

/** A location in a file, which later errors refer to. `file` is copied. */
typedef struct vlSource {
  const char *file;      /**< path; may be null */
  uint32_t line, column; /**< from 1; 0: not known */
} vlSource;

/** What a file calls a shape, a material or an instance, for ids and messages. Every member may
 * be null. */
typedef struct vlLabel {
  const char *name;  /**< short; the importers give no two shapes, materials or instances of a
                        file the same */
  const char *path;  /**< all names that apply, from the root down, with / between: nodes, mesh,
                        material */
  const char *place; /**< indices in a file without lines: nodes[3].meshes[1].primitives[0] */
} vlLabel;

/** The scene's defs, never null. The scene owns them and what their pointers point at. May be
 * changed until the scene is destroyed. */
VL_API vlSceneDefs *vl_scene_defs(vlScene *scene);
/** Copies camera, image size and crop from another scene of the same context, and whether it
 * has a camera (vlSceneDefs.camera_missing). The objects of the camera's lens are copied, too,
 * so that `from` may be destroyed afterwards. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error);
/** Focuses the scene's camera, which must have a lens of many elements, at a distance from its
 * film, in scene units. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error);

/** Creates an empty scene. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_create(vlContext *context, vlScene **scene);
/** Null is allowed. */
VL_API void vl_scene_destroy(vlScene *scene);
/** The scene's first error; VL_OK if there is none. error may be null. */
VL_API vlResult vl_scene_result(const vlScene *scene, vlError *error);

/** The size of a scene. */
typedef struct vlSceneInfo {
  /** Numbers of objects. Objects of a group count once, however many instances it has;
   * emissive_shapes also count as shapes. */
  uint64_t shapes, triangles, vertices, textures, materials, lights, emissive_shapes, groups,
      instances, media;
  /** Number of lights and emissions given in candela or lumens (vlLoadDef.unit). */
  uint64_t lamps;
} vlSceneInfo;
/** Counts the contents of a scene. */
VL_API void vl_scene_info(const vlScene *scene, vlSceneInfo *info);
/** The number of objects of a kind in the scene. family: name of a family of velo/schema.h:
 * "materials", "textures", "media", "lights" or "shapes"; the result for other names is 0. */
VL_API uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind);

#ifdef __cplusplus
}
#endif
#endif
