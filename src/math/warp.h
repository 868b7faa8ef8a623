/* math/warp.h: maps from the unit square to disks, hemispheres, cones, triangles and spherical
 * triangles. Uniform (u, v) in [0,1)^2 give the stated density. All maps have low
 * distortion, so that well-distributed points stay well distributed. The functions have no
 * branches and do not call libm, so hot loops can use them. The map of the whole sphere for
 * environment images is math/octahedral.h.
 *
 * Directions are local, z up. Sources: pbrt book appendix A.5; others are given at the
 * function. */
#ifndef MATH_WARP_H
#define MATH_WARP_H

#include "math/approx.h"
#include "math/vec.h"

#define VL_INV_2PI 0.15915494309189533577f
#define VL_INV_4PI 0.07957747154594766788f

/* ---- unit disk: density 1 / pi ----------------------------------------------------------- */

/* Concentric squares to concentric circles (Shirley and Chiu 1997). r: signed distance from the
 * centre. */
typedef struct vlDiskPoint {
  float x, y, r;
} vlDiskPoint;
static inline vlDiskPoint vl_warp_disk(float u, float v) {
  float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  int flat = vl_abs(a) > vl_abs(b);
  float r = flat ? a : b, other = flat ? b : a;
  /* in [-1, 1]: the angle in eighths of a turn, from the nearer axis */
  float t = other / (r == 0.0f ? 1.0f : r);
  vlSinCos k = vl_sincos_kernel(0.785398163397448310f * t);
  float along = r * k.cos, across = r * k.sin;
  return (vlDiskPoint){flat ? along : across, flat ? across : along, r};
}

/* ---- hemisphere and sphere --------------------------------------------------------------- */

/* Density cos(theta) / pi (Malley's method). z is accurate to the last bits near the horizon
 * too. */
static inline vlVec3 vl_warp_cosine_hemisphere(float u, float v) {
  vlDiskPoint d = vl_warp_disk(u, v);
  float z = vl_safe_sqrt((1.0f - d.r) * (1.0f + d.r));
  return vl_vec3(d.x, d.y, z);
}

/* Density 1 / (2 pi (1 - cos_max)) in the cone around z. The argument is 1 - cos_max, which
 * stays accurate for small cones: sin^2 / (1 + cos). 1: hemisphere; 2: sphere. An equal-area
 * lift of the disk. */
static inline vlVec3 vl_warp_cone(float u, float v, float one_minus_cos_max) {
  vlDiskPoint d = vl_warp_disk(u, v);
  float h = d.r * d.r * one_minus_cos_max; /* 1 - z */
  float s = __builtin_sqrtf(one_minus_cos_max * vl_max(0.0f, 2.0f - h));
  return vl_vec3(d.x * s, d.y * s, 1.0f - h);
}
static inline vlVec3 vl_warp_hemisphere(float u, float v) { /* density 1 / (2 pi) */
  return vl_warp_cone(u, v, 1.0f);
}
/* Density 1 / (4 pi). Cylindrical map: u gives the height, v the azimuth. */
static inline vlVec3 vl_warp_sphere(float u, float v) {
  float r = 2.0f * vl_safe_sqrt(u * (1.0f - u));
  vlSinCos a = vl_sincos_turn(v);
  return vl_vec3(r * a.cos, r * a.sin, 1.0f - 2.0f * u);
}

/* ---- triangle: density 1 / area ---------------------------------------------------------- */

/* Barycentric coordinates of the first two corners (Heitz 2019, "A Low-Distortion Map Between
 * Triangle and Square"). */
static inline vlVec2 vl_warp_triangle(float u, float v) {
  float less = 0.5f * vl_min(u, v), rest = vl_max(u, v) - less;
  int upper = u < v;
  return (vlVec2){upper ? less : rest, upper ? rest : less};
}

/* ---- spherical triangle: density 1 / solid angle ----------------------------------------- */

/* A spherical triangle seen from the origin. After Arvo 1995, "Stratified Sampling of Spherical
 * Triangles", but without computing angles. c' = cos(s) a + sin(s) t lies on the arc from a to
 * c. Van Oosterom and Strackee's (1983) solid angle of (a, b, c'),
 *     tan(area / 2) = det(a, b, c') / (1 + a.b + b.c' + c'.a),
 * solved for s, is
 *     tan(s / 2) = (1 + a.b) tan / (det(a, b, t) - b.t tan).
 * This needs no inverse cosine and loses no precision for small triangles except by the
 * rounding of their corners (6e-8 / size; below a solid angle of about 1e-6 sample the area
 * instead). */
typedef struct vlSphericalTriangle {
  vlVec3 a, b, t;
  float solid_angle;
  float one_plus_ab, det, bt;
} vlSphericalTriangle;
/* a, b, c of unit length. Degenerate triangles have solid angle 0 and must not be sampled. */
static inline vlSphericalTriangle vl_spherical_triangle(vlVec3 a, vlVec3 b, vlVec3 c) {
  vlVec3 ab = vl_sub(b, a), ac = vl_sub(c, a), n = vl_cross(ab, ac);
  vlVec3 t = vl_normalize(vl_sub(ac, vl_mul(a, vl_dot(a, ac))));
  float one_plus_ab = 1.0f + vl_dot(a, b);
  float half = vl_atan2(vl_abs(vl_dot(a, n)), one_plus_ab + vl_dot(b, c) + vl_dot(c, a));
  return (vlSphericalTriangle){
      a, b, t, 2.0f * half, one_plus_ab, vl_abs(vl_dot(a, vl_cross(ab, t))), vl_dot(b, t)};
}
static inline vlVec3 vl_warp_spherical_triangle(vlSphericalTriangle s, float u, float v) {
  vlSinCos half = vl_sincos(0.5f * u * s.solid_angle);
  float y = half.sin * s.one_plus_ab, x = s.det * half.cos - s.bt * half.sin;
  float length2 = x * x + y * y, scale = length2 > 0.0f ? 1.0f / length2 : 0.0f;
  /* c' - a */
  vlVec3 move = vl_sub(vl_mul(s.t, 2.0f * x * y * scale), vl_mul(s.a, 2.0f * y * y * scale));
  vlVec3 c = vl_add(s.a, move), bc = vl_sub(c, s.b);
  float whole = 0.5f * vl_length2(bc), h = v * whole; /* 1 - b.c', 1 - b.w */
  vlVec3 side = vl_normalize(vl_sub(bc, vl_mul(s.b, vl_dot(bc, s.b))));
  return vl_normalize(
      vl_add(vl_mul(s.b, 1.0f - h), vl_mul(side, vl_safe_sqrt(h * (2.0f - h)))));
}

/* Index of the interval that contains x, between n + 1 ascending nodes: the last i with
 * nodes[i] <= x; 0 below all, n - 1 beyond all. */
static inline uint32_t vl_find_interval(const float *nodes, uint32_t n, float x) {
  uint32_t low = 0, high = n;
  while (high - low > 1) {
    uint32_t mid = (low + high) / 2;
    if (nodes[mid] <= x)
      low = mid;
    else
      high = mid;
  }
  return low;
}

/* Cell [i, i + 1) of a cumulative table of n cells (n + 1 entries, from 0 to 1) that contains
 * u; *within: position in the cell, below 1. Cells of zero width are never chosen, unless all
 * cells have zero width. */
static inline uint32_t vl_find_cell(const float *cdf, uint32_t n, float u, float *within) {
  uint32_t low = vl_find_interval(cdf, n, u);
  float width = cdf[low + 1] - cdf[low];
  *within = width > 0.0f ? vl_clamp((u - cdf[low]) / width, 0.0f, VL_ONE_MINUS_EPSILON) : 0.5f;
  return low;
}

#endif
