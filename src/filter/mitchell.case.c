/* filter/mitchell.case.c: the formula of the pixel filter mitchell. */
#include "filter/filter.case.h"

double mitchell_filter(const vlPixelFilter *filter, double x, double radius) {
  double b = (double)filter->b;
  double c = (double)filter->c;
  double t = 2 * x / radius;
  double near = (12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + 6 - 2 * b;
  double far = (-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t +
               8 * b + 24 * c;
  return t < 1 ? near : far;
}
