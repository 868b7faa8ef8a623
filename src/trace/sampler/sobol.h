/* trace/sampler/sobol.h: Sobol' points. Each pair of dimensions uses the first two Sobol' dimensions ("padding"), with
 * the index shuffled and both numbers Owen-scrambled. Shuffles are independent for each pixel (sobol), or run along the
 * Morton curve of the whole image (zsobol).
 *
 * Bit reversals are most of the cost, so they are merged. With r = reverse(index), and L a scramble of reversed bits:
 *   shuffled index  j = reverse(L(r)),   first number  reverse(L(j)),   second  reverse(L(pascal j)). */
#ifndef TRACE_SAMPLER_SOBOL_H
#define TRACE_SAMPLER_SOBOL_H

#include "trace/sampler/chunk.h"

typedef struct vlSobolSeeds {
  uint32_t shuffle, x, y;
} vlSobolSeeds;

VL_SAMPLER_INLINE uint32_t vl_sobol_shuffled(uint32_t index, uint32_t seed) {
  return vl_reverse_bits(vl_owen_reversed(vl_reverse_bits(index), seed));
}
VL_SAMPLER_INLINE float vl_sobol_x(uint32_t j, uint32_t seed) {
  return vl_fraction_float(vl_reverse_bits(vl_owen_reversed(j, seed)));
}
VL_SAMPLER_INLINE float vl_sobol_y(uint32_t j, uint32_t seed) {
  return vl_fraction_float(vl_reverse_bits(vl_owen_reversed(vl_sobol2_reversed(j), seed)));
}

VL_SAMPLER_INLINE void vl_sobol_pixel(const int pair, const vlSampler *s, uint32_t n, const int32_t *px,
                                      const int32_t *py, const uint32_t *index, uint32_t dimension, float *u,
                                      float *v) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key = vl_pixel_key(px[i], py[i], seed);
    uint32_t j = vl_sobol_shuffled(index[i], key), key_x = vl_hash(key + 0x68e31da4u);
    u[i] = vl_sobol_x(j, key_x);
    if (pair) v[i] = vl_sobol_y(j, vl_hash(key_x + 0xb5297a4du));
  }
}

/* The global index is i = morton(pixel) 2^shift + sample. Its low 32 bits are shuffled. Higher bits, which occur for
 * very large images and sample counts, and sample indices from 2^shift on select other scrambles. wide: the batch may
 * have such an index. The hash of 0 is 0, so both values of `wide` give the same bits for other indices. */
VL_SAMPLER_INLINE void vl_zsobol_lanes(const int pair, const int wide, vlSobolSeeds seed, uint32_t shift, uint32_t n,
                                       const int32_t *px, const int32_t *py, const uint32_t *index, float *u,
                                       float *v) {
  uint32_t mask = (1u << shift) - 1;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t morton = vl_morton((uint32_t)px[i] & 0xffffu, (uint32_t)py[i] & 0xffffu);
    uint32_t other = 0;
    if (wide) other = vl_hash(((morton >> 1) >> (31 - shift)) ^ vl_hash(index[i] >> shift));
    uint32_t j = vl_sobol_shuffled(morton << shift | (index[i] & mask), seed.shuffle ^ other);
    u[i] = vl_sobol_x(j, seed.x ^ other);
    if (pair) v[i] = vl_sobol_y(j, seed.y ^ other);
  }
}

VL_SAMPLER_INLINE void vl_zsobol(const int pair, const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py,
                                 const uint32_t *index, uint32_t dimension, float *u, float *v) {
  vlSobolSeeds seed = {vl_dimension_seed(s, dimension, 0), vl_dimension_seed(s, dimension, 1),
                       vl_dimension_seed(s, dimension, 2)};
  uint32_t shift = s->log2_spp;
  if (s->morton_bits + shift <= 32 && vl_largest(n, index) >> shift == 0)
    vl_zsobol_lanes(pair, 0, seed, shift, n, px, py, index, u, v);
  else
    vl_zsobol_lanes(pair, 1, seed, shift, n, px, py, index, u, v);
}

#endif
