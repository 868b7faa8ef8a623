/* sampler/chunk.hot.h: functions that all kinds of samplers share. Batches are processed in
 * chunks that fit the L1 cache. Each lane has a key (a hash of seed, dimension and pixel) and
 * an index within its set of samples. */
#ifndef SAMPLER_CHUNK_HOT_H
#define SAMPLER_CHUNK_HOT_H

#include "math/lowdiscrepancy.h"
#include "math/vec.h"
#include "sampler/sampler.h"

enum { VL_SAMPLER_CHUNK = 128 };

typedef struct vlSamplerChunk {
  uint32_t n; /* a multiple of VL_LANES */
  _Alignas(64) uint32_t key[VL_SAMPLER_CHUNK];
  _Alignas(64) uint32_t index[VL_SAMPLER_CHUNK]; /* index in the set, less than vlSampler.set */
} vlSamplerChunk;

/* Seed of a dimension. salt: distinguishes several seeds of one dimension. */
static inline uint32_t vl_dimension_seed(const vlSampler *s, uint32_t dimension,
                                         uint32_t salt) {
  return vl_hash3(s->seed, dimension, salt);
}
static inline uint32_t vl_pixel_key(int32_t px, int32_t py, uint32_t dimension_seed) {
  return vl_hash(vl_hash(((uint32_t)px & 0xffffu) | (uint32_t)py << 16) ^ dimension_seed);
}

static inline void vl_pixel_keys(uint32_t n, const int32_t *px, const int32_t *py,
                                 uint32_t seed, uint32_t *key) {
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    key[i] = vl_pixel_key(px[i], py[i], seed);
  }
}

/* Largest of the n values. */
static inline uint32_t vl_largest(uint32_t n, const uint32_t *a) {
  uint32_t largest = 0;
  for (uint32_t i = 0; i < n; i++)
    largest = a[i] > largest ? a[i] : largest;
  return largest;
}

/* Sets keys and indices of a chunk. An index past the end of the first set belongs to a later
 * set, which has another key. */
static inline void vl_sampler_chunk(const vlSampler *s, uint32_t n, const int32_t *px,
                                    const int32_t *py, const uint32_t *index, uint32_t seed,
                                    vlSamplerChunk *chunk) {
  chunk->n = n;
  vl_pixel_keys(n, px, py, seed, chunk->key);
  for (uint32_t i = 0; i < n; i++)
    chunk->index[i] = index[i];
  if (vl_largest(n, index) >= s->set) {
    for (uint32_t i = 0; i < n; i++) {
      uint32_t turn = index[i] / s->set;
      chunk->index[i] = index[i] - turn * s->set;
      chunk->key[i] = turn ? vl_hash2(chunk->key[i], turn) : chunk->key[i];
    }
  }
}

/* Sets result[i] to the permutation of from[i] in [0, p.count). The lane's key selects the
 * permutation. */
static inline void vl_permute_lanes(uint32_t n, vlPermutation p, const uint32_t *from,
                                    const uint32_t *key, uint32_t salt, uint32_t *result) {
  uint32_t outside = 0;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    result[i] = vl_permute_step(from[i], p.mask, p.shift, key[i] + salt);
  }
  for (uint32_t i = 0; i < n; i++)
    outside |= result[i] >= p.count;
  while (outside) {
    outside = 0;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      uint32_t again = vl_permute_step(result[i], p.mask, p.shift, key[i] + salt);
      result[i] = result[i] >= p.count ? again : result[i];
    }
    for (uint32_t i = 0; i < n; i++)
      outside |= result[i] >= p.count;
  }
}

/* Converts t, a cell's number followed by jitter bits, to a float in [0, 1). scale: 2^-(jitter
 * bits) / (number of cells). */
static inline float vl_cell_float(uint32_t t, float scale) {
  float u = (float)(int32_t)t * scale;
  return u < VL_ONE_MINUS_EPSILON ? u : VL_ONE_MINUS_EPSILON;
}

/* ---- for the files of the kinds ---------------------------------------------------------- */

/* Numbers of one and of two dimensions for a batch. n is a multiple of VL_LANES. */
#define VL_SAMPLER_INPUT                                                                       \
  const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index, \
      uint32_t dimension
typedef void vlSampler1d(VL_SAMPLER_INPUT, float *u);
typedef void vlSampler2d(VL_SAMPLER_INPUT, float *u, float *v);

/* Body of a function: in chunks; `call` has the chunk c, whose first lane is k. */
#define VL_SAMPLER_IN_CHUNKS(call)                                    \
  uint32_t seed = vl_dimension_seed(s, dimension, 0);                 \
  vlSamplerChunk chunk, *c = &chunk;                                  \
  for (uint32_t k = 0; k < n; k += VL_SAMPLER_CHUNK) {                \
    uint32_t m = n - k < VL_SAMPLER_CHUNK ? n - k : VL_SAMPLER_CHUNK; \
    vl_sampler_chunk(s, m, px + k, py + k, index + k, seed, c);       \
    call;                                                             \
  }

#endif
