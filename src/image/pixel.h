/* image/pixel.h: single values: half floats, the sRGB curve, and log and power in double. The
 * results have the same bits on every machine: only + - * / and integer operations are used
 * (libm selects code by processor). */
#ifndef IMAGE_PIXEL_H
#define IMAGE_PIXEL_H

#include <stdint.h>
#include <string.h>

#include "velo/image.h"

/* ---- half floats (IEEE 754 binary16) ----------------------------------------------------- */

static inline float vl_half_to_float(uint16_t h) {
  uint32_t sign = (uint32_t)(h & 0x8000u) << 16, exponent = (h >> 10) & 31u,
           mantissa = h & 0x3ffu, bits;
  float f;
  if (exponent == 31u) {
    bits = sign | 0x7f800000u | mantissa << 13;
  } else if (exponent) {
    bits = sign | (exponent + 112u) << 23 | mantissa << 13;
  } else { /* zero and denormals: mantissa * 2^-24, exact in float */
    f = (float)mantissa * 5.9604644775390625e-8f;
    memcpy(&bits, &f, 4);
    bits |= sign;
  }
  memcpy(&f, &bits, 4);
  return f;
}

/* Rounds to nearest, ties to even. Values that are too large become infinity; NaN stays NaN. */
static inline uint16_t vl_float_to_half(float f) {
  uint32_t bits;
  memcpy(&bits, &f, 4);
  uint16_t sign = (uint16_t)(bits >> 16 & 0x8000u);
  uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u)
    return (uint16_t)(sign | 0x7e00u);
  if (magnitude >= 0x477ff000u)
    return (uint16_t)(sign | 0x7c00u);
  /* below 2^-14: a multiple of 2^-24; adding 0.5 makes the addition round */
  if (magnitude < 0x38800000u) {
    float a;
    memcpy(&a, &magnitude, 4);
    a += 0.5f;
    memcpy(&magnitude, &a, 4);
    return (uint16_t)(sign | (magnitude - 0x3f000000u));
  }
  magnitude += 0xfffu + (magnitude >> 13 & 1u);
  return (uint16_t)(sign | (magnitude - 0x38000000u) >> 13);
}

/* ---- curves ------------------------------------------------------------------------------ */

/* The nearest 8-bit sRGB code of a linear value. The value is clamped to [0, 1]; NaN gives
 * 0. */
uint8_t vl_linear_to_srgb8(float linear);
/* Clamps to [0, 1]; NaN gives 0. */
static inline float vl_clamp01(float x) {
  return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f;
}
/* The nearest of 256 equally spaced codes for a value clamped to [0, 1]; NaN gives 0. */
static inline uint8_t vl_linear_to_unorm8(float x) {
  return (uint8_t)(vl_clamp01(x) * 255.0f + 0.5f);
}

/* Base-2 logarithm of a positive, normal x. The relative error is below 1e-15. */
double vl_log2_exact(double x);
/* 2^x for |x| < 1000. */
double vl_exp2_exact(double x);
/* x^y for x >= 0; 0^y = 0. */
double vl_pow_exact(double x, double y);
double vl_srgb_to_linear(double encoded);
double vl_linear_to_srgb(double linear);
/* Decodes a value in [0, 1] to linear light. */
double vl_decode(vlEncoding encoding, float gamma, double encoded);

/* The 256 linear values of an 8-bit encoding. */
void vl_decode_table(vlEncoding encoding, float gamma, float table[256]);

#endif
