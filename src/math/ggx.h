/* math/ggx.h: anisotropic Trowbridge-Reitz (GGX) microfacets, sampled by visible normals. The
 * functions work by value and have no branches. All directions have unit length and z >= 0;
 * callers mirror other directions first, because the distribution is even in z.
 *
 * With L(w) = |(alpha_x w.x, alpha_y w.y, w.z)| Smith's functions are short, and finite at
 * grazing angles:
 *     1 + Lambda(w) = (L + z) / 2z,  G1 = 2z / (L + z),
 *     G(o, i) = 1 / (1 + Lambda_o + Lambda_i) = 2 zo zi / (Lo zi + Li zo)
 * (height-correlated; pbrt book 9.6.3).
 * With D the density of normals, for reflection:
 *     f cos_i = F D zi / (2 (Lo zi + Li zo)),  pdf(wi) = D / (2 (Lo + zo)),
 *     f cos_i / pdf = F G/G1.
 * References: Walter et al. 2007; Heitz 2014, 2018; Dupuy and Benyoub 2023 (spherical caps);
 * pbrt book 9.6. */
#ifndef MATH_GGX_H
#define MATH_GGX_H

#include "math/approx.h"
#include "math/vec.h"

/* If both alphas are below this the surface is treated as smooth (as in pbrt's
 * EffectivelySmooth). */
#define VL_GGX_SMOOTH 1e-3f
static inline int vl_ggx_is_smooth(float alpha_x, float alpha_y) {
  return (alpha_x < VL_GGX_SMOOTH) & (alpha_y < VL_GGX_SMOOTH);
}
/* Lower bound of a rough surface's smaller alpha. If the other alpha is VL_GGX_SMOOTH, the
 * density's maximum, 1 / (pi alpha_x alpha_y), is 3e6, whose square is finite too. */
#define VL_GGX_MIN_ALPHA 1e-4f
static inline float vl_ggx_alpha(float alpha) {
  return alpha > VL_GGX_MIN_ALPHA ? alpha : VL_GGX_MIN_ALPHA;
}

/* Alpha after optional regularisation, as pbrt-v4's TrowbridgeReitzDistribution::Regularize. */
static inline float vl_ggx_widened(float alpha) {
  float twice = 2.0f * alpha;
  twice = twice > 0.3f ? 0.3f : twice;
  twice = twice < 0.1f ? 0.1f : twice;
  return alpha < 0.3f ? twice : alpha;
}

/* L(w), defined above. */
static inline float vl_ggx_length(vlVec3 w, float alpha_x, float alpha_y) {
  float x = alpha_x * w.x, y = alpha_y * w.y;
  return __builtin_sqrtf(x * x + y * y + w.z * w.z);
}

/* D(h) G1(w) / w.z = 2 D / (L + z), D the density of microfacet normals per solid angle and per
 * area of the surface. Times w.h it is the density of the normals visible from w. Finite for h
 * = 0 too: unit vectors have e >= 1 and length >= VL_GGX_MIN_ALPHA, far above the bounds. */
static inline float vl_ggx_visible(vlVec3 h, float alpha_x, float alpha_y, float z,
                                   float length) {
  float area = alpha_x * alpha_y, inverse = 1.0f / area;
  float x = h.x * (inverse * alpha_y), y = h.y * (inverse * alpha_x);
  float e = x * x + y * y + h.z * h.z;
  e = e > VL_MIN_FRACTION ? e : VL_MIN_FRACTION;
  float down = length + z;
  return 2.0f * VL_INV_PI /
         (area * (e * e) * (down > VL_MIN_FRACTION ? down : VL_MIN_FRACTION));
}

/* G(wo, wi) / G1(wo): weight of a sample drawn by visible normals, without the Fresnel term.
 * zo, zi > 0. */
static inline float vl_ggx_shadowing(float zo, float lo, float zi, float li) {
  float down = lo * zi + li * zo;
  return zi * (lo + zo) / (down > 0.0f ? down : 1.0f);
}

/* Samples a normal with density D(h) G1(w) (w.h) / w.z. u, v in [0, 1). In the space where the
 * surface is a unit hemisphere, the normal is w plus a direction uniform on the spherical cap
 * that w illuminates. Its z is the cap's z plus w's: no cancellation. */
static inline vlVec3 vl_ggx_sample(vlVec3 w, float alpha_x, float alpha_y, float u, float v) {
  float wx = alpha_x * w.x, wy = alpha_y * w.y, wz = w.z;
  float l2 = wx * wx + wy * wy + wz * wz;
  float s = l2 > 0.0f ? 1.0f / __builtin_sqrtf(l2) : 0.0f;
  wx = wx * s;
  wy = wy * s;
  wz = wz * s;
  vlSinCos phi = vl_sincos_turn(u);
  float hz = (1.0f - v) * (1.0f + wz);
  hz = hz > 1e-7f ? hz : 1e-7f; /* above the surface, even where 1 - v is only 6e-8 */
  float cz = hz - wz;
  float r2 = 1.0f - cz * cz;
  float r = __builtin_sqrtf(r2 > 0.0f ? r2 : 0.0f);
  float hx = alpha_x * (r * phi.cos + wx), hy = alpha_y * (r * phi.sin + wy);
  float n = 1.0f / __builtin_sqrtf(hx * hx + hy * hy + hz * hz);
  return vl_vec3(hx * n, hy * n, hz * n);
}

#endif
