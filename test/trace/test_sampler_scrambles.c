/* test/trace/test_sampler_scrambles.c: samplers: numbers that should have nothing to do with
 * each other, in pairs: of one call, of two dimensions, of two pixels. Two laws hold for each
 * pair: it falls evenly into the cells of a grid, and its numbers are equal, to the last bit,
 * as rarely as by chance.
 *
 * The second law finds Sobol' points whose two numbers have the same scramble, which stay even
 * in each projection: the generator matrix of the second number, Pascal's triangle modulo 2,
 * keeps 2^16 of all 2^32 indices (it is its own inverse, and its rank over the identity is 16),
 * and there the numbers would be equal: one of 2^16 pairs, where chance makes one of 2^24.
 *
 * Halton's digits: each branch has a permutation of its own. */

#include "math/lowdiscrepancy.h"
#include "sampler/sampler.h"
#include "statistics.h"
#include "unit.h"
#include "velo/sampler.h"

enum {
  KINDS = VL_SAMPLER_ZSOBOL + 1,
  CALLS = 1 << 18, /* each with a seed of its own */
  SPP = 16,        /* samples of each of two pixels in a call */
  LANES = 2 * SPP,
  CELLS = 8 /* along a side of the grid */
};

/* The numbers of a call, in the order in which a tracer draws them. */
enum { PAIR_U, PAIR_V, WITH_U, WITH_V, SINGLE, NUMBERS };
static const char *const NUMBER_NAMES[NUMBERS] = {
    "the first of a pair", "the second of a pair", "the first of a pair drawn with it",
    "the second of a pair drawn with it", "a single number"};

typedef struct Pair {
  uint32_t equal;               /* pairs with the same number twice */
  uint32_t grid[CELLS * CELLS]; /* of one sample per call, so that all are independent */
} Pair;

typedef struct Pairs {
  Pair same[NUMBERS][NUMBERS];  /* of the same pixel and sample; the first is the smaller */
  Pair apart[NUMBERS][NUMBERS]; /* of two pixels, the same sample */
} Pairs;

static void count_pairs(Pair *pair, uint32_t n, const float *a, const float *b) {
  for (uint32_t i = 0; i < n; i++)
    pair->equal += a[i] == b[i];
  pair->grid[(uint32_t)(a[0] * CELLS) * CELLS + (uint32_t)(b[0] * CELLS)]++;
}

/* Draws the numbers of two pixels: of neighbours, or of pixels that are far apart where the
 * kind spreads its points over neighbours. */
static void draw(vlSamplerKind kind, uint32_t call, float numbers[NUMBERS][LANES]) {
  const vlSamplerKernels *k = vl_sampler_kernels(vl_isa_best());
  const uint32_t dimension = 7 * (call % 16);
  const bool below = call & 1;
  const int32_t step = kind == VL_SAMPLER_ZSOBOL ? 4096 : 1;
  int32_t px[LANES];
  int32_t py[LANES];
  uint32_t index[LANES];
  vlSampler s;
  vl_sampler_init(&s, kind, 0x51ed270bu * (call + 1), 8192, 8192, SPP);
  for (uint32_t i = 0; i < LANES; i++) {
    const bool second = i >= SPP;
    px[i] = (int32_t)(call % 61) + (second && !below ? step : 0);
    py[i] = (int32_t)(call % 53) + (second && below ? step : 0);
    index[i] = i % SPP;
  }
  k->get_2d(&s, LANES, px, py, index, dimension, numbers[PAIR_U], numbers[PAIR_V]);
  k->get_2d_with(&s, LANES, px, py, index, dimension + 2, dimension, numbers[WITH_U],
                 numbers[WITH_V]);
  k->get_1d(&s, LANES, px, py, index, dimension + 4, numbers[SINGLE]);
}

static void judge(const Pair *pair, const char *kind, int a, int b, const char *where) {
  /* By chance one pair of 2^22 to 2^24 is equal, by how many bits of a float are used. */
  const uint32_t rare = 20;
  if (pair->equal > rare)
    fail_msg("%s: %s and %s%s are equal %u times", kind, NUMBER_NAMES[a], NUMBER_NAMES[b],
             where, pair->equal);
  const statResult r = stat_chi2_uniform(pair->grid, CELLS * CELLS);
  if (!stat_accept(r, KINDS * 2 * NUMBERS * NUMBERS))
    fail_msg("%s: %s and %s%s are not even together", kind, NUMBER_NAMES[a], NUMBER_NAMES[b],
             where);
}

/* How many neighbours of a set have the same position within their cells, one of SPP equal
 * intervals each. */
static uint32_t equal_within(const float *numbers) {
  uint32_t equal = 0;
  for (uint32_t i = 0; i + 1 < SPP; i++) {
    const float a = numbers[i] * SPP;
    const float b = numbers[i + 1] * SPP;
    equal += a - floorf(a) == b - floorf(b);
  }
  return equal;
}

static void pairs_of_a_kind(vlSamplerKind kind, const char *name) {
  static Pairs pairs;
  float numbers[NUMBERS][LANES];
  uint32_t within = 0;
  memset(&pairs, 0, sizeof pairs);
  for (uint32_t call = 0; call < CALLS; call++) {
    draw(kind, call, numbers);
    within += equal_within(numbers[SINGLE]);
    for (int a = 0; a < NUMBERS; a++) {
      for (int b = a + 1; b < NUMBERS; b++)
        count_pairs(&pairs.same[a][b], LANES, numbers[a], numbers[b]);
      for (int b = 0; b < NUMBERS; b++)
        count_pairs(&pairs.apart[a][b], SPP, numbers[a], numbers[b] + SPP);
    }
  }
  /* By chance 2^22 pairs are equal in 17 bits or more 32 times. */
  if (within > 100)
    fail_msg("%s: two numbers stand alike in their cells %u times", name, within);
  for (int a = 0; a < NUMBERS; a++)
    for (int b = 0; b < NUMBERS; b++) {
      if (b > a)
        judge(&pairs.same[a][b], name, a, b, "");
      judge(&pairs.apart[a][b], name, a, b, " of another pixel");
    }
}

static void independent(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_INDEPENDENT, "independent");
}
static void stratified(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_STRATIFIED, "stratified");
}
static void nrooks(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_NROOKS, "nrooks");
}
static void multi_jittered(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_MULTI_JITTERED, "multijittered");
}
static void hammersley(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_HAMMERSLEY, "hammersley");
}
static void halton(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_HALTON, "halton");
}
static void sobol(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_SOBOL, "sobol");
}
static void zsobol(void **state) {
  (void)state;
  pairs_of_a_kind(VL_SAMPLER_ZSOBOL, "zsobol");
}

/* ---- nested scrambles of Halton points -------------------------------------------------- */

/* Digit k of the fraction u in base b; digit 0 is the first. */
static uint32_t digit_of(float u, uint32_t b, int k) {
  double x = (double)u;
  for (int i = 0; i < k; i++)
    x = x * b - floor(x * b);
  return (uint32_t)(x * b);
}

/* Nested scrambling (Owen 1995): each digit is permuted by a permutation of its own for the
 * digits before it. So what becomes of the digit 0 in the branches after no digit, 0, 1, 00, 10
 * and 01 are numbers that have nothing to do with each other. The points 0, 1 and b have these
 * digits. */
static void digits_of_branches(uint32_t dimension, uint32_t b) {
  enum { BRANCHES = 6, SEEDS = 1 << 15, MAX_BASE = 7 };
  static const struct {
    int point, digit;
  } branch[BRANCHES] = {{0, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}, {2, 2}};
  static uint32_t grid[BRANCHES][BRANCHES][MAX_BASE * MAX_BASE];
  const vlSamplerKernels *k = vl_sampler_kernels(vl_isa_best());
  memset(grid, 0, sizeof grid);
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    vlSampler s;
    const int32_t pixel[16] = {0};
    const uint32_t index[16] = {0, 1, b};
    float u[16];
    vl_sampler_init(&s, VL_SAMPLER_HALTON, seed, 16, 16, 1024);
    k->get_1d(&s, 16, pixel, pixel, index, dimension, u);
    uint32_t digit[BRANCHES];
    for (int i = 0; i < BRANCHES; i++)
      digit[i] = digit_of(u[branch[i].point], b, branch[i].digit);
    for (int i = 0; i < BRANCHES; i++)
      for (int j = i + 1; j < BRANCHES; j++)
        grid[i][j][digit[i] * b + digit[j]]++;
  }
  for (int i = 0; i < BRANCHES; i++)
    for (int j = i + 1; j < BRANCHES; j++)
      if (!stat_accept(stat_chi2_uniform(grid[i][j], b * b), 4 * BRANCHES * BRANCHES))
        fail_msg("base %u: branches %d and %d are scrambled alike", b, i, j);
}

static void halton_scrambles_branches_apart(void **state) {
  (void)state;
  static const uint32_t primes[4] = {2, 3, 5, 7};
  for (uint32_t dimension = 0; dimension < 4; dimension++)
    digits_of_branches(dimension, primes[dimension]);
}

/* ---- Sobol' points from their definition ------------------------------------------------- */

/* Arithmetic modulo 2^32 one bit at a time. */
static uint32_t slow_sum(uint32_t a, uint32_t b) {
  uint32_t sum = 0;
  uint32_t carry = 0;
  for (int i = 0; i < 32; i++) {
    const uint32_t ones = (a >> i & 1) + (b >> i & 1) + carry;
    sum |= (ones & 1) << i;
    carry = ones >> 1;
  }
  return sum;
}

static uint32_t slow_product(uint32_t a, uint32_t b) {
  uint32_t product = 0;
  for (int i = 0; i < 32; i++)
    if (b >> i & 1)
      product = slow_sum(product, a << i);
  return product;
}

/* Nested uniform scrambling (Owen 1995) of the fraction x / 2^32: from the first digit on, each
 * is flipped or not by a coin for the digits before it. The coins are those of Vegdahl's hash
 * (2021), which sees the digits before this one only: all others are taken for 0. */
static uint32_t slow_owen(uint32_t x, uint32_t seed) {
  uint32_t result = 0;
  for (int digit = 0; digit < 32; digit++) {
    uint32_t y = 0; /* the digits before, the first in bit 0 */
    for (int i = 0; i < digit; i++)
      y |= (x >> (31 - i) & 1) << i;
    y ^= slow_product(y, 0x3d20adeau);
    y = slow_sum(y, seed);
    y = slow_product(y, (seed >> 16) | 1u);
    y ^= slow_product(y, 0x05526c56u);
    y ^= slow_product(y, 0x53a22864u);
    const uint32_t coin = y >> digit & 1;
    result |= ((x >> (31 - digit) & 1) ^ coin) << (31 - digit);
  }
  return result;
}

static void scrambles_follow_their_definition(void **state) {
  (void)state;
  statRng rng = stat_rng(3);
  for (int k = 0; k < 2000; k++) {
    const uint32_t x = (uint32_t)stat_bits(&rng);
    const uint32_t seed = (uint32_t)stat_bits(&rng);
    assert_int_equal(vl_reverse_bits(vl_owen_reversed(vl_reverse_bits(x), seed)),
                     slow_owen(x, seed));
  }
}

/* Column k of Sobol' generator matrices 1 to 4, as a fraction: direction numbers by their
 * recurrence (Joe and Kuo 2008, polynomials of degree 0 to 3). */
static uint32_t direction_number(int matrix, uint32_t k) {
  static const uint32_t first[4][3] = {{0}, {1}, {1, 3}, {1, 3, 1}};
  uint32_t m[32];
  for (uint32_t i = 0; i <= k; i++) {
    const uint32_t degree = (uint32_t)matrix;
    if (degree == 0)
      m[i] = 1; /* van der Corput's sequence */
    else if (i < degree)
      m[i] = first[matrix][i];
    else
      m[i] = m[i - degree] ^ m[i - degree] << degree;
    if (degree == 1 && i >= 1)
      m[i] = m[i - 1] ^ m[i - 1] << 1;
    if (degree == 2 && i >= 2)
      m[i] ^= m[i - 1] << 1;
    if (degree == 3 && i >= 3)
      m[i] ^= m[i - 2] << 2; /* x^3 + x + 1 */
  }
  return m[k] << (31 - k);
}

/* The first 24 bits of a Sobol' number, scrambled. */
static float slow_number(int matrix, uint32_t index, uint32_t seed) {
  uint32_t x = 0;
  for (uint32_t k = 0; k < 32; k++)
    if (index >> k & 1)
      x ^= direction_number(matrix, k);
  return (float)(slow_owen(x, seed) >> 8) * 0x1p-24f;
}

/* What selects the scrambles: of the order of the points, and of each number. */
typedef struct Keys {
  uint32_t index; /* before it is shuffled */
  uint32_t shuffle, x, y;
} Keys;

static Keys sobol_keys(const vlSampler *s, int32_t x, int32_t y, uint32_t index,
                       uint32_t dimension) {
  const uint32_t pixel = vl_hash((uint32_t)x | (uint32_t)y << 16);
  Keys keys = {.index = index};
  keys.shuffle = vl_hash(pixel ^ vl_hash3(s->seed, dimension, 0));
  keys.x = vl_hash(keys.shuffle + 0x68e31da4u);
  keys.y = vl_hash(keys.x + 0xb5297a4du);
  return keys;
}

/* One sequence for the image: the pixel's position on the Morton curve comes before the sample.
 * What 32 bits do not hold selects other scrambles. */
static Keys zsobol_keys(const vlSampler *s, int32_t x, int32_t y, uint32_t index,
                        uint32_t dimension) {
  uint64_t morton = 0;
  for (int i = 0; i < 16; i++)
    morton |= (uint64_t)(x >> i & 1) << 2 * i | (uint64_t)(y >> i & 1) << (2 * i + 1);
  const uint32_t within = index & ((1u << s->log2_spp) - 1);
  const uint64_t global = morton << s->log2_spp | within;
  const uint32_t other = vl_hash((uint32_t)(global >> 32) ^ vl_hash(index >> s->log2_spp));
  Keys keys = {.index = (uint32_t)global};
  keys.shuffle = vl_hash3(s->seed, dimension, 0) ^ other;
  keys.x = vl_hash3(s->seed, dimension, 1) ^ other;
  keys.y = vl_hash3(s->seed, dimension, 2) ^ other;
  return keys;
}

static Keys keys_of(const vlSampler *s, int32_t x, int32_t y, uint32_t index,
                    uint32_t dimension) {
  return s->kind == VL_SAMPLER_SOBOL ? sobol_keys(s, x, y, index, dimension)
                                     : zsobol_keys(s, x, y, index, dimension);
}

/* Every number of sobol and zsobol, computed one bit at a time. That each scramble has a key of
 * its own is seen here alone where chance hides it, as in pairs that are drawn with another. */
static void numbers_follow_their_definition(void **state) {
  (void)state;
  statRng rng = stat_rng(4);
  for (int round = 0; round < 64; round++) {
    const uint32_t dimension = (uint32_t)stat_bits(&rng) % 200;
    const uint32_t with = dimension + 2;
    vlSampler s;
    int32_t px[16];
    int32_t py[16];
    uint32_t index[16];
    float numbers[NUMBERS][16];
    vl_sampler_init(&s, round % 2 ? VL_SAMPLER_SOBOL : VL_SAMPLER_ZSOBOL,
                    (uint32_t)stat_bits(&rng), 65536, 65536, round % 4 < 2 ? 64 : 1024);
    for (int i = 0; i < 16; i++) {
      px[i] = (int32_t)(stat_bits(&rng) & 0xffff);
      py[i] = (int32_t)(stat_bits(&rng) & 0xffff);
      index[i] = (uint32_t)stat_bits(&rng) % (round % 8 < 4 ? 64 : 1 << 16);
    }
    const vlSamplerKernels *k = vl_sampler_kernels(vl_isa_best());
    k->get_2d(&s, 16, px, py, index, dimension, numbers[PAIR_U], numbers[PAIR_V]);
    k->get_2d_with(&s, 16, px, py, index, with, dimension, numbers[WITH_U], numbers[WITH_V]);
    k->get_1d(&s, 16, px, py, index, dimension, numbers[SINGLE]);
    for (int i = 0; i < 16; i++) {
      const Keys first = keys_of(&s, px[i], py[i], index[i], dimension);
      const Keys second = keys_of(&s, px[i], py[i], index[i], with);
      const uint32_t j = slow_owen(first.index, first.shuffle);
      assert_true(numbers[PAIR_U][i] == slow_number(0, j, first.x));
      assert_true(numbers[PAIR_V][i] == slow_number(1, j, first.y));
      assert_true(numbers[WITH_U][i] == slow_number(2, j, second.x));
      assert_true(numbers[WITH_V][i] == slow_number(3, j, second.y));
      assert_true(numbers[SINGLE][i] == numbers[PAIR_U][i]);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(independent),
      cmocka_unit_test(stratified),
      cmocka_unit_test(nrooks),
      cmocka_unit_test(multi_jittered),
      cmocka_unit_test(hammersley),
      cmocka_unit_test(halton),
      cmocka_unit_test(sobol),
      cmocka_unit_test(zsobol),
      cmocka_unit_test(scrambles_follow_their_definition),
      cmocka_unit_test(halton_scrambles_branches_apart),
      cmocka_unit_test(numbers_follow_their_definition),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
