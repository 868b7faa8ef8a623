/* sampler/regular.hot.c: centres of the cells of a grid. */
#include "sampler/cells.hot.h"

vlSampler1d vl_sampler_regular_1d;
vlSampler2d vl_sampler_regular_2d;

void vl_sampler_regular_1d(VL_SAMPLER_INPUT, float *u) {
  VL_SAMPLER_IN_CHUNKS(vl_cells_1d(0, s, c, u + k))
}

void vl_sampler_regular_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  VL_SAMPLER_IN_CHUNKS(vl_grid_2d(0, s, c, u + k, v + k))
}
