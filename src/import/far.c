/* import/far.c: see far.h. */
#include "import/far.h"

bool vl_far_origin(const vlExtent *box, double origin[3]) {
  const double far = 100;
  double size = 0, max = 0, middle[3];
  vl_extent_middle(box, middle);
  for (int i = 0; i < 3; i++) {
    size = fmax(size, vl_extent_size(box, i));
    max = fmax(max, fabs(middle[i]));
    origin[i] = floor(middle[i] + 0.5);
  }
  if (size > 0 && max >= VL_MIN_FAR && max > far * size && isfinite(max + size))
    return true;
  origin[0] = origin[1] = origin[2] = 0;
  return false;
}

void vl_grow_box(const float *positions, size_t vertices, vlExtent *box) {
  for (size_t i = 0; i < vertices; i++) {
    const float *v = positions + 3 * i;
    vl_extent_grow(box, (double[3]){v[0], v[1], v[2]});
  }
}

bool vl_far_vertices(const float *positions, size_t vertices, double origin[3]) {
  vlExtent box = vl_extent_nothing;
  vl_grow_box(positions, vertices, &box);
  return vl_far_origin(&box, origin);
}

void vl_far_place(const double origin[3], vlShapeDef *shape) {
  for (int i = 0; i < 3; i++)
    shape->group_from_shape[4 * i + 3] = origin[i];
}
