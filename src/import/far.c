/* import/far.c: see far.h. */
#include "import/far.h"

#include <math.h>

bool vl_far_origin(const double low[3], const double high[3], double origin[3]) {
  const double far = 100;
  double size = 0, most = 0;
  for (int i = 0; i < 3; i++) {
    const double middle = 0.5 * (low[i] + high[i]);
    size = fmax(size, high[i] - low[i]);
    most = fmax(most, fabs(middle));
    origin[i] = floor(middle + 0.5);
  }
  if (size > 0 && most >= VL_FAR_LEAST && most > far * size && isfinite(most + size))
    return true;
  origin[0] = origin[1] = origin[2] = 0;
  return false;
}

bool vl_far_vertices(const float *positions, size_t vertices, double origin[3]) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t i = 0; i < 3 * vertices; i++) {
    low[i % 3] = fmin(low[i % 3], (double)positions[i]);
    high[i % 3] = fmax(high[i % 3], (double)positions[i]);
  }
  return vl_far_origin(low, high, origin);
}

void vl_far_place(const double origin[3], vlShapeDef *shape) {
  for (int i = 0; i < 3; i++)
    shape->group_from_shape[4 * i + 3] = origin[i];
}
