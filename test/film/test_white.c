/* test/film/test_white.c: white balance: daylight becomes white, D65 is unchanged, the matrix
 * of the Bradford transform as published. */
#include <math.h>
#include <string.h>

#include "color/color.h"
#include "film/white.h"
#include "unit.h"

static void apply(const float m[9], const double a[3], double r[3]) {
  for (int i = 0; i < 3; i++)
    r[i] = (double)m[3 * i] * a[0] + (double)m[3 * i + 1] * a[1] + (double)m[3 * i + 2] * a[2];
}

/* D50 to D65: Lindbloom's table, "Chromatic adaptation", Bradford. */
static void bradford(void **state) {
  (void)state;
  static const double expected[9] = {0.9555766, -0.0230393, 0.0631636,  -0.0282895, 1.0099416,
                                     0.0210077, 0.0122982,  -0.0204830, 1.3299098};
  float m[9];
  vl_white_balance(5000.0, VL_SPACE_SRGB, m);
  for (int i = 0; i < 9; i++)
    assert_true(fabs((double)m[i] - expected[i]) < 6e-3); /* D50 is at 5003 K */
  vl_white_balance(6500.0, VL_SPACE_SRGB, m);
  for (int i = 0; i < 9; i++)
    assert_true(fabs((double)m[i] - (i % 4 == 0)) < 3e-3);
}

/* A blackbody's own colour becomes white: luminance is kept, and x, y are those of D65. */
static void light_becomes_white(void **state) {
  (void)state;
  for (double kelvin = 1500; kelvin < 4000; kelvin += 500) {
    double xyz[3] = {0, 0, 0}, white[3], t = kelvin * 1.4388 / 1.4380;
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      double nm = 360 + i, light = pow(nm / 560, -5) / (exp(1.438776877e7 / (nm * t)) - 1);
      xyz[0] += light * (double)vl_cie_x()[i];
      xyz[1] += light * (double)vl_cie_y()[i];
      xyz[2] += light * (double)vl_cie_z()[i];
    }
    float m[9], xy[8];
    vl_white_balance(kelvin, VL_SPACE_SRGB, m);
    vl_space_chromaticities(VL_SPACE_SRGB, xy);
    apply(m, xyz, white);
    double sum = white[0] + white[1] + white[2];
    assert_true(fabs(white[0] / sum - (double)xy[6]) < 1e-5 &&
                fabs(white[1] / sum - (double)xy[7]) < 1e-5);
    assert_true(fabs(white[1] / xyz[1] - 1) < 1e-5);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bradford),
                                     cmocka_unit_test(light_becomes_white)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
