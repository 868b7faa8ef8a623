/* math/octahedral.h: the equal-area map between the unit square and the sphere (Clarberg 2008;
 * pbrt book 3.8.3), used for environment images. z > 0 is the inner diamond. */
#ifndef MATH_OCTAHEDRAL_H
#define MATH_OCTAHEDRAL_H

#include "math/approx.h"
#include "math/vec.h"

static inline vlVec3 vl_octahedral_decode(float s, float t) {
  float u = 2.0f * s - 1.0f, v = 2.0f * t - 1.0f;
  float up = vl_abs(u), vp = vl_abs(v);
  float signed_distance = 1.0f - (up + vp), r = 1.0f - vl_abs(signed_distance);
  float turn = (r == 0.0f ? 1.0f : (vp - up) / r + 1.0f) * 0.125f; /* of a full turn */
  vlSinCos a = vl_sincos_turn(turn);
  float z = __builtin_copysignf(1.0f - r * r, signed_distance);
  float f = r * vl_safe_sqrt(2.0f - r * r);
  return vl_vec3(__builtin_copysignf(a.cos, u) * f, __builtin_copysignf(a.sin, v) * f, z);
}

/* Maps a direction (unit) to the unit square. */
static inline vlVec2 vl_octahedral_encode(vlVec3 d) {
  float x = vl_abs(d.x), y = vl_abs(d.y), z = vl_abs(d.z);
  float r = vl_safe_sqrt(1.0f - z);
  float a = vl_max(x, y), b = vl_min(x, y);
  float phi = vl_atan(a == 0.0f ? 0.0f : b / a) * 0.63661977236758134f;
  phi = x < y ? 1.0f - phi : phi;
  float v = phi * r, u = r - v;
  float uu = d.z < 0.0f ? 1.0f - v : u, vv = d.z < 0.0f ? 1.0f - u : v;
  uu = __builtin_copysignf(uu, d.x);
  vv = __builtin_copysignf(vv, d.y);
  return (vlVec2){0.5f * (uu + 1.0f), 0.5f * (vv + 1.0f)};
}

#endif
