/* filter/lanczos.case.c: the formula of the pixel filter lanczos. */
#include "filter/filter.case.h"

static const double CASE_PI = 3.14159265358979323846;

static double sinc_of(double x) {
  return x == 0 ? 1 : sin(CASE_PI * x) / (CASE_PI * x);
}

double lanczos_filter(const vlPixelFilter *filter, double x, double radius) {
  (void)radius;
  return sinc_of(x) * sinc_of(x / (double)filter->tau);
}
