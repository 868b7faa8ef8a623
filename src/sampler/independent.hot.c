/* sampler/independent.hot.c: independent uniform numbers, by a hash. */
#include "sampler/chunk.hot.h"

vlSampler1d vl_sampler_independent_1d;
vlSampler2d vl_sampler_independent_2d;

void vl_sampler_independent_1d(VL_SAMPLER_INPUT, float *u) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    u[i] = vl_unit_float(vl_hash2(vl_pixel_key(px[i], py[i], seed), index[i]));
  }
}

void vl_sampler_independent_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key = vl_pixel_key(px[i], py[i], seed);
    u[i] = vl_unit_float(vl_hash2(key, index[i]));
    v[i] = vl_unit_float(vl_hash2(vl_hash(key + 0x68e31da4u), index[i]));
  }
}
