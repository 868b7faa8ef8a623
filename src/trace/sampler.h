/* trace/sampler.h: the sampler of the lecture: numbers in [0, 1) that depend on (seed, pixel, sample index, dimension)
 * alone. Batches: one call fills one dimension (or pair) for n paths. Data flows (pixel, index) -> u.
 *
 * Dimensions are counted in numbers: a 1-D call at dimension d uses d, a 2-D call d and d+1. */
#ifndef TRACE_SAMPLER_H
#define TRACE_SAMPLER_H

#include "base/isa.h"
#include "velo/scene.h"

typedef struct vlSampler {
  vlSamplerKind kind;
  uint32_t seed;
  uint32_t spp;            /* samples a pixel shall get in the end */
  uint32_t width, height;  /* whole picture */
  uint32_t grid_x, grid_y; /* stratified: spp = grid_x * grid_y >= spp asked for; others: derived tables */
  uint32_t log2_spp;
  uint32_t halton_scale[2], halton_exponent[2];
} vlSampler;

/* Any spp >= 1 works with every kind. */
void vl_sampler_init(vlSampler *sampler, vlSamplerKind kind, uint32_t seed, uint32_t width, uint32_t height, uint32_t spp);

/* px, py: pixel; index: sample index in [0, spp). Arrays hold VL_PAD(n) elements; padding lanes are computed too. */
typedef struct vlSamplerKernels {
  void (*get_1d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                 uint32_t dimension, float *u);
  void (*get_2d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                 uint32_t dimension, float *u, float *v);
} vlSamplerKernels;
extern const vlSamplerKernels vl_sampler_kernels_v2, vl_sampler_kernels_v3, vl_sampler_kernels_v4;
const vlSamplerKernels *vl_sampler_kernels(vlIsa isa);

#endif
