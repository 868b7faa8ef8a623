/* image/pixel.c: see pixel.h. */
#include "image/pixel.h"

#include "color/color.h"

uint8_t vl_linear_to_srgb8(float linear) {
  /* last code that begins at or before the value; NaN compares false and gives 0 */
  uint32_t low = 0;
  for (uint32_t step = 128; step; step >>= 1)
    if (linear >= vl_srgb8_begin[low + step])
      low += step;
  return (uint8_t)low;
}

/* log2 x = e + 2 atanh(s) / ln 2 with x = m 2^e, m in [sqrt(1/2), sqrt 2), s = (m - 1)/(m + 1),
 * |s| < 0.172. */
double vl_log2_exact(double x) {
  uint64_t bits;
  memcpy(&bits, &x, 8);
  int64_t e = (int64_t)(bits >> 52) - 1023;
  bits = (bits & 0x000fffffffffffffull) | 0x3ff0000000000000ull;
  double m;
  memcpy(&m, &bits, 8);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    e++;
  }
  double s = (m - 1.0) / (m + 1.0), z = s * s, sum = 0.0;
  for (int k = 21; k >= 1; k -= 2)
    sum = sum * z + 1.0 / k; /* the term s^21/21 is below 1e-17 of the result */
  return (double)e + 2.8853900817779268 * s * sum;
}

double vl_exp2_exact(double x) {
  if (!(x <= 1023.0))
    return x != x ? x : __builtin_inf();
  if (x < -1020.0)
    return 0.0;
  double n = __builtin_floor(x + 0.5);
  double r = (x - n) * 0.69314718055994531, sum = 1.0;
  for (int k = 16; k >= 1; k--)
    sum = sum * r / k + 1.0;
  uint64_t bits = (uint64_t)((int64_t)n + 1023) << 52;
  double scale;
  memcpy(&scale, &bits, 8);
  return sum * scale;
}

double vl_pow_exact(double x, double y) {
  if (!(x > 2.3e-308))
    return y == 0.0 ? 1.0 : 0.0;
  if (x > 1.7e308)
    return x;
  return vl_exp2_exact(y * vl_log2_exact(x));
}

double vl_srgb_to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : vl_pow_exact((v + 0.055) / 1.055, 2.4);
}

double vl_linear_to_srgb(double v) {
  return v <= 0.0031308 ? v * 12.92 : 1.055 * vl_pow_exact(v, 1.0 / 2.4) - 0.055;
}

double vl_decode(vlEncoding encoding, float gamma, double v) {
  if (encoding == VL_ENCODING_SRGB)
    return vl_srgb_to_linear(v);
  if (encoding == VL_ENCODING_GAMMA)
    return vl_pow_exact(v, gamma);
  return v;
}

void vl_decode_table(vlEncoding encoding, float gamma, float table[256]) {
  for (int i = 0; i < 256; i++) {
    if (encoding == VL_ENCODING_SRGB)
      table[i] = vl_srgb8_to_linear[i];
    else
      table[i] = (float)vl_decode(encoding, gamma, i / 255.0);
  }
}
