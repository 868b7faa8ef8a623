/* import/far.c: see far.h. */
#include "import/far.h"

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

void vl_grow_box(const float *positions, size_t vertices, double low[3], double high[3]) {
  for (size_t i = 0; i < 3 * vertices; i++) {
    low[i % 3] = fmin(low[i % 3], (double)positions[i]);
    high[i % 3] = fmax(high[i % 3], (double)positions[i]);
  }
}

double vl_box_diagonal(const double low[3], const double high[3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += (high[i] - low[i]) * (high[i] - low[i]);
  return sqrt(sum);
}

bool vl_far_vertices(const float *positions, size_t vertices, double origin[3]) {
  VL_NO_BOX(low, high);
  vl_grow_box(positions, vertices, low, high);
  return vl_far_origin(low, high, origin);
}

void vl_far_place(const double origin[3], vlShapeDef *shape) {
  for (int i = 0; i < 3; i++)
    shape->group_from_shape[4 * i + 3] = origin[i];
}
