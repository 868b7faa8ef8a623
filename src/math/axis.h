/* math/axis.h: axes of vectors. */
#ifndef MATH_AXIS_H
#define MATH_AXIS_H

#include <math.h>

/* The axis along which the vector is shortest. */
static inline int vl_least_axis3(const double a[3]) {
  const double x = fabs(a[0]), y = fabs(a[1]), z = fabs(a[2]);
  return x < y ? (x < z ? 0 : 2) : y < z ? 1 : 2;
}

#endif
