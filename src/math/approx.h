/* math/approx.h: elementary functions in plain C that compilers vectorise, with the same bits
 * on every machine (only + - * / sqrt and integer operations). Polynomials after Moshier's
 * Cephes (single precision). Errors are relative to the exact value over the stated range. */
#ifndef MATH_APPROX_H
#define MATH_APPROX_H

#include <stdint.h>
#include <string.h>

static inline uint32_t vl_float_bits(float x) {
  uint32_t u;
  memcpy(&u, &x, 4);
  return u;
}
static inline float vl_bits_float(uint32_t u) {
  float x;
  memcpy(&x, &u, 4);
  return x;
}

typedef struct vlSinCos {
  float sin, cos;
} vlSinCos;

/* sin and cos of x for |x| <= pi/4. */
static inline vlSinCos vl_sincos_kernel(float x) {
  float z = x * x;
  float s = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * x + x;
  float c = ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) *
                z * z -
            0.5f * z + 1.0f;
  return (vlSinCos){s, c};
}
static inline vlSinCos vl_sincos_quadrant(vlSinCos k, int32_t q) {
  float s = (q & 1) ? k.cos : k.sin;
  float c = (q & 1) ? k.sin : k.cos;
  return (vlSinCos){(q & 2) ? -s : s, ((q + 1) & 2) ? -c : c};
}
/* Radians; |x| <= 8192; absolute error < 1.2e-7. */
static inline vlSinCos vl_sincos(float x) {
  float n = __builtin_floorf(x * 0.636619772367581343f + 0.5f);
  float r = ((x - n * 1.5703125f) - n * 4.837512969970703125e-4f) - n * 7.549789948768648e-8f;
  return vl_sincos_quadrant(vl_sincos_kernel(r), (int32_t)n);
}
/* sin and cos of 2 pi u, u in [0, 1]; exact at the quarters. */
static inline vlSinCos vl_sincos_turn(float u) {
  float q = u * 4.0f, n = __builtin_floorf(q + 0.5f);
  return vl_sincos_quadrant(vl_sincos_kernel((q - n) * 1.57079632679489662f), (int32_t)n);
}

/* Relative error < 2e-7 for results in the normal range; 0 below -87.3, saturates at
 * exp(88.3). */
static inline float vl_exp(float x) {
  float y = x > 88.3f ? 88.3f : x;
  y = y < -87.3f ? -87.3f : y;
  float n = __builtin_floorf(y * 1.44269504088896341f + 0.5f);
  float r = (y - n * 0.693359375f) - n * -2.12194440e-4f;
  float p = ((((1.9875691500e-4f * r + 1.3981999507e-3f) * r + 8.3334519073e-3f) * r +
              4.1665795894e-2f) *
                 r +
             1.6666665459e-1f) *
                r +
            5.0000001201e-1f;
  p = p * r * r + r + 1.0f;
  float result = p * vl_bits_float((uint32_t)((int32_t)n + 127) << 23);
  return x < -87.3f ? 0.0f : x != x ? x : result;
}

/* Natural logarithm; relative error < 2e-7 for normal x > 0; -inf at 0 and for denormals below,
 * NaN for x < 0. */
static inline float vl_ln(float x) {
  uint32_t u = vl_float_bits(x);
  int32_t e = (int32_t)(u >> 23) - 126;
  float m = vl_bits_float((u & 0x007fffffu) | 0x3f000000u); /* [0.5, 1) */
  int small = m < 0.707106781186547524f;
  float f = small ? m + m - 1.0f : m - 1.0f;
  float ef = (float)(small ? e - 1 : e);
  float z = f * f;
  float p = ((((((((7.0376836292e-2f * f - 1.1514610310e-1f) * f + 1.1676998740e-1f) * f -
                  1.2420140846e-1f) *
                     f +
                 1.4249322787e-1f) *
                    f -
                1.6668057665e-1f) *
                   f +
               2.0000714765e-1f) *
                  f -
              2.4999993993e-1f) *
                 f +
             3.3333331174e-1f) *
            f * z;
  p = p + ef * -2.12194440e-4f;
  p = p - 0.5f * z;
  float result = f + p + ef * 0.693359375f;
  float inf = __builtin_inff();
  result = x >= inf ? x : result;
  result = x < 1.17549435e-38f ? -inf : result;
  return x >= 0.0f ? result : __builtin_nanf(""); /* this form lets gcc vectorise it */
}

/* x^y for x >= 0; relative error about 3e-7 (1 + |y ln x|). 0^y = 0 for y > 0. */
static inline float vl_pow(float x, float y) {
  float result = vl_exp(y * vl_ln(x));
  return x <= 0.0f ? (y == 0.0f ? 1.0f : 0.0f) : result;
}

/* arcsin on [-1, 1]; absolute error < 3e-7. */
static inline float vl_asin(float x) {
  float a = __builtin_fabsf(x);
  a = a > 1.0f ? 1.0f : a;
  int big = a > 0.5f;
  float z = big ? 0.5f * (1.0f - a) : a * a;
  float s = big ? __builtin_sqrtf(z) : a;
  float p = ((((4.2163199048e-2f * z + 2.4181311049e-2f) * z + 4.5470025998e-2f) * z +
              7.4953002686e-2f) *
                 z +
             1.6666752422e-1f) *
                z * s +
            s;
  p = big ? 1.57079632679489662f - 2.0f * p : p;
  return __builtin_copysignf(p, x);
}
static inline float vl_acos(float x) {
  float a = __builtin_fabsf(x);
  float t = a > 0.5f ? 2.0f * vl_asin(__builtin_sqrtf(0.5f * (a > 1.0f ? 0.0f : 1.0f - a)))
                     : 1.57079632679489662f - vl_asin(a);
  return x < 0.0f ? 3.14159265358979324f - t : t;
}
/* arctan; absolute error < 2e-7. */
static inline float vl_atan(float x) {
  float a = __builtin_fabsf(x);
  int big = a > 2.414213562373095f, mid = a > 0.4142135623730950f;
  float base = big ? 1.57079632679489662f : mid ? 0.785398163397448310f : 0.0f;
  float num = big ? -1.0f : mid ? a - 1.0f : a;
  float den = big ? a : mid ? a + 1.0f : 1.0f;
  float t = num / den;
  float z = t * t;
  float p = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
             3.33329491539e-1f) *
                z * t +
            t;
  return __builtin_copysignf(base + p, x);
}
/* Angle of (x, y) in (-pi, pi]; 0 at the origin. */
static inline float vl_atan2(float y, float x) {
  float ax = __builtin_fabsf(x), ay = __builtin_fabsf(y);
  float high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  float t = vl_atan(low / (high > 0.0f ? high : 1.0f));
  t = ay > ax ? 1.57079632679489662f - t : t;
  t = x < 0.0f ? 3.14159265358979324f - t : t;
  return y < 0.0f ? -t : t;
}

#endif
