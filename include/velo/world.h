/** @file
 * velo/world.h: the world: a compiled scene. */
#ifndef VELO_WORLD_H
#define VELO_WORLD_H

#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A compiled scene. It never changes, so any number of threads and renders may share it. Its
 * context must outlive it. */
typedef struct vlWorld vlWorld;
/** How a path represents radiance: at 4 sampled wavelengths, or as R, G, B. */
typedef enum vlColorMode { VL_COLOR_SPECTRAL, VL_COLOR_RGB } vlColorMode;
/** How a light is selected: by a light BVH (pbrt book 12.6), by power, uniformly. */
typedef enum vlLightSampler {
  VL_LIGHT_SAMPLER_BVH,
  VL_LIGHT_SAMPLER_POWER,
  VL_LIGHT_SAMPLER_UNIFORM
} vlLightSampler;
/** The guarantee for the image's bits. PORTABLE: the same scene, options and version give the
 * same bits on every x86-64 machine and for any number of threads; a crop has the same pixels
 * as the whole image. FAST: the bits are the same only on machines for which Embree, which
 * finds the surfaces, selects the same instruction set. Between other machines a few pixels
 * differ, where surfaces are coplanar or a ray meets an edge.
 * docs/decisions/0013-the-bits-of-embree.md has measurements. */
typedef enum vlBits { VL_BITS_PORTABLE, VL_BITS_FAST } vlBits;
/** What finds the surfaces that rays meet: the library EMBREE, or velo's own tree BVH, which
 * runs everywhere and takes longer. With VL_BITS_PORTABLE both give the same bits
 * (docs/decisions/0022-a-portable-accelerator.md). AUTO: Embree, if velo was built with it and,
 * for VL_BITS_PORTABLE, on x86-64, where its instruction set can be chosen; else BVH. */
typedef enum vlAccelerator {
  VL_ACCELERATOR_AUTO,
  VL_ACCELERATOR_EMBREE,
  VL_ACCELERATOR_BVH
} vlAccelerator;
/** How to compile a scene. */
typedef struct vlBuildDef {
  uint32_t cookie;
  vlColorMode color;            /**< spectral (default) or RGB */
  vlLightSampler light_sampler; /**< default BVH */
  bool imitate_pbrt; /**< reproduce known errors of pbrt-v4, which for example makes rough coats
                        up to 8 % too bright (docs/decisions) */
  /** Path and volume tracers: increase the roughness of the materials that a path meets after
   * its first non-specular scattering (pbrt-v4's regularize: alphas below 0.3 are doubled and
   * clamped to the range 0.1 to 0.3). This removes fireflies from caustics, and also part of
   * their light. Default false. */
  bool regularize;
  /** Default VL_BITS_PORTABLE. The environment variable VELO_EMBREE=sse4.2|avx|avx2|avx512
   * forces Embree's instruction set, for tests. VL_BITS_PORTABLE accepts only the first two.
   * The build returns UNSUPPORTED for a set that is not accepted or that the machine lacks. */
  vlBits bits;
  /** Default VL_ACCELERATOR_AUTO. The build returns UNSUPPORTED for EMBREE where AUTO would not
   * choose it. */
  vlAccelerator accelerator;
  /** A world of the same context. What has not changed since is shared with it: meshes, their
   * part of the accelerator, images, tables of materials. The result is the same, bit for bit,
   * as without it. Things of one scene are recognised by their ids (velo/edit.h), those of a
   * scene that was loaded again by their contents. Image files are read again if size or time
   * of modification differ. `previous` may be destroyed before or after the new world. It is
   * ignored if color, bits or imitate_pbrt differ. Default null. */
  const vlWorld *previous;
  const vlCancel *cancel; /**< stops the build; default null */
  vlStepFn *progress;     /**< default null */
  void *progress_user;    /**< passed to progress */
} vlBuildDef;
/** The default def. */
VL_API vlBuildDef vl_default_build_def(void);
/** Compiles the scene and reads the images that it names. The scene may be destroyed
 * afterwards. def may be null. Errors: ARGUMENT, the error of vl_scene_result, SCENE (with the
 * line), MISSING (images), IO, MEMORY, UNSUPPORTED. *world is null after an error. */
VL_API vlResult vl_world_build(const vlScene *scene, const vlBuildDef *def, vlWorld **world,
                               vlError *error);
/** As vl_world_build, for the last build of a scene. It needs less memory: the scene's meshes
 * are freed as soon as the world has copied them, before the accelerator is built. Later builds
 * of the same scene return ARGUMENT. */
VL_API vlResult vl_world_build_last(vlScene *scene, const vlBuildDef *def, vlWorld **world,
                                    vlError *error);
/** Null is allowed. */
VL_API void vl_world_destroy(vlWorld *world);
/** The size of a world. */
typedef struct vlWorldInfo {
  uint64_t triangles, primitives; /**< counts; primitives include the triangles; a group's
                                     primitives count once, however many instances it has */
  uint64_t instances, lights;     /**< counts; each emissive primitive counts as a light */
  uint64_t texture_bytes; /**< bytes of the texture images, including their MIP levels */
  uint64_t bytes; /**< bytes that the context held at the end of the build: with the scene's,
                     without Embree's */
  float bounds_min[3], bounds_max[3]; /**< corners of the bounding box, world space */
  double build_seconds;               /**< duration of the build */
  bool moves; /**< something moves: between the two following times only */
  /** first and last time of a motion, seconds; 0: nothing moves */
  double time_open, time_close;
} vlWorldInfo;
/** Fills *info. */
VL_API void vl_world_info(const vlWorld *world, vlWorldInfo *info);

#ifdef __cplusplus
}
#endif
#endif
