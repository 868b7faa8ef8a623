/** @file
 * velo/rays.h: rays of the caller: what each meets in a world, up to k hits along it, and
 * whether anything is in its way. docs/rays.md has examples.
 *
 * A ray is origin + t * direction, in world space, scene units. Its direction may have any
 * length but 0; t, t_min and t_max count lengths of the direction, distances are in scene
 * units. The results have the same bits for any number of threads and any instruction set
 * (with VL_BITS_PORTABLE), and do not depend on which of them are asked for.
 *
 * What counts as a hit is what counts for camera rays and ground truth:
 *   - surfaces whose material is an interface are passed, here and by vl_world_cast_occluded;
 *   - where an opacity (alpha) is between 0 and 1, a hash of ray and surface decides whether
 *     the ray passes: the same ray always gets the same answer, and of many different rays the
 *     share `alpha` is stopped. The same holds for mixtures with an interface;
 *   - surfaces that are one-sided are passed from behind;
 *   - media (fog, clouds) neither stop a ray nor bend it, and rays never refract;
 *   - lights without a surface and the sky are not hit. */
#ifndef VELO_RAYS_H
#define VELO_RAYS_H

#include "velo/world.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { VL_MAX_CAST_HITS = 256 /**< the most hits along a ray */ };

/** Numbers of rays in the caller's memory: floats or doubles in native byte order, those of one
 * ray next to each other. They need not be aligned. */
typedef struct vlRayArray {
  const void *data; /**< the numbers of ray 0; null: not given */
  int64_t step;     /**< bytes from one ray's numbers to the next one's; may be negative; 0: all
                       rays have the same numbers */
  bool doubles;     /**< double; else float */
} vlRayArray;

/** Rays. A ray whose numbers are not finite, whose direction is 0 or whose origin is too far
 * away is not traced: it hits nothing, and is counted (vlCastStats). A ray with t_max <= t_min
 * hits nothing. */
typedef struct vlCastRays {
  uint64_t count;        /**< number of rays */
  vlRayArray origins;    /**< 3 numbers: x, y, z */
  vlRayArray directions; /**< 3 numbers, of any length but 0 */
  vlRayArray t_min;      /**< 1 number: hits count from there on, exclusive; not given: 0; below
                            0: 0 */
  vlRayArray t_max;      /**< 1 number: hits count up to there, inclusive; +infinity is allowed;
                            not given: infinity */
  vlRayArray times;      /**< 1 number: at which time the ray sees the world, seconds; before
                            vlWorldInfo.time_open and after .time_close nothing moves; not
                            given: 0 */
} vlCastRays;

/** Where results go: arrays of the caller with `count` * vlCastDef.hits rows, hit k of ray i at
 * row i * hits + k, sorted by t. Each may be null: it is then not computed. Rows without a hit
 * are 0, t and distance there infinity. */
typedef struct vlCastHits {
  uint8_t *valid;   /**< 1: there is such a hit; else 0 */
  double *t;        /**< in lengths of the direction */
  double *distance; /**< along the ray, scene units */
  double *position; /**< 3: origin + t * direction, world space */
  /** ids as in ground truth (velo/channels.h), from 1; 0: none */
  uint32_t *object, *instance, *primitive, *material;
  float *normal;         /**< 3: geometric, unit, world space, on the surface's outside */
  float *shading_normal; /**< 3: interpolated, with bump and normal maps; unit */
  float *uv;             /**< 2: texture coordinates */
  double *velocity; /**< 3: of the point of the surface, world space, scene units per second */
} vlCastHits;

/** How to trace. */
typedef struct vlCastDef {
  uint32_t cookie;
  uint32_t hits; /**< the most hits along a ray, 1 to VL_MAX_CAST_HITS; default 1. Surfaces that
                    are closer to each other than the rounding errors of a hit (about 1e-6 of
                    the distance) may count as one */
  const vlCancel *cancel; /**< stops the call within one batch of 1024 rays; default null */
  int priority;           /**< as vlRenderDef.priority */
} vlCastDef;
/** The default def. */
VL_API vlCastDef vl_default_cast_def(void);

/** What became of the rays. */
typedef struct vlCastStats {
  uint64_t rays;            /**< vlCastRays.count */
  uint64_t met;             /**< rays with a hit, or occluded */
  uint64_t not_finite;      /**< rays with NaN or infinity (of t_max: NaN), or a direction whose
                               length is not a finite double: not traced */
  uint64_t zero_directions; /**< rays with direction 0 0 0: not traced */
  uint64_t too_far;         /**< rays that start farther than 1.8e18 from the origin along an
                               axis: not traced */
} vlCastStats;

/** Finds the hits of rays, on the workers of the world's context. stats and error may be null.
 * Several threads may call it at once. Must not be called from inside a parallel loop, nor from
 * code of one's own in a render. Errors: ARGUMENT, MEMORY, CANCELLED (some rows are then not
 * written). */
VL_API vlResult vl_world_cast(const vlWorld *world, const vlCastRays *rays,
                              const vlCastDef *def, const vlCastHits *hits, vlCastStats *stats,
                              vlError *error);
/** occluded[i] = 1 if a surface lies on ray i between t_min and t_max, else 0: the same
 * surfaces as those of vl_world_cast, in less time. vlCastDef.hits is not used. Else as
 * vl_world_cast. */
VL_API vlResult vl_world_cast_occluded(const vlWorld *world, const vlCastRays *rays,
                                       const vlCastDef *def, uint8_t *occluded,
                                       vlCastStats *stats, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
