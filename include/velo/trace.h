/** @file
 * velo/trace.h: a tracer of one's own: a function that turns rays into radiance. It asks the
 * world for hits, surfaces, lights and materials, for a whole batch of rays at once.
 * docs/own-code.md has complete examples.
 *
 * All arrays have VL_OWN_BATCH elements; lane i is element i, and belongs to the same path in
 * every array of a call. Radiance has 4 channels: in a spectral world the path's 4 wavelengths;
 * in an RGB world red, green, blue, and a channel that is not used. Positions and directions
 * are in world space, scene units, float. Everything said in velo/own.h about threads, bits and
 * NaN holds here, too. */
#ifndef VELO_TRACE_H
#define VELO_TRACE_H

#include "velo/own.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A batch of paths that is being traced: its world, its wavelengths, its numbers, and the hits
 * that vl_world_trace found last. It is the worker's working memory: valid during the call of
 * the tracer, on its thread. The functions below allocate nothing and cannot fail. */
typedef struct vlTrace vlTrace;

/** Rays. Lanes from `count` on are not read. */
typedef struct vlTraceRays {
  uint32_t count;                   /**< number of lanes */
  float origin[3][VL_OWN_BATCH];    /**< x, y, z of each lane */
  float direction[3][VL_OWN_BATCH]; /**< of unit length; of shadow rays (vlTraceLights): of any
                                       length */
  /** The part of the ray that counts, in lengths of its direction. t_max < 0: the lane has no
   * ray. */
  float t_min[VL_OWN_BATCH], t_max[VL_OWN_BATCH];
  float width[VL_OWN_BATCH]; /**< width of the ray's footprint at its origin, scene units, for
                                textures; 0: sharp */
} vlTraceRays;

/** The nearest hits of rays. */
typedef struct vlTraceHits {
  uint32_t count;        /**< that of the rays */
  float t[VL_OWN_BATCH]; /**< distance along the ray; infinity: nothing was hit, and all but
                            emission is 0 */
  float position[3][VL_OWN_BATCH]; /**< the point on the surface */
  float normal[3][VL_OWN_BATCH];   /**< of the surface itself, unit, on the side of the ray's
                                      origin */
  float shading[3][VL_OWN_BATCH];  /**< the material's: interpolated, with bump and normal maps;
                                      unit; its side is that of the surface's outside */
  float uv[2][VL_OWN_BATCH];       /**< texture coordinates */
  /** ids as in ground truth (velo/channels.h); 0: nothing */
  uint32_t object[VL_OWN_BATCH], material[VL_OWN_BATCH];
  float reflectance[4][VL_OWN_BATCH]; /**< the material's reflectance there; 1 for materials
                                         that have none */
  /** radiance that a light sends along the ray: the surface that was hit, or the infinite
   * lights where nothing was hit */
  float emission[4][VL_OWN_BATCH];
} vlTraceHits;

/** Samples of the direct light at the hits: one each. */
typedef struct vlTraceLights {
  float direction[3][VL_OWN_BATCH]; /**< towards the light, unit */
  float radiance[4][VL_OWN_BATCH];  /**< radiance that arrives from there if nothing is in
                                       between, divided by pdf */
  float pdf[VL_OWN_BATCH];     /**< density of the sample, per steradian; 0: there is none, and
                                  radiance is 0 */
  uint8_t delta[VL_OWN_BATCH]; /**< 1: light from a single point or direction, which no other
                                  ray can meet */
  vlTraceRays rays;            /**< the way to the light, for vl_world_occluded */
} vlTraceLights;

/** Directions in which paths go on from the hits: one each, sampled by the material. Lanes
 * without a hit have weight and pdf 0. */
typedef struct vlTraceBounce {
  float weight[4][VL_OWN_BATCH]; /**< BSDF times cosine, divided by pdf; 0: the path ends */
  float pdf[VL_OWN_BATCH];       /**< density of the direction, per steradian; of specular ones:
                                    the probability of the choice */
  uint8_t specular[VL_OWN_BATCH]; /**< 1: a mirror or smooth glass; samples of lights do not see
                                     it */
  vlTraceRays rays;               /**< for vl_world_trace; no ray where the weight is 0 */
} vlTraceBounce;

/** Finds the nearest hits of rays, through surfaces that have no material (interfaces). The
 * functions below then ask about these hits. */
VL_API void vl_world_trace(vlTrace *trace, const vlTraceRays *rays, vlTraceHits *hits);
/** occluded[i] is 1 if a surface lies on ray i, between t_min and t_max; else, and in lanes
 * without a ray, 0. Interfaces do not count. The last hits stay. */
VL_API void vl_world_occluded(vlTrace *trace, const vlTraceRays *rays,
                              uint8_t occluded[VL_OWN_BATCH]);
/** Makes rays that leave the last hits in these directions (3 rows: x, y, z; unit), without
 * hitting the surface that they leave; t_max is infinite. Lanes without a hit get no ray. */
VL_API void vl_trace_leave(vlTrace *trace, float (*direction)[VL_OWN_BATCH], vlTraceRays *rays);
/** Samples a light for each of the last hits. bounce: 0 for hits of the camera's rays; selects
 * the numbers. */
VL_API void vl_trace_lights(vlTrace *trace, uint32_t bounce, vlTraceLights *lights);
/** value (4 rows): the last hits' BSDF for light that arrives from these directions (3 rows;
 * unit), times the cosine. pdf (VL_OWN_BATCH numbers; may be null): the density with which
 * vl_trace_bounce samples them, per steradian. Both are 0 for mirrors and where nothing was
 * hit. */
VL_API void vl_trace_bsdf(vlTrace *trace, float (*direction)[VL_OWN_BATCH],
                          float (*value)[VL_OWN_BATCH], float *pdf);
/** Samples the last hits' BSDF. bounce: as for vl_trace_lights. */
VL_API void vl_trace_bounce(vlTrace *trace, uint32_t bounce, vlTraceBounce *next);
/** Numbers in [0, 1) of the render's sampler, a pair for each lane, for the tracer's own use.
 * u, v: VL_OWN_BATCH numbers each; v may be null. Pairs of different `purpose`, from 0 to 2^19
 * - 1, are independent, also of those that the other functions use. */
VL_API void vl_trace_numbers(vlTrace *trace, uint32_t purpose, float *u, float *v);

/** The paths that a tracer computes. */
typedef struct vlOwnPaths {
  uint32_t count;          /**< number of lanes */
  const vlTraceRays *rays; /**< the camera's rays */
  const int32_t *x, *y;    /**< their pixels */
  const uint32_t *index;   /**< index of the sample in its pixel */
  const float *time;       /**< time in the world's motion, 0 to 1; null if nothing moves */
  const float (*lambda)[VL_OWN_BATCH]; /**< 4 rows: wavelengths, nm; null in an RGB world */
  const float (*white)[VL_OWN_BATCH]; /**< 4 rows: the channels of white light of luminance 1 */
  uint32_t max_depth;                 /**< vlRenderDef.max_depth */
  float (*radiance)[VL_OWN_BATCH];    /**< output: 4 rows; 0 before the call */
  /** Output: 1 where the path meets a surface, else 0. The first vl_world_trace sets it; the
   * tracer may change it. */
  float *alpha;
} vlOwnPaths;
/** Computes the radiance of a batch of paths. */
typedef void vlOwnRadianceFn(void *user, vlTrace *trace, const vlOwnPaths *paths);

/** A tracer of one's own, for vlRenderDef.own_tracer. The name is as that of vlOwnCamera. */
typedef struct vlOwnTracer {
  const char *name;          /**< required; it must live as long as the tracer */
  vlOwnRadianceFn *radiance; /**< required */
  void *user;                /**< passed to radiance */
} vlOwnTracer;

#ifdef __cplusplus
}
#endif
#endif
