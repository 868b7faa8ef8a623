/* filter/gaussian.case.c: the formula of the pixel filter gaussian. */
#include "filter/filter.case.h"

double gaussian_filter(const vlPixelFilter *filter, double x, double radius) {
  double twice = 2 * (double)filter->sigma * (double)filter->sigma;
  return exp(-x * x / twice) - exp(-radius * radius / twice);
}
