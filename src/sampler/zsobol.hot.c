/* sampler/zsobol.hot.c: Sobol' points in the order of a Morton curve over the image. */
#include "sampler/sobol.hot.h"

vlSampler1d vl_sampler_zsobol_1d;
vlSampler2d vl_sampler_zsobol_2d;

void vl_sampler_zsobol_1d(VL_SAMPLER_INPUT, float *u) {
  vl_zsobol(0, s, n, px, py, index, dimension, u, u);
}

void vl_sampler_zsobol_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  vl_zsobol(1, s, n, px, py, index, dimension, u, v);
}
