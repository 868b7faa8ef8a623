/** @file
 * velo/export.h: a scene to a file: glTF 2.0 and pbrt-v4, each as far as it can hold what the scene has. */
#ifndef VELO_EXPORT_H
#define VELO_EXPORT_H

#include "velo/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Something that the format cannot hold, or only nearly; how often it was met. Once for each kind. */
typedef void vlLossReport(void *user, const char *what, uint64_t count);

typedef struct vlSaveDef {
  uint32_t cookie;
  bool strict; /**< a loss is an error, and nothing is written */
  vlLossReport *lost;
  void *lost_user;
} vlSaveDef;
VL_API vlSaveDef vl_default_save_def(void);
/** The suffix chooses: .gltf (buffer and images beside it, named after it), .glb (all in one), .pbrt (meshes and
 * images beside it). Each file is written whole or not at all. def may be null. Errors: ARGUMENT, IO, MEMORY;
 * UNSUPPORTED with `strict`. */
VL_API vlResult vl_scene_save(const vlScene *scene, const char *path, const vlSaveDef *def, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
