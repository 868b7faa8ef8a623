/* test/camera/test_approx_double.c: the elementary functions in double, compared with the C
 * library's long double. */
#include "camera/cameras.h"

#include "math/approx_double.h"

static void sincos_is_near_the_last_bit(void **state) {
  (void)state;
  uint64_t random = 1;
  double worst = 0, worst_far = 0;
  for (int i = 0; i < 400000; i++) {
    double x = next_between(&random, -7, 7), far = next_between(&random, -1000, 1000);
    vlSinCosDouble a = vl_sincos_double(x), b = vl_sincos_double(far);
    worst = fmax(worst, fmax(fabs((double)(a.sin - sinl(x))), fabs((double)(a.cos - cosl(x)))));
    worst_far = fmax(
        worst_far, fmax(fabs((double)(b.sin - sinl(far))), fabs((double)(b.cos - cosl(far)))));
  }
  print_message("sincos: %.3g within 7, %.3g within 1000\n", worst, worst_far);
  assert_true(worst < 2e-16 && worst_far < 2e-16);
  vlSinCosDouble zero = vl_sincos_double(0);
  assert_true(zero.sin == 0 && zero.cos == 1);
  /* small angles keep their relative precision */
  for (int i = 0; i < 100000; i++) {
    double x = exp(next_between(&random, -300, 0));
    assert_true(fabs(vl_sincos_double(x).sin / (double)sinl(x) - 1) < 4e-16);
  }
}

static void atan2_is_near_the_last_bit(void **state) {
  (void)state;
  uint64_t random = 2;
  double worst = 0;
  for (int i = 0; i < 400000; i++) {
    double y = next_between(&random, -1, 1),
           x = next_between(&random, -1, 1) * exp(next_between(&random, -20, 20));
    worst = fmax(worst, fabs((double)(vl_atan2_double(y, x) / atan2l(y, x) - 1)));
  }
  print_message("atan2: %.3g relative\n", worst);
  assert_true(worst < 5e-16);
  assert_true(vl_atan2_double(0, 0) == 0 && vl_atan2_double(0, 1) == 0);
  assert_true(vl_atan2_double(0, -1) == M_PI && vl_atan2_double(1, 0) == M_PI_2 &&
              vl_atan2_double(-1, 0) == -M_PI_2);
}

static void acos_is_near_the_last_bit(void **state) {
  (void)state;
  uint64_t random = 3;
  double worst = 0;
  for (int i = 0; i < 400000; i++) {
    double x = i % 2 ? next_between(&random, -1, 1) : 1 - exp(next_between(&random, -30, 0));
    worst = fmax(worst, fabs((double)(vl_acos_double(x) / acosl(x) - 1)));
  }
  print_message("acos: %.3g relative\n", worst);
  assert_true(worst < 1e-15);
  assert_true(vl_acos_double(1) == 0 && vl_acos_double(-1) == M_PI &&
              vl_acos_double(0) == M_PI_2);
}

static void exp_is_near_the_last_bit(void **state) {
  (void)state;
  uint64_t random = 4;
  double worst = 0;
  for (int i = 0; i < 400000; i++) {
    double x = i % 2 ? next_between(&random, -708, 709) : next_between(&random, -1, 1);
    worst = fmax(worst, fabs((double)(vl_exp_double(x) / expl(x) - 1)));
  }
  print_message("exp: %.3g relative\n", worst);
  assert_true(worst < 4e-16);
  assert_true(vl_exp_double(0) == 1 && vl_exp_double(-1e9) < 1e-307 &&
              isfinite(vl_exp_double(1e9)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sincos_is_near_the_last_bit),
      cmocka_unit_test(atan2_is_near_the_last_bit),
      cmocka_unit_test(acos_is_near_the_last_bit),
      cmocka_unit_test(exp_is_near_the_last_bit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
