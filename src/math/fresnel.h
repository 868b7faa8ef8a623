/* math/fresnel.h: reflectance of a smooth interface for unpolarised light. The functions work
 * by value and have no branches, because the hot loops inline them. Cosines refer to the
 * (micro)normal on the incident side, so they are >= 0. Source: pbrt book 9.3.6 (dielectric:
 * Fresnel's equations with Snell's law) and 9.3.7 (conductor: complex index; the form without
 * complex numbers is Born and Wolf, Principles of Optics, 14.2, as in Lagarde's memo on Fresnel
 * equations). */
#ifndef MATH_FRESNEL_H
#define MATH_FRESNEL_H

#include "math/vec.h"

typedef struct vlFresnel {
  float reflected; /* reflectance in [0, 1]; 1 in total internal reflection */
  float root; /* eta times the cosine of the refracted direction; 0 in total internal reflection
               */
} vlFresnel;

/* eta: index on the transmitted side over the index on the incident side, > 0. cos_i is clamped
 * to [0, 1]. With root = eta cos_t = sqrt(eta^2 - sin_i^2) a single division suffices. */
static inline vlFresnel vl_fresnel_dielectric(float cos_i, float eta) {
  float c = cos_i > 1.0f ? 1.0f : cos_i;
  c = c > 0.0f ? c : 0.0f;
  float eta2 = eta * eta;
  float inside = eta2 - (1.0f - c * c);
  float root = __builtin_sqrtf(inside > 0.0f ? inside : 0.0f);
  float dense = eta2 * c;
  float s = c + root, p = dense + root;
  float down = s * p;
  down = 1.0f / (down > VL_MIN_POSITIVE ? down : VL_MIN_POSITIVE);
  float rs = (c - root) * p * down, rp = (dense - root) * s * down;
  float r = 0.5f * (rs * rs + rp * rp);
  /* if root = 0, both are already 1; the select is for cos_i = 0 */
  return (vlFresnel){inside > 0.0f ? r : 1.0f, root};
}

/* Reflectance for the complex index eta + i k relative to vacuum, for one channel. Both are
 * clamped to 1e6, since their powers would overflow. With the usual t1 ... t4: Rs = (t1 -
 * t2)/(t1 + t2) and Rp = Rs (t3 - t4)/(t3 + t4), so their mean is Rs t3/(t3 + t4). t1 is 0 for
 * an index of 1 at grazing angles, and t3 is 0 for an index of 0 at normal incidence. Adding
 * `nonzero` gives the reflectance 1 in these cases instead of 0/0; in all others it is smaller
 * than the rounding. */
static inline float vl_fresnel_conductor(float cos_i, float eta, float k) {
  const float nonzero = 1e-20f;
  float c = cos_i > 1.0f ? 1.0f : cos_i;
  float n = 1e6f < eta ? 1e6f : eta, m = 1e6f < k ? 1e6f : k;
  float c2 = c * c, s2 = 1.0f - c2;
  float n2 = n * n, m2 = m * m;
  float t0 = n2 - m2 - s2;
  float ab = __builtin_sqrtf(t0 * t0 + 4.0f * n2 * m2); /* a^2 + b^2 */
  float a2 = 0.5f * (ab + t0);
  float t2 = 2.0f * c * __builtin_sqrtf(a2 > 0.0f ? a2 : 0.0f);
  float t1 = ab + c2 + nonzero;
  float t3 = c2 * ab + s2 * s2 + nonzero, t4 = t2 * s2;
  return (t1 - t2) * t3 / ((t1 + t2) * (t3 + t4));
}

/* A thin slab of two parallel interfaces, with all orders of interreflection: R + T^2 R + T^2
 * R^3 ... = 2R/(1+R) for T = 1 - R (pbrt book 9.5.1). */
static inline float vl_fresnel_slab(float reflected) {
  return 2.0f * reflected / (1.0f + reflected);
}

#endif
