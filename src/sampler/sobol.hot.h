/* sampler/sobol.hot.h: Sobol' points. Each pair of dimensions uses the first two Sobol'
 * dimensions ("padding"), with the index shuffled and both numbers Owen-scrambled. Shuffles are
 * independent for each pixel (sobol), or run along the Morton curve of the whole image
 * (zsobol).
 *
 * Bit reversals are most of the cost, so they are merged. With r = reverse(index), and L a
 * scramble of reversed bits:
 *   shuffled index  j = reverse(L(r)),   first number  reverse(L(j)),   second
 *                   reverse(L(pascal j)).
 *
 * A pair that is drawn with another one uses the third and fourth Sobol' dimension and the
 * other's j, so that all four are one sequence. */
#ifndef SAMPLER_SOBOL_HOT_H
#define SAMPLER_SOBOL_HOT_H

#include "sampler/chunk.hot.h"

/* Seeds of the scrambles of the index and of both numbers. */
typedef struct vlSobolSeeds {
  uint32_t shuffle, x, y;
} vlSobolSeeds;
/* Arbitrary numbers, which make seeds of the two numbers out of the key of the index. */
static const uint32_t vl_sobol_x_step = 0x68e31da4u, vl_sobol_y_step = 0xb5297a4du;

VL_INLINE uint32_t vl_sobol_shuffled(uint32_t index, uint32_t seed) {
  return vl_reverse_bits(vl_owen_reversed(vl_reverse_bits(index), seed));
}
VL_INLINE float vl_sobol_x(uint32_t j, uint32_t seed) {
  return vl_unit_float(vl_reverse_bits(vl_owen_reversed(j, seed)));
}
VL_INLINE float vl_sobol_y(uint32_t j, uint32_t seed) {
  return vl_unit_float(vl_reverse_bits(vl_owen_reversed(vl_sobol2_reversed(j), seed)));
}

VL_INLINE void vl_sobol_pixel(const int pair, const vlSampler *s, uint32_t n, const int32_t *px,
                              const int32_t *py, const uint32_t *index, uint32_t dimension,
                              float *u, float *v) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key = vl_pixel_key(px[i], py[i], seed);
    uint32_t j = vl_sobol_shuffled(index[i], key), key_x = vl_hash(key + vl_sobol_x_step);
    u[i] = vl_sobol_x(j, key_x);
    if (pair)
      v[i] = vl_sobol_y(j, vl_hash(key_x + vl_sobol_y_step));
  }
}

/* A hash of what of the global index (below) is beyond 32 bits, and of the set that the sample
 * index belongs to; 0 if both are 0. Two shifts, because shift may be 0: a shift by 32 is
 * undefined. */
VL_INLINE uint32_t vl_zsobol_other(uint32_t morton, uint32_t index, uint32_t shift) {
  return vl_hash(((morton >> 1) >> (31 - shift)) ^ vl_hash(index >> shift));
}

/* The global index is i = morton(pixel) 2^shift + sample. Its low 32 bits are shuffled. Higher
 * bits, which occur for very large images and sample counts, and sample indices from 2^shift on
 * select other scrambles. wide: the batch may have such an index. The hash of 0 is 0, so both
 * values of `wide` give the same bits for other indices. */
VL_INLINE void vl_zsobol_lanes(const int pair, const int wide, vlSobolSeeds seed,
                               uint32_t shift, uint32_t n, const int32_t *px, const int32_t *py,
                               const uint32_t *index, float *u, float *v) {
  uint32_t mask = (1u << shift) - 1;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t morton = vl_morton((uint32_t)px[i] & 0xffffu, (uint32_t)py[i] & 0xffffu);
    uint32_t other = wide ? vl_zsobol_other(morton, index[i], shift) : 0;
    uint32_t j = vl_sobol_shuffled(morton << shift | (index[i] & mask), seed.shuffle ^ other);
    u[i] = vl_sobol_x(j, seed.x ^ other);
    if (pair)
      v[i] = vl_sobol_y(j, seed.y ^ other);
  }
}

VL_INLINE void vl_zsobol(const int pair, const vlSampler *s, uint32_t n, const int32_t *px,
                         const int32_t *py, const uint32_t *index, uint32_t dimension, float *u,
                         float *v) {
  vlSobolSeeds seed = {vl_dimension_seed(s, dimension, 0), vl_dimension_seed(s, dimension, 1),
                       vl_dimension_seed(s, dimension, 2)};
  uint32_t shift = s->log2_spp;
  if (s->morton_bits + shift <= 32 && vl_largest(n, index) >> shift == 0)
    vl_zsobol_lanes(pair, 0, seed, shift, n, px, py, index, u, v);
  else
    vl_zsobol_lanes(pair, 1, seed, shift, n, px, py, index, u, v);
}

/* ---- a pair that is drawn with another one ----------------------------------------------- */

/* Columns of the generator matrices of Sobol's third and fourth dimension, bit-reversed:
 * primitive polynomials x^2 + x + 1 and x^3 + x + 1, initial direction numbers 1, 3 and 1, 3, 1
 * (Joe and Kuo 2008). */
static const uint32_t vl_sobol3_columns[32] = {
    0x00000001u, 0x00000003u, 0x00000006u, 0x00000009u, 0x00000017u, 0x0000003au, 0x00000071u,
    0x000000a3u, 0x00000116u, 0x00000339u, 0x00000677u, 0x000009aau, 0x00001601u, 0x00003903u,
    0x00007706u, 0x0000aa09u, 0x00010117u, 0x0003033au, 0x00060671u, 0x000909a3u, 0x00171616u,
    0x003a3939u, 0x00717777u, 0x00a3aaaau, 0x01170001u, 0x033a0003u, 0x06710006u, 0x09a30009u,
    0x16160017u, 0x3939003au, 0x77770071u, 0xaaaa00a3u};
static const uint32_t vl_sobol4_columns[32] = {
    0x00000001u, 0x00000003u, 0x00000004u, 0x0000000au, 0x0000001fu, 0x0000002eu, 0x00000045u,
    0x000000c9u, 0x0000011bu, 0x000002a4u, 0x0000079au, 0x00000b67u, 0x0000101eu, 0x0000302du,
    0x00004041u, 0x0000a0c3u, 0x0001f104u, 0x0002e28au, 0x000457dfu, 0x000c9baeu, 0x0011a105u,
    0x002a7289u, 0x0079e7dbu, 0x00b6dba4u, 0x0100011au, 0x030002a7u, 0x0400079eu, 0x0a000b6du,
    0x1f001001u, 0x2e003003u, 0x45004004u, 0xc900a00au};

/* Of each lane of a chunk: the other pair's shuffled index, and the scrambles of this pair. */
typedef struct vlSobolChunk {
  _Alignas(64) uint32_t j[VL_SAMPLER_CHUNK], x[VL_SAMPLER_CHUNK], y[VL_SAMPLER_CHUNK];
} vlSobolChunk;

VL_INLINE void vl_sobol_chunk(const vlSampler *s, uint32_t n, const int32_t *px,
                              const int32_t *py, const uint32_t *index, uint32_t dimension,
                              uint32_t with, vlSobolChunk *c) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0), seed_with = vl_dimension_seed(s, with, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key_x = vl_hash(vl_pixel_key(px[i], py[i], seed) + vl_sobol_x_step);
    c->j[i] = vl_sobol_shuffled(index[i], vl_pixel_key(px[i], py[i], seed_with));
    c->x[i] = key_x;
    c->y[i] = vl_hash(key_x + vl_sobol_y_step);
  }
}

VL_INLINE void vl_zsobol_chunk(const vlSampler *s, uint32_t n, const int32_t *px,
                               const int32_t *py, const uint32_t *index, uint32_t dimension,
                               uint32_t with, vlSobolChunk *c) {
  uint32_t shuffle = vl_dimension_seed(s, with, 0), x = vl_dimension_seed(s, dimension, 1);
  uint32_t y = vl_dimension_seed(s, dimension, 2), shift = s->log2_spp,
           mask = (1u << shift) - 1;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t morton = vl_morton((uint32_t)px[i] & 0xffffu, (uint32_t)py[i] & 0xffffu);
    uint32_t other = vl_zsobol_other(morton, index[i], shift);
    c->j[i] = vl_sobol_shuffled(morton << shift | (index[i] & mask), shuffle ^ other);
    c->x[i] = x ^ other;
    c->y[i] = y ^ other;
  }
}

/* One of the numbers: generator matrix times index, scrambled. */
VL_INLINE void vl_sobol_number(uint32_t n, const uint32_t columns[32], const uint32_t *j,
                               const uint32_t *seed, float *u) {
  _Alignas(64) uint32_t product[VL_SAMPLER_CHUNK] = {0};
  for (uint32_t k = 0; k < 32; k += 4) {
    uint32_t a = columns[k], b = columns[k + 1], c = columns[k + 2], d = columns[k + 3];
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      uint32_t bits = j[i] >> k;
      product[i] ^= (a & -(bits & 1u)) ^ (b & -(bits >> 1 & 1u)) ^ (c & -(bits >> 2 & 1u)) ^
                    (d & -(bits >> 3 & 1u));
    }
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    u[i] = vl_unit_float(vl_reverse_bits(vl_owen_reversed(product[i], seed[i])));
  }
}

#endif
