/* test/scene/test_verify_statistics.c: the statistics of `velo scene verify`: its distributions
 * against known values, and the rate of its false alarms, by simulation. */
#include "../../apps/velo/scene/verify_statistics.h"
#include "unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "statistics.h"

enum { REPLICATES = 32, BLOCKS = 48, VALUES = BLOCKS + 1 };

/* Values of R's pt and of tables. */
static void test_student(void **state) {
  (void)state;
  static const double known[][3] = {/* t, freedom, two-sided p */
                                    {12.706204736432095, 1, 0.05},
                                    {2.2281388519649385, 10, 0.05},
                                    {2.0395134463964077, 31, 0.05},
                                    {3.633456256, 31, 0.001},
                                    {1, 1, 0.5},
                                    {1.4142135623730951, 2, 0.29289321881345254}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const double p = verify_student_p(known[i][0], known[i][1]);
    if (!(fabs(p / known[i][2] - 1) < 1e-6))
      fail_msg("t = %g: p = %.12g, not %.12g", known[i][0], p, known[i][2]);
  }
  assert_true(verify_student_p(0, 31) == 1);
  assert_true(verify_student_p(INFINITY, 31) == 0);
  assert_true(verify_student_p(NAN, 31) == 1);
  /* two degrees of freedom have a closed form, also far out: p = 1 - t / sqrt(2 + t^2) */
  const double t = 1e4;
  assert_true(fabs(verify_student_p(t, 2) * t * t - 1) < 1e-6);
}

static void test_normal(void **state) {
  (void)state;
  assert_true(fabs(verify_normal_z(0.05) - 1.959963984540054) < 1e-9);
  assert_true(fabs(verify_normal_z(1e-9) - 6.109410204869) < 1e-6);
  assert_true(verify_normal_z(1) == 0 && verify_normal_z(0) > 36.9);
}

static void test_compare(void **state) {
  (void)state;
  const double a[] = {1, 5, 2, 5, 3, 5}, b[] = {0, 5, 1.5, 5, 0, 5}; /* every second value */
  VerifyDifference d = verify_compare(a, b, 3, 2, 0, 0);
  assert_true(fabs(d.a - 2) < 1e-12 && fabs(d.b - 0.5) < 1e-12);
  const double variance = verify_variance(a, b, 3, 2); /* of 1, 0.5, 3 */
  assert_true(fabs(variance - 1.75) < 1e-12);
  assert_true(fabs(d.error - sqrt(1.75 / 3)) < 1e-12);
  assert_true(fabs(d.p - verify_student_p(1.5 / d.error, 2)) < 1e-12 && d.z > 0);
  d = verify_compare(b, a, 3, 2, 0.5, 2); /* a smallest difference and a smallest error */
  assert_true(d.error == 2 && fabs(d.p - verify_student_p(0.5, 2)) < 1e-12 && d.z < 0);
  d = verify_compare(a + 1, b + 1, 3, 2, 0, 0); /* equal, without noise */
  assert_true(d.p == 1 && d.z == 0);
}

/* ---- false alarms ------------------------------------------------------------------------ */

/* The mean of `draws` radiances of mean 1. NORMAL: as of a smooth image. SKEWED: log-normal,
 * variance e^4 - 1 = 54, as of indirect light. PARETO: of index 1.6, without a variance. RARE:
 * half of the light comes in one path of 50,000. */
typedef enum Kind { NORMAL, SKEWED, PARETO, RARE, KINDS } Kind;

static double normal(statRng *rng) {
  return sqrt(-2 * log(1 - stat_double(rng))) * cos(6.283185307179586 * stat_double(rng));
}

static double radiance(Kind kind, statRng *rng, int draws) {
  double sum = 0;
  if (kind == NORMAL)
    return 1 + normal(rng) / sqrt(draws);
  for (int i = 0; i < draws; i++) {
    if (kind == SKEWED)
      sum += exp(2 * normal(rng) - 2);
    if (kind == PARETO)
      sum += 0.375 * pow(1 - stat_double(rng), -0.625);
    if (kind == RARE)
      sum += 0.5 + (stat_double(rng) < 2e-5 ? 25000.0 : 0.0);
  }
  return sum / draws;
}

/* Replicates of two tracers with the same mean: one has hardly any noise, the other the given
 * one. The last value of a row is the whole image. */
static void simulate(Kind kind, statRng *rng, int draws, double *smooth, double *noisy) {
  for (int r = 0; r < REPLICATES; r++) {
    double *a = smooth + r * VALUES, *b = noisy + r * VALUES;
    a[BLOCKS] = b[BLOCKS] = 0;
    for (int k = 0; k < BLOCKS; k++) {
      a[k] = 1 + 0.02 * normal(rng);
      b[k] = radiance(kind, rng, draws);
      a[BLOCKS] += a[k] / BLOCKS;
      b[BLOCKS] += b[k] / BLOCKS;
    }
  }
}

/* Compares all values as `velo scene verify` does, and stores their differences. */
static void compare_all(const double *a, const double *b, VerifyDifference *found) {
  double variance = 0;
  for (int k = 0; k < BLOCKS; k++)
    variance += verify_variance(a + k, b + k, REPLICATES, VALUES) / BLOCKS;
  for (int k = 0; k < VALUES; k++)
    found[k] = verify_compare(a + k, b + k, REPLICATES, VALUES, 1e-3,
                              sqrt(variance / REPLICATES / (k == BLOCKS ? BLOCKS : 1)));
}

/* Whether a run raises an alarm in the first look, and in both. */
static bool alarms(Kind kind, statRng *rng, int draws, bool *first) {
  static double smooth[REPLICATES * VALUES], noisy[REPLICATES * VALUES];
  VerifyDifference one[VALUES], two[VALUES];
  bool marked[VALUES], both = false;
  uint32_t count = 0;
  simulate(kind, rng, draws, smooth, noisy);
  compare_all(smooth, noisy, one);
  for (int k = 0; k < VALUES; k++)
    count += marked[k] = one[k].p < verify_first_p(k == BLOCKS ? 1 : BLOCKS, 2);
  *first = count > 0;
  if (!count)
    return false;
  simulate(kind, rng, 4 * draws, smooth, noisy);
  compare_all(smooth, noisy, two);
  for (int k = 0; k < VALUES; k++)
    both = both ||
           (marked[k] && two[k].p < verify_second_p(count) && (two[k].z > 0) == (one[k].z > 0));
  return both;
}

/* VELO_SIMULATIONS=N: N runs of each kind; docs/verify.md has the numbers of many. */
static void test_false_alarms(void **state) {
  (void)state;
  static const char *const names[] = {"normal", "skewed", "pareto", "rare"};
  const char *given = getenv("VELO_SIMULATIONS");
  const int runs = given ? atoi(given) : 60;
  for (Kind kind = 0; kind < KINDS; kind++) {
    statRng rng = stat_rng(77 + kind);
    int first = 0, both = 0;
    for (int i = 0; i < (kind == NORMAL ? 20 * runs : runs); i++) {
      bool once;
      both += alarms(kind, &rng, 64, &once);
      first += once;
    }
    if (given)
      printf("%s: %d runs, first look %d, both %d\n", names[kind],
             kind == NORMAL ? 20 * runs : runs, first, both);
    if (!given && both)
      fail_msg("%s: %d false alarms", names[kind], both);
    if (!given && kind == NORMAL)
      assert_in_range(first, 1, 20 * runs * 3 / 100 * 2); /* the look is not idle */
  }
}

/* A bias of 3 % of one block, and of 1 % of the image, that have the noise of 64 samples, are
 * found. */
static void test_power(void **state) {
  (void)state;
  static double smooth[REPLICATES * VALUES], noisy[REPLICATES * VALUES];
  VerifyDifference found[VALUES];
  statRng rng = stat_rng(5);
  for (int kind = 0; kind < 2; kind++) {
    simulate(NORMAL, &rng, 4096, smooth, noisy);
    for (int r = 0; r < REPLICATES; r++)
      for (int k = 0; k < VALUES; k++)
        noisy[r * VALUES + k] += kind ? 0.01 : k == 7 ? 0.03 : 0;
    compare_all(smooth, noisy, found);
    assert_true(found[kind ? BLOCKS : 7].p < verify_first_p(kind ? 1 : BLOCKS, 2));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_student), cmocka_unit_test(test_normal),
      cmocka_unit_test(test_compare), cmocka_unit_test(test_false_alarms),
      cmocka_unit_test(test_power)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
