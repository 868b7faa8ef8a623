/* test/trace/test_sampler.c: samplers: exact stratification, uniform projections, independent
 * dimensions, the same bits on every instruction set and in every grouping, any spp. */
#include "sampler/sobol.hot.h"
#include "statistics.h"
#include "unit.h"
#include "velo/sampler.h"

enum { KINDS = VL_SAMPLER_ZSOBOL + 1, BATCH = 4096 };
static const char *const NAMES[KINDS] = {"independent", "regular",        "stratified",
                                         "nrooks",      "multi-jittered", "hammersley",
                                         "halton",      "sobol",          "zsobol"};

static const vlSamplerKernels *kernels(void) {
  return vl_sampler_kernels(vl_isa_best());
}

/* The first n indices of one pixel. */
static void pixel_set(const vlSampler *s, int x, int y, uint32_t first, uint32_t n,
                      uint32_t dimension, float *u, float *v) {
  static int32_t px[BATCH], py[BATCH];
  static uint32_t index[BATCH];
  assert_true(VL_PAD(n) <= BATCH);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    px[i] = x;
    py[i] = y;
    index[i] = first + i;
  }
  if (v)
    kernels()->get_2d(s, n, px, py, index, dimension, u, v);
  else
    kernels()->get_1d(s, n, px, py, index, dimension, u);
}

static uint32_t cell_of(float u, uint32_t count) {
  return (uint32_t)((double)u * count);
}
/* Whether each of count cells holds exactly one of the count numbers. */
static bool one_each(const float *u, uint32_t count) {
  static uint8_t seen[BATCH];
  memset(seen, 0, count);
  for (uint32_t i = 0; i < count; i++) {
    uint32_t c = cell_of(u[i], count);
    if (c >= count || seen[c]++)
      return false;
  }
  return true;
}
/* Every elementary interval 2^-a x 2^-(k-a) holds one of the 2^k points. */
static bool is_net(const float *u, const float *v, uint32_t k) {
  static uint8_t seen[BATCH];
  for (uint32_t a = 0; a <= k; a++) {
    memset(seen, 0, 1u << k);
    for (uint32_t i = 0; i < 1u << k; i++) {
      uint32_t c = cell_of(u[i], 1u << a) << (k - a) | cell_of(v[i], 1u << (k - a));
      if (seen[c]++)
        return false;
    }
  }
  return true;
}

static float u_[BATCH], v_[BATCH], w_[BATCH];

static void test_range(void **state) {
  (void)state;
  static const uint32_t SPP[] = {0,  1,   2,    3,        5,           7,          13,
                                 64, 100, 1000, 1u << 20, 3000000000u, 0xffffffffu};
  for (int kind = 0; kind < KINDS; kind++)
    for (size_t k = 0; k < sizeof SPP / sizeof SPP[0]; k++) {
      vlSampler s;
      vl_sampler_init(&s, (vlSamplerKind)kind, 3, 65536, 65536, SPP[k]);
      for (uint32_t first = 0; first < 3; first++) {
        uint32_t start = first == 0 ? 0 : first == 1 ? s.spp - 50 : 0xffffff00u;
        pixel_set(&s, 65535, 65535 - (int)first, start, 128, first * 97, u_, v_);
        for (int i = 0; i < 128; i++)
          assert_true(u_[i] >= 0 && u_[i] < 1 && v_[i] >= 0 && v_[i] < 1);
        pixel_set(&s, 65535, 65535, start, 128, first * 97 + 1, u_, NULL);
        for (int i = 0; i < 128; i++)
          assert_true(u_[i] >= 0 && u_[i] < 1);
      }
    }
}

static void test_strata(void **state) {
  (void)state;
  static const uint32_t SPP[] = {1,  2,  3,  4,  5,   7,   12,  16,  17,
                                 25, 36, 64, 97, 100, 128, 500, 1024};
  for (size_t k = 0; k < sizeof SPP / sizeof SPP[0]; k++) {
    uint32_t spp = SPP[k];
    for (uint32_t dimension = 0; dimension < 40; dimension += 7) {
      int x = (int)(dimension * 31 % 640), y = (int)(spp % 480);
      for (int kind = VL_SAMPLER_REGULAR; kind <= VL_SAMPLER_HAMMERSLEY; kind++) {
        vlSampler s;
        vl_sampler_init(&s, (vlSamplerKind)kind, 11, 640, 480, spp);
        pixel_set(&s, x, y, 0, spp, dimension, u_, NULL);
        assert_true(one_each(u_, spp));
        pixel_set(&s, x, y, spp, spp, dimension, w_, NULL); /* the next set */
        assert_true(one_each(w_, spp));
        if (kind != VL_SAMPLER_REGULAR && spp > 16)
          assert_true(memcmp(u_, w_, spp * 4) != 0);
        pixel_set(&s, x, y, 0, spp, dimension, u_, v_);
        if (kind == VL_SAMPLER_NROOKS || kind == VL_SAMPLER_MULTI_JITTERED) {
          assert_true(one_each(u_, spp) ||
                      (kind == VL_SAMPLER_MULTI_JITTERED && s.wide != s.grid_y));
          assert_true(one_each(v_, spp));
        }
        if (kind == VL_SAMPLER_HAMMERSLEY)
          assert_true(one_each(u_, spp));
        if (kind == VL_SAMPLER_REGULAR || kind == VL_SAMPLER_STRATIFIED ||
            kind == VL_SAMPLER_MULTI_JITTERED) {
          /* rows first, then columns within the row: each cell of equal area holds one */
          static uint8_t seen[BATCH];
          memset(seen, 0, spp);
          uint32_t edge = s.wide * s.grid_x;
          if (kind == VL_SAMPLER_MULTI_JITTERED && s.wide != s.grid_y)
            continue;
          for (uint32_t i = 0; i < spp; i++) {
            uint32_t q = cell_of(v_[i], spp);
            uint32_t across = q < edge ? s.grid_x : s.grid_x - 1;
            uint32_t start =
                q < edge ? q / across * across : edge + (q - edge) / across * across;
            uint32_t cell = start + cell_of(u_[i], across);
            assert_true(cell < spp);
            assert_int_equal(seen[cell]++, 0);
          }
        }
      }
    }
  }
}

static void test_nets(void **state) {
  (void)state;
  for (uint32_t k = 0; k <= 10; k++)
    for (uint32_t dimension = 0; dimension < 60; dimension += 11) {
      uint32_t spp = 1u << k;
      vlSampler s;
      vl_sampler_init(&s, VL_SAMPLER_SOBOL, 5, 640, 480, 1024);
      pixel_set(&s, 17, 33 + (int)dimension, 0, spp, dimension, u_, v_);
      assert_true(is_net(u_, v_, k)); /* every prefix, and every aligned block */
      pixel_set(&s, 17, 33, 3 * spp, spp, dimension, u_, v_);
      assert_true(is_net(u_, v_, k));
      vl_sampler_init(&s, VL_SAMPLER_HAMMERSLEY, 5, 640, 480, spp);
      pixel_set(&s, 17, 33, 0, spp, dimension, u_, v_);
      assert_true(is_net(u_, v_, k));
      vl_sampler_init(&s, VL_SAMPLER_ZSOBOL, 5, 640, 480, spp);
      pixel_set(&s, 17, 33, 0, spp, dimension, u_, v_);
      assert_true(is_net(u_, v_, k));
      vl_sampler_init(&s, VL_SAMPLER_HALTON, 5, 640, 480, spp);
      pixel_set(&s, 17, 33, 0, spp, 0, u_, NULL);
      assert_true(one_each(u_, spp));
    }
  /* zsobol: aligned blocks of 2^j x 2^j pixels with all their samples are one net */
  for (uint32_t j = 1; j <= 3; j++)
    for (uint32_t log_spp = 0; log_spp <= 4; log_spp += 2) {
      vlSampler s;
      vl_sampler_init(&s, VL_SAMPLER_ZSOBOL, 5, 640, 480, 1u << log_spp);
      int32_t px[BATCH], py[BATCH];
      uint32_t index[BATCH], n = 1u << (2 * j + log_spp);
      for (uint32_t i = 0; i < VL_PAD(n); i++) {
        uint32_t p = (i >> log_spp) & ((1u << 2 * j) - 1);
        px[i] = (int32_t)((5u << j) + (p & ((1u << j) - 1)));
        py[i] = (int32_t)((3u << j) + (p >> j));
        index[i] = i & ((1u << log_spp) - 1);
      }
      for (uint32_t dimension = 0; dimension < 30; dimension += 6) {
        kernels()->get_2d(&s, n, px, py, index, dimension, u_, v_);
        assert_true(is_net(u_, v_, 2 * j + log_spp));
        kernels()->get_1d(&s, n, px, py, index, dimension, u_);
        assert_true(one_each(u_, n));
      }
    }
  /* Halton: base b, b^k numbers */
  static const uint32_t POWERS[4][2] = {{1, 729}, {2, 625}, {3, 343}, {30, 127}};
  for (int i = 0; i < 4; i++) {
    vlSampler s;
    vl_sampler_init(&s, VL_SAMPLER_HALTON, 5, 640, 480, POWERS[i][1]);
    pixel_set(&s, 9, 8, 0, POWERS[i][1], POWERS[i][0], u_, NULL);
    static uint8_t seen[BATCH]; /* rounding of sums may move a number across a cell's border:
                                   look at cells shrunk by it */
    memset(seen, 0, sizeof seen);
    for (uint32_t k = 0; k < POWERS[i][1]; k++)
      assert_int_equal(seen[cell_of(u_[k] + 1e-7f, POWERS[i][1])]++, 0);
  }
}

/* Generator matrices from the recurrence of the direction numbers (Joe and Kuo 2008). */
static void test_columns(void **state) {
  (void)state;
  static const struct {
    uint32_t degree, middle, first[3];
    const uint32_t *columns;
  } ROWS[2] = {{2, 1, {1, 3, 0}, vl_sobol3_columns}, {3, 1, {1, 3, 1}, vl_sobol4_columns}};
  for (int d = 0; d < 2; d++) {
    uint32_t m[32], s = ROWS[d].degree;
    for (uint32_t k = 0; k < 32; k++) {
      m[k] = k < s ? ROWS[d].first[k] : m[k - s] ^ m[k - s] << s;
      for (uint32_t q = 1; q < s && k >= s; q++)
        if (ROWS[d].middle >> (s - 1 - q) & 1)
          m[k] ^= m[k - q] << q;
      assert_int_equal(ROWS[d].columns[k], vl_reverse_bits(m[k] << (31 - k)));
    }
  }
}

/* Two pairs that are drawn together: each elementary interval of 4 dimensions and volume 8 /
 * 2^k holds 8 of 2^k points (Sobol's quality parameter t is 3), each number alone is
 * stratified; the same bits for all sets and groupings. */
static void test_with(void **state) {
  (void)state;
  enum { LOG = 9, COUNT = 1 << LOG, T = 3, WITH = 2, PAIR = 11 };
  static float p[4][COUNT];
  int32_t px[COUNT], py[COUNT];
  uint32_t index[COUNT];
  for (uint32_t i = 0; i < COUNT; i++) {
    px[i] = 31;
    py[i] = 7;
    index[i] = i;
  }
  for (int kind = 0; kind < KINDS; kind++) {
    vlSampler s;
    vl_sampler_init(&s, (vlSamplerKind)kind, 5, 640, 480, COUNT);
    kernels()->get_2d(&s, COUNT, px, py, index, WITH, p[0], p[1]);
    kernels()->get_2d_with(&s, COUNT, px, py, index, PAIR, WITH, p[2], p[3]);
    for (vlIsa isa = 0; isa <= vl_isa_best(); isa++) {
      vl_sampler_kernels(isa)->get_2d_with(&s, COUNT, px, py, index, PAIR, WITH, u_, v_);
      assert_memory_equal(u_, p[2], sizeof p[2]);
      assert_memory_equal(v_, p[3], sizeof p[3]);
      vl_sampler_kernels(isa)->get_2d_with(&s, 48, px + 160, py + 160, index + 160, PAIR, WITH,
                                           u_, v_);
      assert_memory_equal(u_, p[2] + 160, 48 * sizeof *u_);
      assert_memory_equal(v_, p[3] + 160, 48 * sizeof *v_);
    }
    if (kind != VL_SAMPLER_SOBOL && kind != VL_SAMPLER_ZSOBOL) {
      kernels()->get_2d(&s, COUNT, px, py, index, PAIR, u_, v_);
      assert_memory_equal(u_, p[2], sizeof p[2]);
      continue;
    }
    const int bits = LOG - T;
    for (int a = 0; a <= bits; a++)
      for (int b = 0; a + b <= bits; b++)
        for (int c = 0; a + b + c <= bits; c++) {
          int d = bits - a - b - c;
          uint32_t seen[1 << (LOG - T)] = {0};
          for (uint32_t i = 0; i < COUNT; i++)
            seen[((cell_of(p[0][i], 1u << a) << b | cell_of(p[1][i], 1u << b)) << c |
                  cell_of(p[2][i], 1u << c))
                     << d |
                 cell_of(p[3][i], 1u << d)]++;
          for (int k = 0; k < 1 << bits; k++)
            assert_int_equal(seen[k], 1 << T);
        }
    assert_true(one_each(p[2], COUNT) && one_each(p[3], COUNT));
  }
}

/* Many pixels, few samples each: every 1-D and 2-D projection is uniform; also pairs from
 * different calls. */
static void test_uniform(void **state) {
  (void)state;
  enum { PIXELS = 4096, TESTS = KINDS * 12 };
  static const uint32_t SPP[2] = {16, 13}, DIMENSIONS[] = {0, 5, 190};
  for (int kind = 0; kind < KINDS; kind++) {
    if (kind == VL_SAMPLER_REGULAR)
      continue; /* is not random: has its own test below */
    for (int k = 0; k < 2; k++)
      for (int d = 0; d < 3; d++) {
        vlSampler s;
        vl_sampler_init(&s, (vlSamplerKind)kind, 77, 1024, 1024, SPP[k]);
        uint32_t grid[16 * 16] = {0}, joint[16 * 16] = {0}, line[64] = {0};
        double sum = 0, sum2 = 0;
        for (int p = 0; p < PIXELS; p++) {
          /* Pixels far apart, one sample of each: independent of each other, whatever the
           * kind */
          int x = (p % 64) * 16 + p % 7, y = (p / 64) * 16 + p % 5;
          pixel_set(&s, x, y, (uint32_t)p % SPP[k], 1, DIMENSIONS[d], u_, v_);
          pixel_set(&s, x, y, (uint32_t)p % SPP[k], 1, DIMENSIONS[d] + 2, w_, NULL);
          grid[cell_of(u_[0], 16) * 16 + cell_of(v_[0], 16)]++;
          joint[cell_of(v_[0], 16) * 16 + cell_of(w_[0], 16)]++;
          line[cell_of(w_[0], 64)]++;
          sum += u_[0];
          sum2 += u_[0] * u_[0];
        }
        statResult r = stat_chi2_uniform(grid, 256), q = stat_chi2_uniform(joint, 256),
                   t = stat_chi2_uniform(line, 64);
        bool ok = stat_accept(r, TESTS) && stat_accept(q, TESTS) && stat_accept(t, TESTS);
        if (!ok)
          fail_msg("%s, spp %u, dimension %u is not uniform", NAMES[kind], SPP[k],
                   DIMENSIONS[d]);
        assert_true(fabs(sum / PIXELS - 0.5) < 0.025 &&
                    fabs(sum2 / PIXELS - 1.0 / 3.0) < 0.025);
      }
  }
}

/* Dimensions are not correlated: 64 whole pixels side by side. (Finer tests need independent
 * points, test_uniform.) */
static void test_independence(void **state) {
  (void)state;
  enum { PIXELS = 64, SPP = 64 };
  static float a[PIXELS * SPP], b[PIXELS * SPP], c[PIXELS * SPP], d[PIXELS * SPP];
  for (int kind = 0; kind < KINDS; kind++) {
    vlSampler s;
    vl_sampler_init(&s, (vlSamplerKind)kind, 7, 64, 64, SPP);
    static const uint32_t PAIRS[][2] = {{0, 2}, {2, 4}, {3, 9}, {10, 150}, {60, 62}};
    for (size_t k = 0; k < 5; k++) {
      for (int p = 0; p < PIXELS; p++) {
        pixel_set(&s, p, p % 3, 0, SPP, PAIRS[k][0], a + p * SPP, b + p * SPP);
        pixel_set(&s, p, p % 3, 0, SPP, PAIRS[k][1], c + p * SPP, d + p * SPP);
      }
      double limit = 5.0 / sqrt(PIXELS * SPP);
      double r[4] = {stat_correlation(a, c, PIXELS * SPP), stat_correlation(a, d, PIXELS * SPP),
                     stat_correlation(b, c, PIXELS * SPP),
                     stat_correlation(b, d, PIXELS * SPP)};
      for (int i = 0; i < 4; i++)
        if (fabs(r[i]) > limit)
          fail_msg("%s: dimensions %u and %u correlate: %g", NAMES[kind], PAIRS[k][0],
                   PAIRS[k][1], r[i]);
    }
  }
}

static void test_regular(void **state) {
  (void)state;
  vlSampler s;
  vl_sampler_init(&s, VL_SAMPLER_REGULAR, 1, 64, 64, 12); /* 3 rows of 4 */
  pixel_set(&s, 5, 6, 0, 12, 0, u_, v_);
  uint32_t seen = 0;
  for (int i = 0; i < 12; i++) {
    uint32_t x = cell_of(u_[i], 4), y = cell_of(v_[i], 3);
    assert_true(fabs(u_[i] - (x + 0.5) / 4) < 1e-6 && fabs(v_[i] - (y + 0.5) / 3) < 1e-6);
    seen |= 1u << (4 * y + x);
  }
  assert_int_equal(seen, 0xfff);
  vl_sampler_init(&s, VL_SAMPLER_REGULAR, 1, 64, 64, 1);
  pixel_set(&s, 5, 6, 0, 1, 0, u_, v_);
  assert_true(u_[0] == 0.5f && v_[0] == 0.5f);
}

static void test_bits(void **state) {
  (void)state;
  static int32_t px[BATCH], py[BATCH];
  static uint32_t index[BATCH];
  statRng rng = stat_rng(5);
  for (int i = 0; i < BATCH; i++) {
    px[i] = (int32_t)(stat_bits(&rng) & 65535);
    py[i] = (int32_t)(stat_bits(&rng) & 65535);
    index[i] = (uint32_t)(stat_bits(&rng) % 300);
  }
  static float ru[BATCH], rv[BATCH], rw[BATCH];
  for (int kind = 0; kind < KINDS; kind++)
    for (uint32_t spp = 1; spp < 400; spp = spp * 3 + 1) {
      vlSampler s;
      vl_sampler_init(&s, (vlSamplerKind)kind, 123, 65536, 65536, spp);
      vl_sampler_kernel_table.get_2d(&s, BATCH, px, py, index, 6, ru, rv);
      vl_sampler_kernel_table.get_1d(&s, BATCH, px, py, index, 8, rw);
      for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++) {
        const vlSamplerKernels *k = vl_sampler_kernels(isa);
        k->get_2d(&s, BATCH, px, py, index, 6, u_, v_);
        k->get_1d(&s, BATCH, px, py, index, 8, w_);
        assert_memory_equal(ru, u_, sizeof u_);
        assert_memory_equal(rv, v_, sizeof v_);
        assert_memory_equal(rw, w_, sizeof w_);
        for (int i = 0; i < 512; i += 16) { /* the same alone, whatever else is in the batch */
          k->get_2d(&s, 16, px + i, py + i, index + i, 6, u_, v_);
          assert_memory_equal(ru + i, u_, 64);
          assert_memory_equal(rv + i, v_, 64);
        }
      }
      if (kind != VL_SAMPLER_REGULAR || spp > 4) { /* seeds and dimensions differ */
        vlSampler t = s;
        t.seed++;
        vl_sampler_kernel_table.get_2d(&t, BATCH, px, py, index, 6, u_, v_);
        assert_true(memcmp(ru, u_, sizeof u_) != 0);
        vl_sampler_kernel_table.get_2d(&s, BATCH, px, py, index, 4, u_, v_);
        assert_true(memcmp(ru, u_, sizeof u_) != 0);
      }
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_range),        cmocka_unit_test(test_strata),
      cmocka_unit_test(test_nets),         cmocka_unit_test(test_columns),
      cmocka_unit_test(test_with),         cmocka_unit_test(test_uniform),
      cmocka_unit_test(test_independence), cmocka_unit_test(test_regular),
      cmocka_unit_test(test_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
