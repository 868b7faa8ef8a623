/* sampler/hammersley.hot.c: the Hammersley points. */
#include "sampler/cells.hot.h"

vlSampler2d vl_sampler_hammersley_2d;

void vl_sampler_hammersley_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  VL_SAMPLER_IN_CHUNKS(vl_hammersley_2d(s, c, u + k, v + k))
}
