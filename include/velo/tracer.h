/** @file
 * velo/tracer.h: tracers: their kinds. */
#ifndef VELO_TRACER_H
#define VELO_TRACER_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each tracer. Their names in pbrt files are in velo/schema.h. The tracers
 * with light paths (docs/tracers.md) are replaced by VL_TRACER_VOLPATH in scenes with
 * VL_MATERIAL_SUBSURFACE, and for a rolling shutter with motion. */
#define VL_TRACER_KINDS(X)                                                                  \
  X(VL_TRACER_PATH, path) /* ignores media */                                               \
  X(VL_TRACER_RAYCAST, raycast)                                                             \
  X(VL_TRACER_AMBIENT_OCCLUSION, ambient_occlusion)                                         \
  X(VL_TRACER_VOLPATH,                                                                      \
    volpath) /* paths through media and solids; without those, bitwise equal to PATH */     \
  X(VL_TRACER_BIDIRECTIONAL,                                                                \
    bidirectional) /* camera paths, and light paths that connect to the camera; unbiased */ \
  X(VL_TRACER_MERGING,                                                                      \
    merging) /* also merges them at surfaces, in a radius that shrinks each pass */         \
  X(VL_TRACER_SPPM,                                                                         \
    sppm) /* as MERGING, but smooth surfaces do not count as bounces of camera paths */     \
  X(VL_TRACER_LIGHT_PATH, light_path) /* light paths only: smooth surfaces look black */    \
  X(VL_TRACER_RANDOM_WALK,                                                                  \
    random_walk) /* does not sample lights; directions are uniform: for comparison */
/** Light transport algorithms (docs/tracers.md). */
typedef enum vlTracer {
#define VL_KIND(kind, name) kind,
  VL_TRACER_KINDS(VL_KIND)
#undef VL_KIND
} vlTracer;

#ifdef __cplusplus
}
#endif
#endif
