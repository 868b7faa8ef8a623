/* math/stretch.c: how a linear map changes solid angles around the origin. */
#include "math/stretch.h"

#include <math.h>

#include "math/double3.h"

vlStretch vl_stretch(const double map[16]) {
  vlStretch stretch = {.map = vl_mat4_load(map)};
  double axes[3][3];
  for (int i = 0; i < 3; i++) {
    const double unit[3] = {i == 0, i == 1, i == 2};
    vl_mat4_vector(&stretch.map, unit, axes[i]);
  }
  const double length2 = vl_dot3(axes[0], axes[0]);
  for (int i = 0; i < 3; i++) {
    const double own = vl_dot3(axes[i], axes[i]);
    const double skew = vl_dot3(axes[i], axes[(i + 1) % 3]);
    if (fabs(own - length2) > 1e-4 * length2 || fabs(skew) > 1e-4 * length2)
      stretch.is_skewed = true;
  }
  return stretch;
}

double vl_stretch_at(const vlStretch *stretch, const double direction[3]) {
  if (!stretch->is_skewed)
    return 1;
  double mapped[3];
  vl_mat4_vector(&stretch->map, direction, mapped);
  const double length = vl_norm3(mapped);
  return fabs(vl_determinant3(stretch->map.m)) / (length * length * length);
}
