/* trace/surface/offset.h: where rays that leave a surface start, and where shadow rays that
 * arrive at one end: off the surface, by a bound of the rounding errors
 * (docs/decisions/0004-where-new-rays-start.md). The bound is that of the numbers from which a
 * point was computed, which may be far larger than the point's own coordinates. */
#ifndef TRACE_SURFACE_OFFSET_H
#define TRACE_SURFACE_OFFSET_H

#include "math/vec.h"
#include "shape/shape_kind.h"

/* gamma_n = n eps / (1 - n eps), the bound of n roundings (pbrt book 6.8.1). */
#define VL_GAMMA(n) ((n)*0x1p-24f / (1.0f - (n)*0x1p-24f))

/* |a| . |b|: the largest that a . b can be for any signs of the components. */
static inline float vl_dot_of_abs(vlVec3 a, vlVec3 b) {
  return vl_abs(a.x * b.x) + vl_abs(a.y * b.y) + vl_abs(a.z * b.z);
}

/* ---- bounds ------------------------------------------------------------------------------ */

/* The offset of a point b0 p0 + b1 p1 + b2 p2 of a triangle with normal g. corner_error: bound
 * of the error of each corner's coordinates. The first term is pbrt's bound of the point's
 * error (book 6.8.3), projected on the normal. The second is the error of the distance that a
 * new ray is given to this triangle. Embree and the brute force go from one of its corners, so
 * the error grows with the distance from the corners. And they round its normal, which Embree
 * computes from two edges, those of the largest angle at best: the error of the normal grows
 * with 1 / sine of that angle. (Up to a limit: a triangle so thin is hardly hit.) All are
 * doubled. */
static inline float vl_triangle_offset(vlVec3 g, vlVec3 p, vlVec3 p0, vlVec3 p1, vlVec3 p2,
                                       float b0, float b1, float b2, float corner_error) {
  const float max = 1e3f;
  vlVec3 sum = vl_vec3(vl_abs(b0 * p0.x) + vl_abs(b1 * p1.x) + vl_abs(b2 * p2.x),
                       vl_abs(b0 * p0.y) + vl_abs(b1 * p1.y) + vl_abs(b2 * p2.y),
                       vl_abs(b0 * p0.z) + vl_abs(b1 * p1.z) + vl_abs(b2 * p2.z));
  vlVec3 w0 = vl_sub(p, p0), w1 = vl_sub(p, p1), w2 = vl_sub(p, p2);
  float r0 = vl_abs(w0.x) + vl_abs(w0.y) + vl_abs(w0.z),
        r1 = vl_abs(w1.x) + vl_abs(w1.y) + vl_abs(w1.z);
  float r2 = vl_abs(w2.x) + vl_abs(w2.y) + vl_abs(w2.z);
  float reach = vl_max(vl_max(r0, r1), r2);
  vlVec3 e01 = vl_sub(p1, p0), e12 = vl_sub(p2, p1), e20 = vl_sub(p0, p2);
  float area = vl_length(vl_cross(e01, e12)), inv = area > 0.0f ? 1.0f / area : 0.0f;
  float q01 = vl_length2(e01) * inv, q12 = vl_length2(e12) * inv, q20 = vl_length2(e20) * inv;
  /* 1 / sine of the largest angle */
  float steep = __builtin_sqrtf(vl_min(vl_min(q01 * q12, q12 * q20), q20 * q01));
  return 2.0f * (VL_GAMMA(7) * vl_dot_of_abs(g, sum) +
                 VL_GAMMA(5) * reach * vl_clamp(steep, 1.0f, max) +
                 corner_error * (vl_abs(g.x) + vl_abs(g.y) + vl_abs(g.z)));
}

/* The offset of a point of any other shape, which was computed in double precision and then
 * rounded. */
static inline float vl_point_offset(const vlSurfacePoint *q) {
  double rounded = 0, error = 0;
  for (int i = 0; i < 3; i++) {
    rounded += __builtin_fabs(q->n[i] * q->p[i]);
    error += __builtin_fabs(q->n[i]) * q->error[i];
  }
  return 2.0f * VL_GAMMA(7) * (float)rounded + (float)(error + q->off);
}

/* ---- starts and ends --------------------------------------------------------------------- */

/* The next float in the direction of d's sign: x rounded towards +inf (d > 0) or -inf (d <
 * 0). */
static inline float vl_nudge(float x, float d) {
  int32_t i = (int32_t)vl_float_bits(x);
  int32_t step = (d > 0.0f) == (i >= 0) ? 1 : -1;
  int32_t j = x == 0.0f ? (int32_t)(d > 0.0f ? 1u : 0x80000001u) : i + step;
  return d != 0.0f ? vl_bits_float((uint32_t)j) : x;
}
/* Origin of a ray that leaves the surface point p on the side to which w points (pbrt book
 * 6.8.6). g: geometric normal. */
static inline vlVec3 vl_offset_origin(vlVec3 p, vlVec3 g, float offset, vlVec3 w) {
  float side = vl_dot(w, g) < 0.0f ? -offset : offset;
  vlVec3 d = vl_mul(g, side);
  return vl_vec3(vl_nudge(p.x + d.x, d.x), vl_nudge(p.y + d.y, d.y), vl_nudge(p.z + d.z, d.z));
}
/* End of a shadow ray that arrives in direction w at the surface point p, from the point
 * `from`. The ray's direction and its end are rounded in proportion to its length, as are
 * distances to surfaces far from its origin. */
static inline vlVec3 vl_offset_end(vlVec3 p, vlVec3 g, float offset, vlVec3 w, vlVec3 from) {
  return vl_offset_origin(p, g, offset + 2.0f * VL_GAMMA(5) * vl_dot_of_abs(g, vl_sub(p, from)),
                          vl_neg(w));
}

#endif
