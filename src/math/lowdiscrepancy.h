/* math/lowdiscrepancy.h: building blocks of the samplers: digit reversal, Sobol's first two
 * dimensions, nested uniform (Owen) scrambling, Morton order, random permutations of any
 * length, primes. All functions use 32-bit integers and no tables in loops, so they vectorise
 * on every instruction set.
 *
 * A number u in [0,1) is stored as the 32-bit integer u 2^32 ("fraction"); an "index" counts
 * samples. Bit reversal converts one to the other: the radical inverse in base 2 of index i is
 * the fraction reverse(i). */
#ifndef MATH_LOWDISCREPANCY_H
#define MATH_LOWDISCREPANCY_H

#include "base/attributes.h"
#include "math/hash.h"

static inline uint32_t vl_reverse_bits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/* Nested uniform scrambling of a bit-reversed fraction: a random permutation in which each bit
 * is flipped or kept by a hash of the lower bits alone (Laine and Karras 2011; Burley 2020,
 * "Practical Hash-based Owen Scrambling"; constants found by search, Vegdahl 2021, "Building a
 * Better LK Hash"). */
static inline uint32_t vl_owen_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/* Sobol's second dimension, bit-reversed: its generator matrix is Pascal's triangle modulo 2,
 * the Kronecker power of (1 1; 0 1), so that five steps replace a loop over 32 columns (cf.
 * Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact").
 * With reverse(index) as the first dimension: a (0,2)-sequence in base 2. */
static inline uint32_t vl_sobol2_reversed(uint32_t index) {
  uint32_t x = index;
  x ^= (x >> 1) & 0x55555555u;
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 8) & 0x00ff00ffu;
  return x ^ (x >> 16);
}

/* Moves the bits of x (< 2^16) to the even positions. */
static inline uint32_t vl_spread_bits(uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}
/* Position on the Morton curve (Z order); x and y < 2^16. */
static inline uint32_t vl_morton(uint32_t x, uint32_t y) {
  return vl_spread_bits(x) | (vl_spread_bits(y) << 1);
}

/* A random permutation of [0, count). mask is the smallest 2^w - 1 >= count - 1. One
 * application permutes [0, 2^w); for [0, count) it is repeated while the result is outside
 * ("cycle walking", Black and Rogaway 2002). Each round is a bijection of w bits: add, multiply
 * by an odd number, fold the upper half into the lower. */
typedef struct vlPermuteState {
  uint32_t i, key;
} vlPermuteState;
static inline vlPermuteState vl_permute_round(vlPermuteState s, uint32_t mask, uint32_t shift) {
  uint32_t k = s.key, i = ((s.i ^ (k >> 4)) * ((k >> 15) | 1u) + (k >> 9)) & mask;
  return (vlPermuteState){i ^ (i >> shift), (k ^ (k >> 15)) * 0x2c9277b5u + 0xac564b05u};
}
/* Eight rounds, because fewer are visibly uneven for 4 and 5 elements. Unrolled by hand,
 * because clang does not vectorise nested loops. */
VL_INLINE uint32_t vl_permute_step(uint32_t i, uint32_t mask, uint32_t shift, uint32_t key) {
  vlPermuteState s = {i, vl_hash(key)};
  s = vl_permute_round(vl_permute_round(s, mask, shift), mask, shift);
  s = vl_permute_round(vl_permute_round(s, mask, shift), mask, shift);
  s = vl_permute_round(vl_permute_round(s, mask, shift), mask, shift);
  s = vl_permute_round(vl_permute_round(s, mask, shift), mask, shift);
  return s.i;
}
typedef struct vlPermutation {
  uint32_t count, mask, shift; /* shift: half of the mask's bits, rounded up, at least 1 */
} vlPermutation;
static inline vlPermutation vl_permutation(uint32_t count) {
  uint32_t bits = count > 1 ? 32u - (uint32_t)__builtin_clz(count - 1) : 0;
  return (vlPermutation){count, bits == 0 ? 0 : 0xffffffffu >> (32 - bits),
                         bits < 2 ? 1 : (bits + 1) / 2};
}

/* Computes a / b and a % b where a whole batch has the same b, for a < 2^31 and a / b < 2^22.
 * It multiplies by the float reciprocal, then corrects the result. */
typedef struct vlDivision {
  uint32_t quotient, remainder;
} vlDivision;
static inline vlDivision vl_divide(uint32_t a, uint32_t b, float inverse) {
  int32_t q = (int32_t)((float)(int32_t)a * inverse);
  int32_t r = (int32_t)a - q * (int32_t)b;
  int32_t low = r < 0, high = r >= (int32_t)b;
  return (vlDivision){(uint32_t)(q - low + high), (uint32_t)(r + (low - high) * (int32_t)b)};
}

/* The first primes: 2, 3, 5, ... */
enum { VL_PRIME_COUNT = 256 };
extern const uint16_t vl_primes[VL_PRIME_COUNT];

#endif
