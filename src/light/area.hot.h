/* light/area.hot.h: sampling of triangles and spheres that emit light; private to the hot
 * files of trace/light. */
#ifndef LIGHT_AREA_HOT_H
#define LIGHT_AREA_HOT_H

#include "math/warp.h"
#include "trace/stages.h"

/* A point of an area light. */
typedef struct vlLightPoint {
  vlVec3 p, n;
  float offset;     /* of p (trace/surface/offset.h) */
  float pdf;        /* per area */
  float u, v;       /* where the image of the emission is read; 0: a triangle without one */
  float weights[3]; /* barycentric coordinates in a triangle */
} vlLightPoint;
/* The point of a triangle with the barycentric coordinates b. */
vlLightPoint vl_light_point_at(const vlWorld *world, const vlWorldLight *light,
                               const float b[3]);
/* A random point of a shape of another kind. */
vlLightPoint vl_light_point_on(const vlWorldLight *light, const vlWorldShape *shape, float u,
                               float v);

/* ---- triangles --------------------------------------------------------------------------- */

/* Corners of a triangle, relative to the point from which it is seen. */
typedef struct vlTriangleSeen {
  vlVec3 a, b, c;
} vlTriangleSeen;
static inline vlTriangleSeen vl_triangle_from(const float q[9], vlVec3 from) {
  return (vlTriangleSeen){vl_vec3(q[0] - from.x, q[1] - from.y, q[2] - from.z),
                          vl_vec3(q[3] - from.x, q[4] - from.y, q[5] - from.z),
                          vl_vec3(q[6] - from.x, q[7] - from.y, q[8] - from.z)};
}

/* Near triangles are sampled by solid angle, because the density of area sampling is unbounded
 * for them. Far triangles are sampled by area, which is cheaper. Sampling and density make the
 * same decision in two steps: a test of the area against the squared distance of the centroid,
 * then vl_triangle_cap_near. */
static inline int vl_triangle_maybe_near(vlTriangleSeen q, float area) {
  float d2 = vl_length2(vl_add(vl_add(q.a, q.b), q.c)) * (1.0f / 9.0f);
  return area > 0.05f * d2;
}
static inline vlSphericalTriangle vl_triangle_cap(vlTriangleSeen q) {
  return vl_spherical_triangle(vl_normalize(q.a), vl_normalize(q.b), vl_normalize(q.c));
}
static inline int vl_triangle_cap_near(float solid_angle) {
  /* Outside these limits, sampling is by area. Below the lower limit, both densities are nearly
   * the same. Above the upper limit (6.22, as in pbrt), the triangle covers nearly a hemisphere
   * (2 pi = 6.283) and the spherical triangle degenerates. */
  const float min_cap = 1e-3f, max_cap = 6.22f;
  return (solid_angle > min_cap) & (solid_angle < max_cap);
}

/* Intersection of the direction w with the triangle's plane, in barycentric coordinates. */
static inline vlVec3 vl_triangle_weights(vlTriangleSeen q, vlVec3 w) {
  float b0 = vl_abs(vl_dot(w, vl_cross(q.b, q.c))), b1 = vl_abs(vl_dot(w, vl_cross(q.c, q.a))),
        b2 = vl_abs(vl_dot(w, vl_cross(q.a, q.b)));
  float sum = b0 + b1 + b2, inv = sum > 0.0f ? 1.0f / sum : 0.0f;
  return vl_vec3(b0 * inv, b1 * inv, 1.0f - (b0 + b1) * inv);
}

/* Converts a density per area at point p with normal n to a density per solid angle seen from
 * `from`. */
static inline float vl_solid_pdf(float pdf_area, vlVec3 from, vlVec3 p, vlVec3 n) {
  vlVec3 to = vl_sub(p, from);
  float d2 = vl_length2(to), cosine = vl_abs(vl_dot(n, to));
  return cosine > 0.0f ? pdf_area * d2 * __builtin_sqrtf(d2) / cosine : 0.0f;
}

/* ---- spheres seen from outside ----------------------------------------------------------- */

static inline int vl_outside_sphere(vlVec3 to_center, float radius) {
  return vl_length2(to_center) > radius * radius * 1.0001f;
}
static inline bool vl_outside_plain_sphere(const vlWorldLight *light, vlVec3 from) {
  const float *q = light->corners;
  return vl_outside_sphere(vl_sub(vl_load3(q), from), q[3]);
}

/* 1 - cos of the half angle of the cone that a sphere fills when seen from outside, without
 * cancellation. sin2: squared sine of this half angle. */
static inline float vl_sphere_cone(float sin2) {
  return sin2 / (1.0f + vl_safe_sqrt(1.0f - sin2));
}

typedef struct vlSphereSample {
  vlVec3 p, n; /* point and normal on the sphere */
  float pdf;   /* per solid angle */
} vlSphereSample;
/* side: 1, or -1 for normals that point inwards. p is off the sphere by rounding errors
 * (vlWorldLight.corners). */
static inline vlSphereSample vl_sample_sphere(vlVec3 center, float radius, float side,
                                              vlVec3 from, float u, float v) {
  vlVec3 to = vl_sub(center, from);
  float d2 = vl_length2(to), d = __builtin_sqrtf(d2);
  float sin2_max = radius * radius / d2, span = vl_sphere_cone(sin2_max);
  float one_minus_cos = span * u, cos_t = 1.0f - one_minus_cos;
  float sin2_t = vl_max(0.0f, one_minus_cos * (2.0f - one_minus_cos));
  /* a: angle at the sphere's centre between the cone's axis and the sampled point (pbrt book
   * 6.2.4). */
  float sin_max = __builtin_sqrtf(sin2_max);
  float cos_a = sin2_t / sin_max + cos_t * vl_safe_sqrt(1.0f - sin2_t / sin2_max);
  float sin_a = vl_safe_sqrt(1.0f - cos_a * cos_a);
  vlSinCos phi = vl_sincos_turn(v);
  vlFrame frame = vl_frame_from_z(vl_mul(to, -1.0f / d));
  vlVec3 n = vl_from_local(frame, vl_vec3(sin_a * phi.cos, sin_a * phi.sin, cos_a));
  return (vlSphereSample){vl_add(center, vl_mul(n, radius)), vl_mul(n, side),
                          1.0f / (2.0f * VL_PI * span)};
}

#endif
