/** @file
 * velo/export.h: writes a scene to a glTF 2.0 or pbrt-v4 file, as far as the format can hold
 * it. */
#ifndef VELO_EXPORT_H
#define VELO_EXPORT_H

#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Reports a loss: something that the format cannot hold exactly, and how often the scene has
 * it. Called once for each kind of loss, on the calling thread. `what` lives until the callback
 * returns. */
typedef void vlLossReport(void *user, const char *what, uint64_t count);

/** How to write a scene. */
typedef struct vlSaveDef {
  uint32_t cookie;
  bool strict;        /**< a loss is an error, and no file is written; default false */
  vlLossReport *lost; /**< receives the losses; default null */
  void *lost_user;    /**< passed to lost */
} vlSaveDef;
/** The default def. */
VL_API vlSaveDef vl_default_save_def(void);
/** Writes a scene. The suffix selects the format: .gltf (buffer and images in files beside it,
 * named after it), .glb (one file), .pbrt (meshes and images in files beside it). Each file is
 * written whole or not at all. def may be null. Errors: ARGUMENT, IO, MEMORY; UNSUPPORTED with
 * `strict`. */
VL_API vlResult vl_scene_save(const vlScene *scene, const char *path, const vlSaveDef *def,
                              vlError *error);

#ifdef __cplusplus
}
#endif
#endif
