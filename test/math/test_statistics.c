/* test/math/test_statistics.c: the statistical tests themselves: known values of the chi-square
 * distribution; correct samplers pass, slightly wrong ones fail. */
#include "statistics.h"
#include "unit.h"

static void test_distribution(void **state) {
  (void)state;
  /* quantiles from tables (Abramowitz and Stegun 26.8) */
  assert_true(fabs(stat_chi2_q(3.841458820694124, 1) - 0.05) < 1e-12);
  assert_true(fabs(stat_chi2_q(124.342113404004, 100) - 0.05) < 1e-11);
  assert_true(fabs(stat_chi2_q(6.634896601021214, 1) - 0.01) < 1e-12);
  assert_true(fabs(stat_chi2_q(0.02, 2) - exp(-0.01)) < 1e-14); /* exp(-x / 2) */
  assert_true(fabs(stat_chi2_q(50, 2) - exp(-25)) < 1e-22);
  assert_true(stat_chi2_q(0, 5) == 1 && stat_chi2_q(1e5, 10) < 1e-300);
}

static double cosine(void *user, const double d[3]) {
  (void)user;
  return d[2] > 0 ? d[2] / 3.14159265358979 : 0;
}
/* cosine-distributed with z raised to a power; keep: the share of tries that is not rejected */
static statResult try_cosine(uint64_t seed, double power, double keep, int n) {
  statRng rng = stat_rng(seed);
  statSphere hist = stat_sphere_new(16, 32);
  for (int i = 0; i < n; i++) {
    double z = pow(stat_double(&rng), power), phi = 6.283185307179586 * stat_double(&rng),
           r = sqrt(1 - z * z);
    if (stat_double(&rng) < keep)
      stat_sphere_add(hist, r * cos(phi), r * sin(phi), z);
    else
      stat_sphere_reject(hist);
  }
  return stat_sphere_test(hist, cosine, NULL, 0);
}

static void test_verdicts(void **state) {
  (void)state;
  double sum = 0;
  int low = 0;
  enum { RUNS = 200 };
  for (uint64_t seed = 1; seed <= RUNS; seed++) { /* p is itself uniform for a right sampler */
    statResult r = try_cosine(seed, 0.5, 1, 5000);
    assert_true(fabs(r.integral - 1) < 1e-6);
    sum += r.p;
    low += r.p < 0.1;
  }
  assert_true(fabs(sum / RUNS - 0.5) < 0.1 && low > RUNS / 25 && low < RUNS / 5);
  assert_true(try_cosine(1, 0.51, 1, 200000).p < 1e-6);   /* a slightly other shape */
  assert_true(try_cosine(2, 0.5, 0.99, 200000).p < 1e-6); /* one in a hundred lost */
}

static void test_pooling(void **state) {
  (void)state;
  statCell few[4] = {{1, 1}, {0, 0.5}, {2, 1.5}, {97, 97}};
  statResult r = stat_chi2(few, 4, 1);
  assert_true(r.p > 0.5);
  statCell impossible[3] = {{10, 0}, {50, 55}, {50, 55}}; /* samples where none can be */
  assert_true(stat_chi2(impossible, 3, 1).p == 0);
  statCell negative[2] = {{50, 50}, {50, -1}};
  assert_true(stat_chi2(negative, 2, 1).p == 0);
  uint32_t even[8] = {100, 104, 96, 101, 99, 100, 95, 105},
           odd[8] = {100, 100, 100, 100, 100, 100, 160, 40};
  assert_true(stat_chi2_uniform(even, 8).p > 0.5 && stat_chi2_uniform(odd, 8).p < 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_distribution),
      cmocka_unit_test(test_verdicts),
      cmocka_unit_test(test_pooling),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
