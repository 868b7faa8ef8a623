/* sampler/halton.hot.h: Halton points with Owen scrambling for each pixel and dimension. The
 * base of dimension d is the d-th prime. Each digit is permuted at random, depending on the
 * digits before it. Without scrambling, pairs of large bases (17, 19) are strongly correlated
 * (pbrt book 8.6). */
#ifndef SAMPLER_HALTON_HOT_H
#define SAMPLER_HALTON_HOT_H

#include "sampler/chunk.hot.h"

/* Maps a 16-bit random number to [0, range), range < 2^16. */
static inline uint32_t vl_scale16(uint32_t bits16, uint32_t range) {
  return bits16 * range >> 16;
}

/* Random bijection of [0, b) for a prime b, selected by the hash h. It is an affine map, a
 * swap-or-not step (Hoang, Morris and Rogaway 2012) and another affine map. Affine maps alone
 * would give a small variance too, but leave lattices. */
static inline uint32_t vl_scramble_digit(uint32_t digit, uint32_t b, float inverse,
                                         uint32_t h) {
  uint32_t g = vl_hash(h + 0x632be5abu);
  uint32_t a = 1 + vl_scale16(h >> 16, b - 1), c = vl_scale16(h & 0xffffu, b);
  uint32_t k = vl_scale16(g >> 16, b);
  uint32_t e = vl_divide(a * digit + c, b, inverse).remainder;
  /* e and f = k - e mod b are partners: both make the same decision to swap */
  uint32_t f = k >= e ? k - e : k + b - e;
  uint32_t high = e > f ? e : f;
  e = vl_hash((g ^ h) + high) >> 31 ? f : e;
  return vl_divide(e * (1 + vl_scale16(g & 0xffffu, b - 1)) + k, b, inverse).remainder;
}

VL_INLINE void vl_halton_1d(const vlSampler *s, const vlSamplerChunk *c, uint32_t dimension,
                            float *u) {
  uint32_t b = vl_primes[dimension % VL_PRIME_COUNT];
  if (b == 2) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
      u[i] = vl_unit_float(vl_reverse_bits(vl_owen_reversed(c->index[i], c->key[i])));
    }
    return;
  }
  _Alignas(64) uint32_t rest[VL_SAMPLER_CHUNK], hash[VL_SAMPLER_CHUNK];
  _Alignas(64) float sum[VL_SAMPLER_CHUNK];
  float inverse = 1.0f / (float)b, scale = 1.0f;
  for (uint32_t i = 0; i < c->n; i++)
    rest[i] = c->index[i];
  for (uint32_t i = 0; i < c->n; i++)
    hash[i] = c->key[i];
  for (uint32_t i = 0; i < c->n; i++)
    sum[i] = 0.0f;
  /* Scrambles as many digits as the largest index has. One random number replaces all further
   * digits. */
  for (uint32_t left = s->set - 1; left > 0; left /= b) {
    scale *= inverse;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
      vlDivision d = vl_divide(rest[i], b, inverse);
      sum[i] += (float)(int32_t)vl_scramble_digit(d.remainder, b, inverse, hash[i]) * scale;
      hash[i] = vl_hash(hash[i] ^ (d.remainder + 1) * 0x9e3779b9u);
      rest[i] = d.quotient;
    }
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    float x = sum[i] + vl_unit_float(hash[i]) * scale;
    u[i] = x < VL_ONE_MINUS_EPSILON ? x : VL_ONE_MINUS_EPSILON;
  }
}

#endif
