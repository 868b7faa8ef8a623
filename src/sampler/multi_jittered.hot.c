/* sampler/multi_jittered.hot.c: points that are stratified and n-rooks at once (Kensler 2013).
 */
#include "sampler/cells.hot.h"

vlSampler2d vl_sampler_multi_jittered_2d;

void vl_sampler_multi_jittered_2d(VL_SAMPLER_INPUT, float *u, float *v) {
  VL_SAMPLER_IN_CHUNKS(vl_multi_jittered_2d(s, c, u + k, v + k))
}
