/* math/double3.h: vectors of three doubles and affine maps (row-major, 3x4 or 4x4), for work
 * outside of hot loops. */
#ifndef MATH_DOUBLE3_H
#define MATH_DOUBLE3_H

#include <math.h>
#include <stdbool.h>

static inline void vl_map_point(const double m[12], const double p[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}
static inline void vl_map_vector(const double m[12], const double v[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
}
/* The same by a map of floats. */
static inline void vl_float_map_point(const float m[12], const double p[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = (double)m[4 * i] * p[0] + (double)m[4 * i + 1] * p[1] + (double)m[4 * i + 2] * p[2] +
           (double)m[4 * i + 3];
}
static inline void vl_float_map_vector(const float m[12], const double v[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = (double)m[4 * i] * v[0] + (double)m[4 * i + 1] * v[1] + (double)m[4 * i + 2] * v[2];
}
static inline void vl_map_normal(const double inverse[12], const double n[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = inverse[i] * n[0] + inverse[4 + i] * n[1] + inverse[8 + i] * n[2];
}
static inline double vl_dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/* Of columns i and j of the 3x3 part. */
static inline double vl_dot_columns(const double m[12], int i, int j) {
  return m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
}
static inline void vl_cross3(const double a[3], const double b[3], double r[3]) {
  r[0] = a[1] * b[2] - a[2] * b[1];
  r[1] = a[2] * b[0] - a[0] * b[2];
  r[2] = a[0] * b[1] - a[1] * b[0];
}
/* r = a - b; it may be one of them. */
static inline void vl_sub3(const double a[3], const double b[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = a[i] - b[i];
}
/* r = p + t d; it may be one of them. */
static inline void vl_along3(const double p[3], double t, const double d[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = p[i] + t * d[i];
}
static inline double vl_norm3(const double a[3]) {
  return sqrt(vl_dot3(a, a));
}
/* The volume that three vectors span: positive if they are right-handed. */
static inline double vl_triple3(const double a[3], const double b[3], const double c[3]) {
  double n[3];
  vl_cross3(b, c, n);
  return vl_dot3(a, n);
}
/* The normal of a triangle, by the order of its corners; its length is twice the area. */
static inline void vl_triangle_normal(const float *a, const float *b, const float *c,
                                      double n[3]) {
  double to_b[3], to_c[3];
  for (int i = 0; i < 3; i++) {
    to_b[i] = (double)b[i] - (double)a[i];
    to_c[i] = (double)c[i] - (double)a[i];
  }
  vl_cross3(to_b, to_c, n);
}
/* Returns the length; a vector of length 0 stays. */
static inline double vl_normalize3(double a[3]) {
  double l = vl_norm3(a);
  if (l > 0)
    for (int i = 0; i < 3; i++)
      a[i] /= l;
  return l;
}
/* r = m v; r is not v. */
static inline void vl_mat3_vector(const double m[9], const double v[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}
static inline double vl_mat3_determinant(const double m[9]) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}
/* Whether the last row of a 4x4 matrix is 0 0 0 1. */
static inline bool vl_is_affine(const double m[16]) {
  return m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
}
/* The 3x3 part of an affine map, and its last column. */
static inline void vl_split_map(const double m[12], double part[9], double last[3]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      part[3 * i + j] = m[4 * i + j];
    last[i] = m[4 * i + 3];
  }
}
/* For qsort: doubles, the smallest first. */
static inline int vl_by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}
/* Of the upper left 3x3. */
static inline double vl_determinant3(const double m[12]) {
  double part[9], last[3];
  vl_split_map(m, part, last);
  return vl_mat3_determinant(part);
}

#endif
