/* test/film/test_filter.c: pixel filters: samples follow the filter's shape, weights have mean
 * 1, monotone, the same bits on every instruction set. */
#include "base/context.h"
#include "filter/filter.h"
#include "statistics.h"
#include "unit.h"
#include "velo/filter_kinds.h"

enum { KINDS = VL_PIXEL_FILTER_BLACKMAN_HARRIS + 1, BATCH = 4096, TESTS = KINDS * 3 * 2 };
static const char *const NAMES[KINDS] = {"box",      "triangle", "gaussian",
                                         "mitchell", "lanczos",  "blackman-harris"};

static float u_[BATCH], v_[BATCH], dx_[BATCH], dy_[BATCH], w_[BATCH];
static vlFilterTable table_;
static vlContext *context_;

/* Makes table_ anew. */
static void compile(const vlPixelFilter *filter) {
  vl_filter_free(context_, &table_);
  assert_int_equal(vl_filter_compile(context_, filter, &table_), VL_OK);
}

static void refuse(const vlPixelFilter *filter) {
  vl_filter_free(context_, &table_);
  assert_int_equal(vl_filter_compile(context_, filter, &table_), VL_ERROR_ARGUMENT);
}

/* Default, a smaller one of unequal radii, a wide one. */
static vlPixelFilter variant(int kind, int k) {
  vlPixelFilter f = vl_default_pixel_filter((vlPixelFilterKind)kind);
  if (k == 1) {
    f.radius_x *= 0.75f;
    f.radius_y *= 0.6f;
    f.sigma = 0.3f;
    f.b = 0;
    f.c = 0.5f;
    f.tau = 2;
  }
  if (k == 2) {
    f.radius_x = f.radius_y = 7.5f;
    f.sigma = 4;
    f.b = 1;
    f.c = 0;
    f.tau = 8;
  }
  return f;
}

/* Shares of |f| in `cells` equal cells of one axis. */
static void shares(const vlPixelFilter *filter, int axis, int cells, double *share) {
  enum { STEPS = 64 };
  double radius = axis ? filter->radius_y : filter->radius_x, sum = 0;
  for (int c = 0; c < cells; c++) {
    share[c] = 0;
    for (int i = 0; i < STEPS; i++)
      share[c] += fabs(
          vl_filter_value(filter, axis, radius * (2 * (c + (i + 0.5) / STEPS) / cells - 1)));
    sum += share[c];
  }
  for (int c = 0; c < cells; c++)
    share[c] /= sum;
}

static void test_shape(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++)
    for (int k = 0; k < 3; k++) {
      vlPixelFilter f = variant(kind, k);
      compile(&f);
      statRng rng = stat_rng(100 + (uint64_t)kind * 3 + (uint64_t)k);
      enum { NX = 60, NY = 52 };
      static double counts[NX * NY];
      memset(counts, 0, sizeof counts);
      double sum = 0, magnitude = 0, mean_x = 0;
      int batches = 150;
      for (int b = 0; b < batches; b++) {
        for (int i = 0; i < BATCH; i++) {
          u_[i] = stat_float(&rng);
          v_[i] = stat_float(&rng);
        }
        vl_filter_kernels(vl_isa_best())->sample(&table_, BATCH, u_, v_, dx_, dy_, w_);
        for (int i = 0; i < BATCH; i++) {
          double gx = (dx_[i] / f.radius_x + 1) * 0.5 * NX,
                 gy = (dy_[i] / f.radius_y + 1) * 0.5 * NY;
          counts[(int)fmin(gy, NY - 1) * NX + (int)fmin(gx, NX - 1)]++;
          sum += w_[i];
          mean_x += w_[i] * dx_[i];
          magnitude = fmax(magnitude, fabs(w_[i]));
          double value = vl_filter_value(&f, 0, dx_[i]) * vl_filter_value(&f, 1, dy_[i]);
          if (fabs(value) > 1e-4)
            assert_true((value < 0) == (w_[i] < 0));
        }
      }
      double n = (double)batches * BATCH;
      double share_x[NX], share_y[NY];
      shares(&f, 0, NX, share_x);
      shares(&f, 1, NY, share_y);
      static statCell cells[NX * NY];
      for (int c = 0; c < NX * NY; c++)
        cells[c] = (statCell){counts[c], n * share_x[c % NX] * share_y[c / NX]};
      if (!stat_accept(stat_chi2(cells, NX * NY, 1), TESTS))
        fail_msg("%s, variant %d", NAMES[kind], k);
      bool negative =
          kind == VL_PIXEL_FILTER_LANCZOS || (kind == VL_PIXEL_FILTER_MITCHELL && k != 2);
      if (negative) {
        assert_true(magnitude > 1.0 && magnitude < 4.0);
        assert_true(fabs(sum / n - 1) < 4 * magnitude / sqrt(n));
      } else {
        assert_true(magnitude == 1.0 && sum == n);
      }
      assert_true(fabs(mean_x / n) < 4 * magnitude * f.radius_x / sqrt(n));
    }
}

/* Stratified u: the mean weight is 1 to the precision of the strata; offsets rise with u and
 * are odd around its middle. */
static void test_order(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++)
    for (int k = 0; k < 3; k++) {
      vlPixelFilter f = variant(kind, k);
      compile(&f);
      double sum = 0;
      float before = -100;
      for (int b = 0; b < 64; b++) {
        for (int i = 0; i < BATCH; i++) {
          u_[i] = ((float)(b * BATCH + i) + 0.5f) / (64 * BATCH);
          v_[i] = 0.5f;
        }
        vl_filter_kernels(vl_isa_best())->sample(&table_, BATCH, u_, v_, dx_, dy_, w_);
        for (int i = 0; i < BATCH; i++) {
          assert_true(dx_[i] >= before && fabsf(dx_[i]) <= f.radius_x);
          before = dx_[i];
          sum += w_[i];
        }
      }
      bool analytic = kind == VL_PIXEL_FILTER_BOX || kind == VL_PIXEL_FILTER_TRIANGLE;
      /* the other axis' share of the weight */
      double middle = analytic ? 1 : table_.axis[1].sign[0];
      if (!(fabs(sum / (64.0 * BATCH) - middle) < 1e-4 * middle))
        fail_msg("%s, variant %d: mean weight %.9g, not %.9g", NAMES[kind], k,
                 sum / (64.0 * BATCH), middle);
      for (int i = 0; i < 64; i++) {
        u_[i] = (float)i / 128;
        u_[64 + i] = 1 - u_[i];
        v_[i] = v_[64 + i] = 0.25f;
      }
      vl_filter_kernels(vl_isa_best())->sample(&table_, 128, u_, v_, dx_, dy_, w_);
      for (int i = 0; i < 64; i++)
        assert_true(dx_[i] == -dx_[64 + i] && w_[i] == w_[64 + i]);
    }
}

static void test_bits(void **state) {
  (void)state;
  static float rx[BATCH], ry[BATCH], rw[BATCH];
  statRng rng = stat_rng(3);
  for (int i = 0; i < BATCH; i++) {
    u_[i] = stat_float(&rng);
    v_[i] = stat_float(&rng);
  }
  u_[0] = 0;
  v_[1] = 0;
  u_[2] = 0x1.fffffep-1f;
  v_[3] = 0x1.fffffep-1f;
  u_[4] = 0.5f;
  v_[5] = 0.5f;
  for (int kind = 0; kind < KINDS; kind++)
    for (int k = 0; k < 3; k++) {
      vlPixelFilter f = variant(kind, k);
      compile(&f);
      vl_filter_kernel_table.sample(&table_, BATCH, u_, v_, rx, ry, rw);
      for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++) {
        vl_filter_kernels(isa)->sample(&table_, BATCH, u_, v_, dx_, dy_, w_);
        assert_memory_equal(rx, dx_, sizeof rx);
        assert_memory_equal(ry, dy_, sizeof ry);
        assert_memory_equal(rw, w_, sizeof rw);
      }
      for (int i = 0; i < BATCH; i++)
        assert_true(fabsf(rx[i]) <= f.radius_x && fabsf(ry[i]) <= f.radius_y &&
                    fabsf(rw[i]) < 16);
    }
}

/* The filter along an axis in batches: the bits of vl_filter_curve_at, close to the filter,
 * with an integral of 1. */
static void test_curve(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++)
    for (int axis = 0; axis < 2; axis++) {
      vlPixelFilter f = variant(kind, 1);
      compile(&f);
      const vlFilterCurve *curve = &table_.curve[axis];
      double radius = axis ? f.radius_y : f.radius_x, sum = 0, exact = 0;
      for (int i = 0; i < BATCH; i++)
        u_[i] = (float)((2.2 * (i + 0.5) / BATCH - 1.1) * radius + 0.75);
      for (int i = 0; i < BATCH; i++)
        exact += vl_filter_value(&f, axis, (double)u_[i] - 0.75);
      for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++) {
        vl_filter_kernels(isa)->curve(curve, BATCH, u_, 0.75f, dx_);
        for (int i = 0; i < BATCH; i++)
          v_[i] = vl_filter_curve_at(curve, u_[i] - 0.75f);
        assert_memory_equal(v_, dx_, sizeof v_);
      }
      for (int i = 0; i < BATCH; i++) {
        double wanted = vl_filter_value(&f, axis, (double)u_[i] - 0.75) / exact;
        sum += v_[i] * 2.2 * radius / BATCH;
        assert_true(fabs(v_[i] * 2.2 * radius / BATCH - wanted) <
                    2e-3 / BATCH * (1 + fabs(wanted) * BATCH));
      }
      assert_true(fabs(sum - 1) < 1e-3);
    }
}

static void test_refusals(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++)
    for (int k = 0; k < 6; k++) {
      vlPixelFilter f = vl_default_pixel_filter((vlPixelFilterKind)kind);
      float bad[6] = {0, -1, NAN, INFINITY, 33, 1e30f};
      f.radius_y = bad[k];
      refuse(&f);
    }
  vlPixelFilter f = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  f.sigma = 0;
  refuse(&f);
  f.sigma = 1e-3f; /* far smaller than the radius */
  compile(&f);
  f = vl_default_pixel_filter(VL_PIXEL_FILTER_MITCHELL);
  f.b = 9;
  f.c = 0; /* below zero at its centre */
  refuse(&f);
  f = vl_default_pixel_filter(VL_PIXEL_FILTER_LANCZOS);
  f.radius_x = f.radius_y = 32;
  compile(&f);
  f.kind = (vlPixelFilterKind)17;
  refuse(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shape),    cmocka_unit_test(test_order),
      cmocka_unit_test(test_bits),     cmocka_unit_test(test_curve),
      cmocka_unit_test(test_refusals),
  };
  if (vl_context_create(NULL, &context_) != VL_OK)
    return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  vl_filter_free(context_, &table_);
  vl_context_destroy(context_);
  return failed;
}
