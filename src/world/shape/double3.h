/* world/shape/double3.h: vectors of three doubles and affine maps (row-major 3x4), for shapes other than triangles. */
#ifndef WORLD_SHAPE_DOUBLE3_H
#define WORLD_SHAPE_DOUBLE3_H

#include <math.h>

static inline void vl_map_point(const double m[12], const double p[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}
static inline void vl_map_vector(const double m[12], const double v[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
}
static inline void vl_map_normal(const double inverse[12], const double n[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = inverse[i] * n[0] + inverse[4 + i] * n[1] + inverse[8 + i] * n[2];
}
static inline double vl_dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void vl_cross3(const double a[3], const double b[3], double r[3]) {
  r[0] = a[1] * b[2] - a[2] * b[1];
  r[1] = a[2] * b[0] - a[0] * b[2];
  r[2] = a[0] * b[1] - a[1] * b[0];
}
static inline double vl_normalize3(double a[3]) {
  double l = sqrt(vl_dot3(a, a));
  if (l > 0)
    for (int i = 0; i < 3; i++) a[i] /= l;
  return l;
}

static inline double vl_determinant3(const double m[12]) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

#endif
