/* math/hash.h: integer hashing, for random numbers that depend only on (seed, pixel, sample,
 * dimension). Integers have 32 bits, so that loops vectorise on every instruction set; where
 * that does not matter, 64. */
#ifndef MATH_HASH_H
#define MATH_HASH_H

#include <stdint.h>

/* Low-bias 32-bit mixer (found by search, Wellons 2018, "lowbias32"). */
static inline uint32_t vl_hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
static inline uint32_t vl_hash2(uint32_t a, uint32_t b) {
  return vl_hash(a ^ (vl_hash(b) + 0x9e3779b9u + (a << 6) + (a >> 2)));
}
static inline uint32_t vl_hash3(uint32_t a, uint32_t b, uint32_t c) {
  return vl_hash2(vl_hash2(a, b), c);
}
/* Mixes 64 bits; a bijection ("Mix13" of Stafford 2011, the end of SplitMix64). */
static inline uint64_t vl_hash64(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
/* The top 24 bits of a fraction, random bits among them, as a float in [0, 1). */
static inline float vl_unit_float(uint32_t bits) {
  return (float)(int32_t)(bits >> 8) * 0x1p-24f; /* signed: a single instruction on every set */
}

#endif
