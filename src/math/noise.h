/* math/noise.h: gradient noise and its sums. Inline, by value. Sources: Perlin 2002, "Improving
 * Noise", with the permutation of his reference implementation; sums as in Ebert et al.,
 * "Texturing and Modeling" and pbrt (3rd edition, 10.6), so that the same parameters give the
 * same pattern. */
#ifndef MATH_NOISE_H
#define MATH_NOISE_H

#include "math/approx.h"
#include "math/vec.h"

static const uint8_t vl_noise_permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,
    103, 30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,
    0,   26,  197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149,
    56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166,
    77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,
    245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187,
    208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186,
    3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212,
    207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213, 119, 248,
    152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107,
    49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,
    150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,
    215, 61,  156, 180};

static inline float vl_noise_gradient(uint32_t x, uint32_t y, uint32_t z, float dx, float dy,
                                      float dz) {
  const uint8_t *p = vl_noise_permutation;
  uint32_t h = p[(p[(p[x & 255] + y) & 255] + z) & 255] & 15;
  float u = h < 8 || h == 12 || h == 13 ? dx : dy, v = h < 4 || h == 12 || h == 13 ? dy : dz;
  return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}
static inline float vl_noise_fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}
static inline float vl_noise_mix(float t, float a, float b) {
  return (1.0f - t) * a + t * b;
}

/* Noise in [-1, 1], 0 where all coordinates are integers; period 256. Coordinates beyond 1e9
 * and NaN give the value at 0. */
static inline float vl_noise(float x, float y, float z) {
  float all = vl_abs(x) + vl_abs(y) + vl_abs(z); /* vl_max would lose a NaN */
  float on = all < 1e9f ? 1.0f : 0.0f;
  x = on > 0.0f ? x : 0.0f;
  y = on > 0.0f ? y : 0.0f;
  z = on > 0.0f ? z : 0.0f;
  float fx = __builtin_floorf(x), fy = __builtin_floorf(y), fz = __builtin_floorf(z);
  uint32_t i = (uint32_t)(int32_t)fx, j = (uint32_t)(int32_t)fy, k = (uint32_t)(int32_t)fz;
  float dx = x - fx, dy = y - fy, dz = z - fz;
  /* hashed one after the other, in the order of the reference implementation */
  i &= 255;
  j &= 255;
  k &= 255;
  float w000 = vl_noise_gradient(i, j, k, dx, dy, dz),
        w100 = vl_noise_gradient(i + 1, j, k, dx - 1, dy, dz);
  float w010 = vl_noise_gradient(i, j + 1, k, dx, dy - 1, dz);
  float w110 = vl_noise_gradient(i + 1, j + 1, k, dx - 1, dy - 1, dz);
  float w001 = vl_noise_gradient(i, j, k + 1, dx, dy, dz - 1);
  float w101 = vl_noise_gradient(i + 1, j, k + 1, dx - 1, dy, dz - 1);
  float w011 = vl_noise_gradient(i, j + 1, k + 1, dx, dy - 1, dz - 1);
  float w111 = vl_noise_gradient(i + 1, j + 1, k + 1, dx - 1, dy - 1, dz - 1);
  float u = vl_noise_fade(dx), v = vl_noise_fade(dy), w = vl_noise_fade(dz);
  float a = vl_noise_mix(v, vl_noise_mix(u, w000, w100), vl_noise_mix(u, w010, w110));
  float b = vl_noise_mix(v, vl_noise_mix(u, w001, w101), vl_noise_mix(u, w011, w111));
  return vl_noise_mix(w, a, b);
}

/* Number of octaves that a footprint of this width resolves. Finer octaves would alias. */
static inline float vl_noise_octaves(float width, uint32_t octaves) {
  /* -1 - log2(width^2) / 2 */
  float n = -1.0f - 1.44269504f * vl_ln(vl_max(width, VL_MIN_POSITIVE));
  return vl_clamp(n, 0.0f, (float)octaves);
}

/* Fractal sum. Each octave has omega times the amplitude of the octave before. width: width of
 * the footprint. */
static inline float vl_fractal_noise(vlVec3 p, float width, float omega, uint32_t octaves) {
  float n = vl_noise_octaves(width, octaves), sum = 0.0f, size = 1.0f, strength = 1.0f;
  uint32_t whole = (uint32_t)n;
  for (uint32_t i = 0; i < whole; i++) {
    sum += strength * vl_noise(size * p.x, size * p.y, size * p.z);
    size *= 1.99f;
    strength *= omega;
  }
  return sum + strength * vl_smooth_step(n - (float)whole, 0.3f, 0.7f) *
                   vl_noise(size * p.x, size * p.y, size * p.z);
}

/* Turbulence: the fractal sum of absolute values. Octaves that are too fine contribute their
 * mean, 0.2. */
static inline float vl_turbulence(vlVec3 p, float width, float omega, uint32_t octaves) {
  float n = vl_noise_octaves(width, octaves), sum = 0.0f, size = 1.0f, strength = 1.0f;
  uint32_t whole = (uint32_t)n;
  for (uint32_t i = 0; i < whole; i++) {
    sum += strength * vl_abs(vl_noise(size * p.x, size * p.y, size * p.z));
    size *= 1.99f;
    strength *= omega;
  }
  float part = vl_smooth_step(n - (float)whole, 0.3f, 0.7f);
  sum +=
      strength * vl_noise_mix(part, 0.2f, vl_abs(vl_noise(size * p.x, size * p.y, size * p.z)));
  for (uint32_t i = whole; i < octaves; i++) {
    sum += strength * 0.2f;
    strength *= omega;
  }
  return sum;
}

#endif
