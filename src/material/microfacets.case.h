/* material/microfacets.case.h: the Torrance-Sparrow model with the distribution of Trowbridge
 * and Reitz (pbrt book 9.6, 9.7), in double, for the cases of metals and of glass. */
#ifndef MATERIAL_MICROFACETS_CASE_H
#define MATERIAL_MICROFACETS_CASE_H

#include <complex.h>
#include <math.h>

static inline double plain_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The density of normals per solid angle. */
static inline double plain_facets(const double m[3], double alpha_x, double alpha_y) {
  const double x = m[0] / alpha_x;
  const double y = m[1] / alpha_y;
  const double length2 = x * x + y * y + m[2] * m[2];
  return 1 / (3.14159265358979 * alpha_x * alpha_y * length2 * length2);
}

static inline double plain_lambda(const double w[3], double alpha_x, double alpha_y) {
  const double x = w[0] * alpha_x;
  const double y = w[1] * alpha_y;
  return (sqrt(1 + (x * x + y * y) / (w[2] * w[2])) - 1) / 2;
}

/* The share of facets that both directions see. */
static inline double plain_seen(const double a[3], const double b[3], double alpha_x,
                                double alpha_y) {
  return 1 / (1 + plain_lambda(a, alpha_x, alpha_y) + plain_lambda(b, alpha_x, alpha_y));
}

/* Fresnel's reflectance; index: relative, that of metals eta + i k. */
static inline double plain_fresnel(double cosine, double complex index) {
  const double complex inside = csqrt(1 - (1 - cosine * cosine) / (index * index));
  const double complex along = (index * cosine - inside) / (index * cosine + inside);
  const double complex across = (cosine - index * inside) / (cosine + index * inside);
  const double a = cabs(along);
  const double b = cabs(across);
  return (a * a + b * b) / 2;
}

/* The unit vector along a * scale + b, on the upper side. */
static inline void plain_half(const double a[3], double scale, const double b[3],
                              double half[3]) {
  for (int k = 0; k < 3; k++)
    half[k] = a[k] * scale + b[k];
  const double length = copysign(sqrt(plain_dot(half, half)), half[2]);
  for (int k = 0; k < 3; k++)
    half[k] /= length;
}

/* BSDF times cosine of reflection where `in` is above, as `out` is. */
static inline double plain_reflection(const double out[3], const double in[3], double alpha_x,
                                      double alpha_y, double complex index) {
  double half[3];
  plain_half(in, 1, out, half);
  return plain_facets(half, alpha_x, alpha_y) * plain_seen(out, in, alpha_x, alpha_y) *
         plain_fresnel(plain_dot(out, half), index) / (4 * out[2]);
}

#endif
