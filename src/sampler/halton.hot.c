/* sampler/halton.hot.c: the Halton sequence. */
#include "sampler/halton.hot.h"

vlSampler1d vl_sampler_halton_1d;
vlSampler2d vl_sampler_halton_2d;

void vl_sampler_halton_1d(VL_SAMPLER_INPUT, float *u) {
  VL_SAMPLER_IN_CHUNKS(vl_halton_1d(s, c, dimension, u + k))
}

void vl_sampler_halton_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  vl_sampler_halton_1d(s, n, px, py, index, dimension, u);
  vl_sampler_halton_1d(s, n, px, py, index, dimension + 1, v);
}
