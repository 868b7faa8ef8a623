/* sampler/nrooks.hot.c: one point in each row and each column. */
#include "sampler/cells.hot.h"

vlSampler2d vl_sampler_nrooks_2d;

void vl_sampler_nrooks_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  VL_SAMPLER_IN_CHUNKS(vl_nrooks_2d(s, c, u + k, v + k))
}
