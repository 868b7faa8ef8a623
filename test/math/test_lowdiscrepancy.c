/* test/math/test_lowdiscrepancy.c: the low-discrepancy building blocks of the samplers, each
 * against its definition. */
#include "math/lowdiscrepancy.h"
#include "statistics.h"
#include "unit.h"

static void test_bits(void **state) {
  (void)state;
  statRng rng = stat_rng(1);
  for (int k = 0; k < 10000; k++) {
    uint32_t x = (uint32_t)stat_bits(&rng), reversed = 0, y = (uint32_t)stat_bits(&rng),
             morton = 0;
    for (int i = 0; i < 32; i++)
      reversed |= (x >> i & 1) << (31 - i);
    assert_int_equal(vl_reverse_bits(x), reversed);
    for (int i = 0; i < 16; i++)
      morton |= (x >> i & 1) << 2 * i | (y >> i & 1) << (2 * i + 1);
    assert_int_equal(vl_morton(x & 0xffff, y & 0xffff), morton);
    float u = vl_unit_float(x);
    assert_true(u >= 0 && u < 1 && fabs(u - x * 0x1p-32) <= 0x1p-24);
  }
  uint32_t primes = 0;
  for (uint32_t n = 2; primes < VL_PRIME_COUNT; n++) {
    bool prime = true;
    for (uint32_t d = 2; d * d <= n; d++)
      prime = prime && n % d != 0;
    if (prime)
      assert_int_equal(vl_primes[primes++], n);
  }
}

/* Direction numbers of the primitive polynomial x + 1 (Bratley and Fox 1988): m_i = 2 m_{i-1}
 * xor m_{i-1}. */
static void test_sobol2(void **state) {
  (void)state;
  uint32_t direction[32], m = 1;
  for (int i = 0; i < 32; i++) {
    direction[i] = m << (31 - i);
    m = m << 1 ^ m;
  }
  statRng rng = stat_rng(2);
  for (int k = 0; k < 10000; k++) {
    uint32_t index = k < 1000 ? (uint32_t)k : (uint32_t)stat_bits(&rng), x = 0;
    for (int i = 0; i < 32; i++)
      x ^= index >> i & 1 ? direction[i] : 0;
    assert_int_equal(vl_reverse_bits(vl_sobol2_reversed(index)), x);
  }
}

/* Nested uniform scrambling of a fraction (most significant bit first). Applied to an index, it
 * shuffles indices so that each aligned block of 2^k indices remains an aligned block. */
static uint32_t owen(uint32_t x, uint32_t seed) {
  return vl_reverse_bits(vl_owen_reversed(vl_reverse_bits(x), seed));
}

/* The permutation of one element; i < count. */
static uint32_t permute(vlPermutation p, uint32_t i, uint32_t key) {
  do
    i = vl_permute_step(i, p.mask, p.shift, key);
  while (i >= p.count);
  return i;
}

/* A nested scramble: the top k bits of the result are a permutation of the top k bits; each bit
 * flips half of the time. */
static void test_owen(void **state) {
  (void)state;
  enum { K = 8 };
  for (uint32_t seed = 0; seed < 200; seed++) {
    uint8_t seen[1 << K] = {0};
    for (uint32_t i = 0; i < 1u << K; i++) {
      uint32_t low = vl_hash(i * 77 + seed) >> K, hashed = vl_hash(seed);
      uint32_t a = owen(i << (32 - K) | low, hashed), b = owen(i << (32 - K), hashed);
      assert_int_equal(a >> (32 - K), b >> (32 - K));
      assert_int_equal(seen[a >> (32 - K)]++, 0);
    }
  }
  for (int bit = 0; bit < 24; bit++) {
    uint32_t flips = 0, both = 0;
    enum { N = 20000 };
    for (uint32_t i = 0; i < N; i++) {
      uint32_t x = vl_hash(i), seed = vl_hash(i + 12345), up = 1u << 31 >> (bit / 2);
      uint32_t a = owen(x, seed) ^ x, b = owen(x ^ up, seed) ^ x ^ up;
      flips += a >> (31 - bit) & 1;
      /* if a bit above differs, the flip differs half of the time */
      both += (a ^ b) >> (31 - bit) & 1;
    }
    assert_true(fabs(flips - N * 0.5) < 5 * sqrt(N * 0.25));
    if (bit > 4)
      assert_true(fabs(both - N * 0.5) < 0.1 * N);
  }
}

static void test_permutation(void **state) {
  (void)state;
  static const uint32_t COUNTS[] = {1, 2, 3, 4, 5, 7, 16, 17, 100, 255, 256, 257, 1000};
  for (size_t k = 0; k < sizeof COUNTS / sizeof COUNTS[0]; k++)
    for (uint32_t key = 0; key < 100; key++) {
      uint8_t seen[1000] = {0};
      vlPermutation p = vl_permutation(COUNTS[k]);
      for (uint32_t i = 0; i < COUNTS[k]; i++) {
        uint32_t j = permute(p, i, key);
        assert_true(j < COUNTS[k]);
        assert_int_equal(seen[j]++, 0);
      }
    }
  /* all permutations of 2, 3, 4, 5 things about equally often */
  for (uint32_t n = 2; n <= 5; n++) {
    enum { TRIES = 20000 };
    static uint32_t counts[3125];
    uint32_t all = 1, found = 0;
    for (uint32_t i = 2; i <= n; i++)
      all *= i;
    memset(counts, 0, sizeof counts);
    vlPermutation p = vl_permutation(n);
    for (uint32_t t = 0; t < TRIES; t++) {
      uint32_t id = 0;
      for (uint32_t i = 0; i < n; i++)
        id = id * n + permute(p, i, t + 1000000 * n);
      counts[id]++;
    }
    statCell cells[120];
    for (int i = 0; i < 3125; i++)
      if (counts[i])
        cells[found++] = (statCell){counts[i], (double)TRIES / all};
    assert_int_equal(found, all);
    assert_true(stat_accept(stat_chi2(cells, found, 1), 20));
  }
  /* pairs of images */
  static const uint32_t SIZES[] = {8, 13, 31, 40};
  for (int s = 0; s < 4; s++) {
    uint32_t n = SIZES[s];
    vlPermutation p = vl_permutation(n);
    for (uint32_t second = 1; second < n; second += n / 3) {
      static uint32_t counts[1600];
      memset(counts, 0, sizeof counts);
      for (uint32_t t = 0; t < 40000; t++)
        counts[permute(p, 0, t * 3 + n) * n + permute(p, second, t * 3 + n)]++;
      static statCell cells[1600];
      uint32_t k = 0;
      for (uint32_t i = 0; i < n * n; i++)
        if (i / n != i % n)
          cells[k++] = (statCell){counts[i], 40000.0 / (n * (n - 1))};
      assert_true(stat_accept(stat_chi2(cells, k, 1), 20));
    }
  }
}

static void test_division(void **state) {
  (void)state;
  for (uint32_t b = 1; b < 3000; b += b < 40 ? 1 : 41) {
    float inverse = 1.0f / (float)b;
    for (uint64_t a = 0; a < 1u << 31 && a / b < 1u << 22; a += a < 5000 ? 1 : 1040377) {
      vlDivision d = vl_divide((uint32_t)a, b, inverse);
      assert_true(d.quotient == a / b && d.remainder == a % b);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bits),     cmocka_unit_test(test_sobol2),
      cmocka_unit_test(test_owen),     cmocka_unit_test(test_permutation),
      cmocka_unit_test(test_division),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
