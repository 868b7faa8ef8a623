/* trace/cast/cast.h: hits of the caller's own rays (velo/rays.h), batch by batch: ids by the
 * accelerator from the rays in float, distances in double from the exact rays. */
#ifndef TRACE_CAST_CAST_H
#define TRACE_CAST_CAST_H

#include "trace/cast/batch.h"
#include "velo/rays.h"

/* What to compute besides the ids, as bits. */
enum {
  VL_CAST_DISTANCE = 1,
  VL_CAST_SURFACE = 2, /* geometric normal, uv */
  VL_CAST_SHADING = 4, /* shading normal */
  VL_CAST_VELOCITY = 8,
  VL_CAST_ON = 16 /* the rays may go on behind their hits */
};

/* The scratch is that of tracers (vl_trace_scratch_begin); for VL_CAST_SHADING it must have
 * been zeroed. Of it a cast uses rays, hits, at, corners, textures and occluders. */
typedef struct vlCastKernels {
  /* The numbers of the rays first to first + n - 1, one each; `other` where the array is not
   * given. */
  void (*read_numbers)(const vlRayArray *from, uint64_t first, uint32_t n, double other,
                       double *to);
  /* The same for three numbers each, which are given. */
  void (*read_vectors)(const vlRayArray *from, uint64_t first, uint32_t n,
                       double to[3][VL_ROW_SIZE]);
  /* Begins to bring the numbers of rays into the cache, which another batch will read. */
  void (*prefetch)(const vlRayArray *from, uint64_t first, uint32_t n);
  /* Raises starts below 0 to 0. Whether all rays can be traced: their numbers (but for times)
   * are finite, directions not 0, ends beyond starts. */
  bool (*check)(vlCastBatch *batch);
  /* Fills what the members of the batch say. Rays are finite, their directions are not 0. */
  void (*prepare)(const vlWorld *world, vlTraceScratch *s, vlCastBatch *batch);
  /* Finds each ray's nearest hit between t_min and t_max. wanted: bits. */
  void (*next)(const vlWorld *world, vlTraceScratch *s, uint32_t wanted, vlCastBatch *batch);
  /* Fills batch->occluded. */
  void (*occluded)(const vlWorld *world, vlTraceScratch *s, vlCastBatch *batch);
  /* Moves the rays that have a hit to the front, without gaps, and sets n. from[k]: where ray k
   * was. */
  void (*keep)(vlTraceScratch *s, vlCastBatch *batch, uint32_t from[VL_ROW_SIZE]);
} vlCastKernels;
VL_KERNEL_TABLE(vlCastKernels, vl_cast)

#endif
