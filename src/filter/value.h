/* filter/value.h: for the files of the pixel filters: the value of a filter, and elementary
 * functions by their series, + - * / only, so that the tables of filters are the same on every
 * machine. */
#ifndef FILTER_VALUE_H
#define FILTER_VALUE_H

#include <math.h>

#include "base/attributes.h"
#include "velo/filter.h"

/* A point along an axis: x in [0, radius]; t: x / radius. */
typedef struct vlFilterAt {
  double x, radius, t;
} vlFilterAt;
/* The value of a filter at a point; any factor. */
typedef double vlFilterValue(const vlPixelFilter *filter, vlFilterAt at);

/* 1/k: divisions in the series would be slow */
static const double vl_inverse[26] = {
    0,        1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,  1.0 / 7,  1.0 / 8,
    1.0 / 9,  1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13, 1.0 / 14, 1.0 / 15, 1.0 / 16, 1.0 / 17,
    1.0 / 18, 1.0 / 19, 1.0 / 20, 1.0 / 21, 1.0 / 22, 1.0 / 23, 1.0 / 24, 1.0 / 25};

static inline double vl_series_exp(double x) { /* x <= 0 */
  if (x < -700.0)
    return 0.0;
  int n = (int)(x * 1.4426950408889634 - 0.5);
  double r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10, sum = 1.0;
  for (int k = 15; k > 0; k--)
    sum = 1.0 + sum * (r * vl_inverse[k]);
  for (; n < 0; n++)
    sum *= 0.5;
  return sum;
}
/* sin(pi x); exactly 0 at integers. */
static inline double vl_series_sin_pi(double x) {
  double n = floor(x + 0.5), r = (x - n) * 3.14159265358979323846, r2 = r * r, sum = 1.0;
  for (int k = 22; k > 0; k -= 2)
    sum = 1.0 - sum * (r2 * vl_inverse[k] * vl_inverse[k + 1]);
  sum *= r;
  return n * 0.5 == floor(n * 0.5) ? sum : -sum;
}
static inline double vl_sinc(double x) {
  return fabs(x) < 1e-9 ? 1.0 : vl_series_sin_pi(x) / (3.14159265358979323846 * x);
}

#endif
