/* filter/mitchell.c: the cubic filter of Mitchell and Netravali (1988). */
#include "filter/value.h"

vlFilterValue vl_filter_value_mitchell;

static double mitchell(double b, double c, double x) { /* on [0, 2] */
  if (x < 1.0)
    return (((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + (6 - 2 * b)) / 6.0;
  return ((((-b - 6 * c) * x + (6 * b + 30 * c)) * x + (-12 * b - 48 * c)) * x +
          (8 * b + 24 * c)) /
         6.0;
}

double vl_filter_value_mitchell(const vlPixelFilter *filter, vlFilterAt at) {
  return mitchell(filter->b, filter->c, 2.0 * at.t);
}
