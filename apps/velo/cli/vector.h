/* cli/vector.h: vectors of three doubles, and 4x4 and 3x3 matrices, row-major. */
#ifndef APP_CLI_VECTOR_H
#define APP_CLI_VECTOR_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* For qsort: numbers, the smallest first. */
static inline int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Whether two numbers are the same but for rounding. */
static inline bool is_near(double a, double b) {
  return a == b || fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

static inline double vector_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector_cross(const double a[3], const double b[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* r = a - b; it may be one of them. */
static inline void vector_subtract(const double a[3], const double b[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = a[i] - b[i];
}

/* r = point + t direction; it may be one of them. */
static inline void vector_along(const double point[3], double t, const double direction[3],
                                double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = point[i] + t * direction[i];
}

static inline double vector_length(const double v[3]) {
  return sqrt(vector_dot(v, v));
}

/* False: the vector has no length, and stays. */
static inline bool vector_normalize(double v[3]) {
  double length = vector_length(v);
  if (!(length > 0))
    return false;
  for (int i = 0; i < 3; i++)
    v[i] /= length;
  return true;
}

/* Two unit vectors orthogonal to v and to each other. */
static inline void vector_across(const double v[3], double a[3], double b[3]) {
  const bool is_across = fabs(v[0]) < 0.7 * vector_length(v);
  const double other[3] = {is_across, !is_across, 0};
  vector_cross(v, other, a);
  vector_normalize(a);
  vector_cross(v, a, b);
  vector_normalize(b);
}

/* The angle between two vectors, radians. */
static inline double vector_angle(const double a[3], const double b[3]) {
  double n[3];
  vector_cross(a, b, n);
  return atan2(vector_length(n), vector_dot(a, b));
}

/* result = a b; it may be one of them. */
static inline void matrix_multiply(const double a[16], const double b[16], double result[16]) {
  double product[16];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double sum = 0;
      for (int k = 0; k < 4; k++)
        sum += a[4 * i + k] * b[4 * k + j];
      product[4 * i + j] = sum;
    }
  memcpy(result, product, sizeof product);
}

/* ---- 3x3 matrices, row-major; the result is none of the arguments ------------------------ */

static inline void matrix3_multiply(const double a[9], const double b[9], double result[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      result[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/* False: the matrix has no inverse. */
static inline bool matrix3_invert(const double m[9], double result[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      result[3 * i + j] = m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
    }
  double determinant = m[0] * result[0] + m[1] * result[3] + m[2] * result[6];
  for (int i = 0; i < 9; i++)
    result[i] /= determinant;
  return fabs(determinant) > 1e-9 && isfinite(determinant);
}

#endif
