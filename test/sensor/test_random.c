/* test/sensor/test_random.c: random numbers of sensors: the normal distribution's inverse, log
 * k!, and Poisson numbers by chi-square over means from 0.01 to 1e5, where both methods
 * (inversion, rejection) are. */
#include "math/approx_double.h"
#include "sensor/random.h"
#include "statistics.h"
#include "unit.h"

static void normal_inverse(void **state) {
  (void)state;
  for (int i = 1; i < 4000; i++) {
    double p = i < 2000 ? pow(10.0, -15.0 * (2000 - i) / 2000.0) * 0.5
                        : 1.0 - 0.5 * (4000 - i) / 2000.0;
    double back = 0.5 * erfc(-vl_normal_inverse(p) / sqrt(2.0));
    assert_true(fabs(back - p) < 1e-13 * p * 20.0 + 1e-16);
  }
}

static void logarithm(void **state) {
  (void)state;
  statRng rng = stat_rng(5);
  for (int i = 0; i < 200000; i++) {
    double x = ldexp(0.5 + 0.5 * (double)stat_float(&rng), (int)(stat_bits(&rng) % 1800) - 900);
    double exact = log(x);
    assert_true(fabs(vl_log_double(x) - exact) <= 4e-16 * fabs(exact) + 2e-16);
  }
  for (int i = -1000; i <= 1000; i++)
    assert_true(fabs(vl_log_double(1.0 + i * 1e-5) - log1p(i * 1e-5)) < 2e-16);
}

static void factorials(void **state) {
  (void)state;
  for (double k = 0.0; k < 1e12; k = k < 200.0 ? k + 1.0 : floor(k * 1.37))
    assert_true(fabs(vl_log_factorial(k) - lgamma(k + 1.0)) <= 2e-13 * lgamma(k + 1.0) + 4e-14);
}

enum { DRAWS = 200000, CELLS = 64 };

/* Chi-square of numbers of that mean, in cells of equal probability as near as whole numbers
 * allow. */
static double chi_square_p(double mean, uint32_t seed) {
  static double expected[CELLS], counted[CELLS];
  static double top[CELLS];
  double deviation = sqrt(mean);
  double low = floor(fmax(0.0, mean - 8.0 * deviation - 8.0));
  double high = ceil(mean + 8.0 * deviation + 40.0);
  int cells = 0;
  double sum = 0.0;
  for (double k = low; k <= high && cells < CELLS; k += 1.0) {
    sum += exp(k * log(mean) - mean - lgamma(k + 1.0));
    if (sum > 1.0 / 40.0) {
      expected[cells] = sum;
      top[cells++] = k;
      sum = 0.0;
    }
  }
  double used = 0.0;
  for (int i = 0; i < cells; i++)
    used += expected[i];
  if ((1.0 - used) * DRAWS > 10.0) {
    expected[cells] = 1.0 - used;
    top[cells++] = INFINITY;
  } else {
    top[cells - 1] = INFINITY;
    expected[cells - 1] += 1.0 - used;
  }
  memset(counted, 0, sizeof counted);
  uint64_t key = vl_random_key(seed, 3, VL_STAGE_ELECTRONS);
  for (int i = 0; i < DRAWS; i++) {
    vlRandom random = vl_random_at(key, (uint64_t)i);
    double k = vl_random_poisson(&random, mean);
    assert_true(k >= 0.0 && k == floor(k));
    int cell = 0;
    while (k > top[cell])
      cell++;
    counted[cell] += 1.0;
  }
  double chi = 0.0;
  for (int i = 0; i < cells; i++) {
    double d = counted[i] - expected[i] * DRAWS;
    chi += d * d / (expected[i] * DRAWS);
  }
  return stat_gamma_q(0.5 * (cells - 1), 0.5 * chi);
}

static void poisson(void **state) {
  (void)state;
  static const double means[] = {0.01, 0.1, 0.5,  1,   2.5, 5,   9.99,
                                 10,   12,  30.3, 1e2, 1e3, 1e4, 1e5};
  enum { COUNT = sizeof means / sizeof *means };
  for (int i = 0; i < COUNT; i++) {
    double p = chi_square_p(means[i], (uint32_t)i);
    if (p < 1e-3 / COUNT)
      fail_msg("mean %g: p = %g", means[i], p);
  }
}

/* Mean and variance of large means, to five standard errors. */
static void poisson_large_means(void **state) {
  (void)state;
  static const double means[] = {1e6, 1e8, 9e9};
  for (int m = 0; m < 3; m++) {
    double sum = 0.0;
    double squares = 0.0;
    uint64_t key = vl_random_key(9, 0, VL_STAGE_ELECTRONS);
    for (int i = 0; i < DRAWS; i++) {
      vlRandom random = vl_random_at(key, (uint64_t)i);
      double d = (vl_random_poisson(&random, means[m]) - means[m]) / sqrt(means[m]);
      sum += d;
      squares += d * d;
    }
    assert_true(fabs(sum / DRAWS) < 5.0 / sqrt(DRAWS));
    assert_true(fabs(squares / DRAWS - 1.0) < 5.0 * sqrt(2.0 / DRAWS));
  }
  vlRandom random = {1};
  assert_true(vl_random_poisson(&random, 0.0) == 0.0);
  assert_true(vl_random_poisson(&random, 1e15) == 1e15);
}

/* Numbers of neighbouring indices, stages, frames and seeds are independent. */
static void independent(void **state) {
  (void)state;
  enum { COUNT = 100000 };
  double products[4] = {0};
  for (uint64_t i = 0; i < COUNT; i++) {
    uint64_t keys[3] = {vl_random_key(1, 0, VL_STAGE_READ), vl_random_key(1, 1, VL_STAGE_READ),
                        vl_random_key(2, 0, VL_STAGE_READ)};
    vlRandom at[5] = {vl_random_at(keys[0], i), vl_random_at(keys[0], i + 1),
                      vl_random_at(vl_random_key(1, 0, VL_STAGE_ADC), i),
                      vl_random_at(keys[1], i), vl_random_at(keys[2], i)};
    double first = vl_random_normal(&at[0]);
    for (int j = 0; j < 4; j++)
      products[j] += first * vl_random_normal(&at[j + 1]);
  }
  for (int j = 0; j < 4; j++)
    assert_true(fabs(products[j]) < 5.0 * sqrt(COUNT));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(normal_inverse),      cmocka_unit_test(logarithm),
      cmocka_unit_test(factorials),          cmocka_unit_test(poisson),
      cmocka_unit_test(poisson_large_means), cmocka_unit_test(independent)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
