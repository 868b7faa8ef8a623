/* filter/blackman_harris.c: the window of Blackman and Harris (Harris 1978). */
#include "filter/value.h"

vlFilterValue vl_filter_value_blackman_harris;

double vl_filter_value_blackman_harris(VL_UNUSED const vlPixelFilter *filter, vlFilterAt at) {
  return 0.35875 + 0.48829 * vl_series_sin_pi(at.t + 0.5) +
         0.14128 * vl_series_sin_pi(2 * at.t + 0.5) +
         0.01168 * vl_series_sin_pi(3 * at.t + 0.5);
}
