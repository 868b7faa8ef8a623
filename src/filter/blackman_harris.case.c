/* filter/blackman_harris.case.c: the formula of the pixel filter blackman harris. */
#include "filter/filter.case.h"

static const double CASE_PI = 3.14159265358979323846;

double blackman_harris_filter(const vlPixelFilter *filter, double x, double radius) {
  (void)filter;
  double t = CASE_PI * (x / radius + 1);
  return 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2 * t) - 0.01168 * cos(3 * t);
}
