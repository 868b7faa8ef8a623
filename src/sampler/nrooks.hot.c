/* sampler/nrooks.hot.c: one point in each row and each column. */
#include "sampler/cells.hot.h"

vlSampler1d vl_sampler_nrooks_1d;
vlSampler2d vl_sampler_nrooks_2d;

void vl_sampler_nrooks_1d(VL_SAMPLER_INPUT, float *u) {
  VL_SAMPLER_IN_CHUNKS(vl_cells_1d(1, s, c, u + k))
}

void vl_sampler_nrooks_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  VL_SAMPLER_IN_CHUNKS(vl_nrooks_2d(s, c, u + k, v + k))
}
