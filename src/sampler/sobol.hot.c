/* sampler/sobol.hot.c: padded Sobol' points. */
#include "sampler/sobol.hot.h"

vlSampler1d vl_sampler_sobol_1d;
vlSampler2d vl_sampler_sobol_2d;

void vl_sampler_sobol_1d(VL_SAMPLER_INPUT, float *u) {
  vl_sobol_pixel(0, s, n, px, py, index, dimension, u, u);
}

void vl_sampler_sobol_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  vl_sobol_pixel(1, s, n, px, py, index, dimension, u, v);
}
