/* trace/cast/rays.h: kernels of vlCastKernels (cast.h) for the rays, before they meet anything.
 */
#ifndef TRACE_CAST_RAYS_H
#define TRACE_CAST_RAYS_H

#include "trace/cast/batch.h"
#include "velo/rays.h"

/* As many rays as stay in the first level of the cache from one loop to the next. */
enum { VL_CAST_BLOCK = 128 };

void vl_cast_read_numbers(const vlRayArray *from, uint64_t first, uint32_t n, double other,
                          double *to);
void vl_cast_read_vectors(const vlRayArray *from, uint64_t first, uint32_t n,
                          double to[3][VL_ROW_SIZE]);
void vl_cast_prefetch(const vlRayArray *from, uint64_t first, uint32_t n);
bool vl_cast_check(vlCastBatch *batch);
void vl_cast_prepare(const vlWorld *world, vlTraceScratch *s, vlCastBatch *batch);

#endif
