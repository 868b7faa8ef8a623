/* test/math/test_elementary.c: compares the correctly rounded elementary functions with those
 * of the C library in long double, whose error is some thousandths of a double's last place. */
#include <math.h>
#include <string.h>

#include "math/elementary.h"
#include "statistics.h"
#include "unit.h"

enum { N = 20000 };

/* Error of `got` in units in its last place. */
static double error_of(double got, long double expected) {
  if (isnan(got) || isinf(got))
    return isnan(got) == isnan((double)expected) && (isnan(got) || got == (double)expected)
               ? 0
               : 1e9;
  double unit = nextafter(fabs(got), INFINITY) - fabs(got);
  return (double)(fabsl((long double)got - expected) / (long double)unit);
}

typedef struct Case {
  const char *name;
  double (*mine)(double);
  long double (*theirs)(long double);
  double low, high;
} Case;

static void one_argument(void **state) {
  (void)state;
  static const Case cases[] = {
      {"sin", vl_precise_sin, sinl, -7, 7},
      {"sin", vl_precise_sin, sinl, -1e5, 1e5},
      {"cos", vl_precise_cos, cosl, -7, 7},
      {"cos", vl_precise_cos, cosl, -1e5, 1e5},
      {"tan", vl_precise_tan, tanl, -1.58, 1.58},
      {"acos", vl_precise_acos, acosl, -1, 1},
      {"acos", vl_precise_acos, acosl, 0.9999, 1},
      {"atan", vl_precise_atan, atanl, -9, 9},
      {"atan", vl_precise_atan, atanl, -1e9, 1e9},
      {"exp", vl_precise_exp, expl, -700, 700},
      {"exp", vl_precise_exp, expl, -1, 1},
      {"exp2", vl_precise_exp2, exp2l, -1000, 1000},
      {"expm1", vl_precise_expm1, expm1l, -1, 1},
      {"expm1", vl_precise_expm1, expm1l, -70, 200},
      {"expm1", vl_precise_expm1, expm1l, 0, 1e-9},
      {"log", vl_precise_log, logl, 0, 3},
      {"log", vl_precise_log, logl, 0.999, 1.001},
      {"log", vl_precise_log, logl, 0, 1e300},
      {"log2", vl_precise_log2, log2l, 0, 300},
      {"log10", vl_precise_log10, log10l, 0, 300},
      {"cbrt", vl_precise_cbrt, cbrtl, -1000, 1000},
  };
  statRng rng = stat_rng(7);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const Case *c = &cases[k];
    for (int i = 0; i < N; i++) {
      double x = c->low + (c->high - c->low) * stat_double(&rng), got = c->mine(x);
      if (!(error_of(got, c->theirs(x)) < 0.51))
        fail_msg("%s(%a) = %a, not %La", c->name, x, got, c->theirs(x));
    }
  }
}

static void two_arguments(void **state) {
  (void)state;
  statRng rng = stat_rng(8);
  for (int i = 0; i < N; i++) {
    double x = 20 * stat_double(&rng) - 10, y = 20 * stat_double(&rng) - 10,
           a = vl_precise_atan2(y, x);
    if (!(error_of(a, atan2l(y, x)) < 0.51))
      fail_msg("atan2(%a, %a) = %a", y, x, a);
    a = vl_precise_hypot(x, y);
    if (!(error_of(a, hypotl(x, y)) < 0.51))
      fail_msg("hypot(%a, %a) = %a", x, y, a);
    a = vl_precise_pow(fabs(x), 10 * y);
    if (!(error_of(a, powl(fabsl((long double)x), 10 * y)) < 0.55))
      fail_msg("pow(%a, %a) = %a", fabs(x), 10 * y, a);
  }
}

/* The bits of a double, which also distinguish 0 from -0. */
static uint64_t bits(double x) {
  uint64_t b;
  memcpy(&b, &x, sizeof b);
  return b;
}

static void ends(void **state) {
  (void)state;
  assert_true(vl_precise_pow(10, 2) == 100 && vl_precise_pow(2, -3) == 0.125 &&
              vl_precise_pow(-2, 3) == -8);
  assert_true(vl_precise_pow(0, 2) == 0 && vl_precise_pow(0, -1) == INFINITY &&
              vl_precise_pow(5, 0) == 1);
  assert_true(isnan(vl_precise_pow(-2, 0.5)) && vl_precise_pow(2, 1e9) == INFINITY &&
              vl_precise_pow(2, -1e9) == 0);
  assert_true(vl_precise_exp(0) == 1 && vl_precise_exp(1000) == INFINITY &&
              vl_precise_exp(-1000) == 0);
  assert_true(vl_precise_exp(-INFINITY) == 0 && vl_precise_exp(INFINITY) == INFINITY &&
              isnan(vl_precise_exp(NAN)));
  assert_true(vl_precise_exp2(10) == 1024 && vl_precise_expm1(-INFINITY) == -1 &&
              vl_precise_log(1) == 0);
  assert_true(vl_precise_log(0) == -INFINITY && isnan(vl_precise_log(-1)) &&
              vl_precise_log2(8) == 3);
  assert_true(vl_precise_cbrt(-27) == -3 && vl_precise_hypot(3, 4) == 5);
  assert_true(vl_precise_acos(1) == 0 && vl_precise_acos(-1) == acos(-1) &&
              isnan(vl_precise_acos(1.5)));
  const double a[] = {0.0, -0.0, 1.0, -1.0, INFINITY, -INFINITY, 1e-300, -1e300, 0x1p-1000};
  for (int i = 0; i < 9; i++)
    for (int k = 0; k < 9; k++)
      assert_int_equal(bits(vl_precise_atan2(a[i], a[k])), bits(atan2(a[i], a[k])));
  assert_int_equal(bits(vl_precise_sin(-0.0)), bits(-0.0));
  assert_true(isnan(vl_precise_sin(INFINITY)) && isnan(vl_precise_cos(NAN)) &&
              isnan(vl_precise_tan(-INFINITY)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_argument),
      cmocka_unit_test(two_arguments),
      cmocka_unit_test(ends),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
