/* filter/gaussian.c: a Gaussian that ends at 0. */
#include "filter/value.h"

vlFilterValue vl_filter_value_gaussian;

/* minus its value at the radius */
double vl_filter_value_gaussian(const vlPixelFilter *filter, vlFilterAt at) {
  double s = 0.5 / ((double)filter->sigma * filter->sigma);
  return vl_series_exp(-s * at.x * at.x) - vl_series_exp(-s * at.radius * at.radius);
}
