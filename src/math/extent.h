/* math/extent.h: boxes along the axes around points. */
#ifndef MATH_EXTENT_H
#define MATH_EXTENT_H

#include <math.h>
#include <stdbool.h>

/* A bounding box; low > high if it is empty. */
typedef struct vlExtent {
  double low[3], high[3];
} vlExtent;

static const vlExtent vl_extent_nothing = {{INFINITY, INFINITY, INFINITY},
                                           {-INFINITY, -INFINITY, -INFINITY}};

static inline bool vl_extent_is_empty(const vlExtent *box) {
  return !(box->low[0] <= box->high[0]);
}
static inline double vl_extent_size(const vlExtent *box, int axis) {
  return box->high[axis] - box->low[axis];
}
/* Grows a box by another one. A NaN is ignored. */
static inline void vl_extent_join(vlExtent *whole, const vlExtent *box) {
  for (int i = 0; i < 3; i++) {
    whole->low[i] = box->low[i] < whole->low[i] ? box->low[i] : whole->low[i];
    whole->high[i] = box->high[i] > whole->high[i] ? box->high[i] : whole->high[i];
  }
}
/* Grows the box `user`, a vlExtent, by a point. */
static inline void vl_extent_grow(void *user, const double p[3]) {
  const vlExtent point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
  vl_extent_join(user, &point);
}
/* Whether a box is within another one. */
static inline bool vl_extent_holds(const vlExtent *whole, const vlExtent *box) {
  bool inside = true;
  for (int i = 0; i < 3; i++)
    inside = inside && box->low[i] >= whole->low[i] && box->high[i] <= whole->high[i];
  return inside;
}
/* Whether a point is inside of a box, not on its faces. */
static inline bool vl_extent_surrounds(const vlExtent *box, const double p[3]) {
  bool inside = true;
  for (int i = 0; i < 3; i++)
    inside = inside && box->low[i] < p[i] && p[i] < box->high[i];
  return inside;
}
/* 0 of an empty box. */
static inline double vl_extent_diagonal(const vlExtent *box) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += (box->high[i] - box->low[i]) * (box->high[i] - box->low[i]);
  return vl_extent_is_empty(box) ? 0 : sqrt(sum);
}
static inline void vl_extent_middle(const vlExtent *box, double middle[3]) {
  for (int i = 0; i < 3; i++)
    middle[i] = 0.5 * (box->low[i] + box->high[i]);
}
/* Corner k of a box, of eight. */
static inline void vl_extent_corner(const vlExtent *box, int k, double corner[3]) {
  for (int i = 0; i < 3; i++)
    corner[i] = k >> i & 1 ? box->low[i] : box->high[i];
}

#endif
