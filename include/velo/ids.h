/** @file
 * velo/ids.h: what a description is made of: ids of its parts, places in files, labels. A scene (velo/scene.h)
 * gives the ids. */
#ifndef VELO_IDS_H
#define VELO_IDS_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The description of a world and of how its image is taken. Made from a context, which must outlive it. */
typedef struct vlScene vlScene;

/** Id of a texture. The rules for all ids: index 0 means none, the first object has index 1, and an id is valid in its
 * own scene only. */
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

/* The defs, which describe one part each: velo/texture.h, material.h, medium.h, light.h, shape.h. A header that only
 * points at them includes this one. */
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
/** The defs of camera, film, build, render and develop as the scene's file gives them (velo/render.h). */
typedef struct vlSceneDefs vlSceneDefs;

/** A place in a file, which later errors refer to. `file` is copied. */
typedef struct vlSource {
  const char *file;      /**< path; may be null */
  uint32_t line, column; /**< from 1; 0: not known */
} vlSource;

/** What a file calls a shape, a material or an instance, for ids and messages. Every member may be null. */
typedef struct vlLabel {
  const char *name;  /**< short; the importers give no two shapes, materials or instances of a file the same */
  const char *path;  /**< all names that apply, from the root down, with / between: nodes, mesh, material */
  const char *place; /**< indices in a file without lines: nodes[3].meshes[1].primitives[0] */
} vlLabel;

#ifdef __cplusplus
}
#endif
#endif
