/* math/vec.h: 3-D vectors, by value and inline, for the hot loops. Operations are evaluated in
 * the order in which they are written, without FMA and reassociation. */
#ifndef MATH_VEC_H
#define MATH_VEC_H

#include "velo/base.h"

static inline vlVec3 vl_vec3(float x, float y, float z) {
  return (vlVec3){x, y, z};
}
/* The vector of three numbers in memory, and back. */
static inline vlVec3 vl_load3(const float v[3]) {
  return vl_vec3(v[0], v[1], v[2]);
}
static inline void vl_store3(float to[3], vlVec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
static inline vlVec3 vl_add(vlVec3 a, vlVec3 b) {
  return vl_vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline vlVec3 vl_sub(vlVec3 a, vlVec3 b) {
  return vl_vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline vlVec3 vl_mul(vlVec3 a, float s) {
  return vl_vec3(a.x * s, a.y * s, a.z * s);
}
static inline vlVec3 vl_neg(vlVec3 a) {
  return vl_vec3(-a.x, -a.y, -a.z);
}
static inline float vl_dot(vlVec3 a, vlVec3 b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
static inline vlVec3 vl_cross(vlVec3 a, vlVec3 b) {
  return vl_vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline float vl_length2(vlVec3 a) {
  return vl_dot(a, a);
}
static inline float vl_length(vlVec3 a) {
  return __builtin_sqrtf(vl_dot(a, a));
}
/* The zero vector stays zero. */
static inline vlVec3 vl_normalize(vlVec3 a) {
  float l = vl_dot(a, a);
  float s = l > 0.0f ? 1.0f / __builtin_sqrtf(l) : 0.0f;
  return vl_mul(a, s);
}
/* Element i of three arrays. Loops that must vectorise index the arrays themselves: clang takes
 * no access to memory in a called function for independent of the other lanes. */
static inline vlVec3 vl_lane3(const float *x, const float *y, const float *z, uint32_t i) {
  return vl_vec3(x[i], y[i], z[i]);
}
static inline void vl_set_lane3(float *x, float *y, float *z, uint32_t i, vlVec3 v) {
  x[i] = v.x;
  y[i] = v.y;
  z[i] = v.z;
}
/* The product of a 3x3 matrix and a vector. */
static inline vlVec3 vl_turn(const float m[9], vlVec3 v) {
  return vl_vec3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                 m[6] * v.x + m[7] * v.y + m[8] * v.z);
}
/* The product of its transpose and a vector. */
static inline vlVec3 vl_turn_back(const float m[9], vlVec3 v) {
  return vl_vec3(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
                 m[2] * v.x + m[5] * v.y + m[8] * v.z);
}
/* A point and a vector under an affine map (3x4). */
static inline vlVec3 vl_affine_point(const float m[12], vlVec3 p) {
  return vl_vec3(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
                 m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                 m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
}
static inline vlVec3 vl_affine_vector(const float m[12], vlVec3 v) {
  return vl_vec3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                 m[8] * v.x + m[9] * v.y + m[10] * v.z);
}
/* A normal under an affine map of which the inverse is given (3x4). */
static inline vlVec3 vl_affine_normal(const float inverse[12], vlVec3 n) {
  const float *m = inverse;
  return vl_vec3(m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
                 m[2] * n.x + m[6] * n.y + m[10] * n.z);
}
static inline float vl_min(float a, float b) {
  return a < b ? a : b;
}
static inline float vl_max(float a, float b) {
  return a > b ? a : b;
}
/* Of what rounding may have made negative. */
static inline float vl_safe_sqrt(float x) {
  return __builtin_sqrtf(vl_max(0.0f, x));
}
static inline float vl_largest4(float a, float b, float c, float d) {
  return vl_max(vl_max(a, b), vl_max(c, d));
}
/* The largest of an array. */
static inline float vl_largest_of4(const float v[4]) {
  return vl_largest4(v[0], v[1], v[2], v[3]);
}
static inline float vl_clamp(float x, float low, float high) {
  return x < low ? low : x > high ? high : x;
}
/* 0 below `low`, 1 above `high`, and a cubic with a level end on both sides between. */
static inline float vl_smooth_step(float x, float low, float high) {
  float t = vl_clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}
static inline float vl_abs(float x) {
  return __builtin_fabsf(x);
}
/* Largest float below 1. */
#define VL_ONE_MINUS_EPSILON 0x1.fffffep-1f
/* Lower bounds for divisors and for arguments of logarithms. A value below its bound is 0 or
 * has no correct digit left. All are normal floats: those below 2^-126 (1.2e-38) have fewer
 * digits, and quotients by them overflow. */
/* For products and squares of cosines, and for densities. Values up to 1e8 have a finite
 * quotient. */
#define VL_MIN_POSITIVE 1e-30f
/* For squared lengths in scene units, which may be small. It is the smallest power of ten that
 * is a normal float. */
#define VL_MIN_NORMAL 1e-37f
/* For cosines and differences of numbers near 1. They have an absolute error of about 2^-24
 * (6e-8), so values below 16 errors have few significant digits. A quotient of values up to 1
 * is at most 1e6. */
#define VL_MIN_FRACTION 1e-6f
#define VL_PI 3.14159265358979323846f
#define VL_INV_PI 0.31830988618379067154f
#define VL_INFINITY __builtin_inff()

/* Orthonormal basis around unit n (Duff et al. 2017, "Building an Orthonormal Basis,
 * Revisited"). */
typedef struct vlFrame {
  vlVec3 x, y, z;
} vlFrame;
static inline vlFrame vl_frame_from_z(vlVec3 n) {
  float sign = __builtin_copysignf(1.0f, n.z);
  float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return (vlFrame){
      {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}
static inline vlVec3 vl_from_local(vlFrame f, vlVec3 v) {
  return vl_add(vl_add(vl_mul(f.x, v.x), vl_mul(f.y, v.y)), vl_mul(f.z, v.z));
}
static inline vlVec3 vl_to_local(vlFrame f, vlVec3 v) {
  return vl_vec3(vl_dot(v, f.x), vl_dot(v, f.y), vl_dot(v, f.z));
}

#endif
