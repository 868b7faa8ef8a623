/* test/color/test_sensor.c: measured cameras: each matrix computed independently (normal
 * equations of each row by Gaussian elimination), white stays white, daylight agrees with the
 * CIE's. */
#include <math.h>
#include <string.h>

#include "color/named.h"
#include "color/sensor.h"
#include "unit.h"
#include "velo/render.h"

/* Linear between samples 10 nm apart from 380 nm, 0 outside; with its own walk over the
 * samples. */
static double value_at(const float *v, int count, int stride, double lambda) {
  double sum = 0;
  if (lambda < 380 || lambda > 380 + 10 * (count - 1))
    return 0;
  for (int i = 0; i < count; i++) {
    double hat = 1 - fabs(lambda - (380 + 10 * i)) / 10;
    if (hat > 0)
      sum += hat * (double)v[i * stride];
  }
  return sum;
}

static double integral(const float *patch, const double *light, const float *curve, int k) {
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    double reflected = patch ? value_at(patch, VL_CHECKER_SAMPLES, 1, 360.0 + i) : 1;
    double seen =
        k >= 0 ? value_at(curve + k, VL_SENSOR_SAMPLES, 3, 360.0 + i) : (double)curve[i];
    sum += reflected * light[i] * seen;
  }
  return sum;
}

/* Row by row: a m = b for the 24 patches, by the normal equations. */
static void fit(const double a[VL_CHECKER_PATCHES][3], const double b[VL_CHECKER_PATCHES],
                double row[3]) {
  double s[3][4] = {{0}};
  for (int p = 0; p < VL_CHECKER_PATCHES; p++)
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++)
        s[i][k] += a[p][i] * a[p][k];
      s[i][3] += a[p][i] * b[p];
    }
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++)
      for (int j = 3; i != k && j >= k; j--)
        s[i][j] -= s[i][k] / s[k][k] * s[k][j];
  for (int k = 0; k < 3; k++)
    row[k] = s[k][3] / s[k][k];
}

static void matrices(void **state) {
  (void)state;
  const float *eye[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  assert_int_equal(vl_sensor_count, 17);
  for (uint32_t n = 0; n < vl_sensor_count; n++)
    for (int warm = 0; warm < 2; warm++) {
      static float observer[4 * VL_LAMBDA_COUNT];
      const vlSensorCurves *sensor = &vl_sensor_curves[n];
      vlColorSpace space = warm ? VL_SPACE_ACES2065_1 : VL_SPACE_SRGB;
      double kelvin = warm ? 3200 : 6500, m[9], light[VL_LAMBDA_COUNT], white[VL_LAMBDA_COUNT];
      double rgb[VL_CHECKER_PATCHES][3], xyz[3][VL_CHECKER_PATCHES];
      vl_sensor_make(sensor, kelvin, space, observer, m);
      vl_daylight(kelvin, light);
      for (int i = 0; i < VL_LAMBDA_COUNT; i++)
        white[i] = (double)vl_space_illuminant(space)[i];
      double green = integral(NULL, light, sensor->rgb, 1),
             y = integral(NULL, light, eye[1], -1);
      double white_y = integral(NULL, white, eye[1], -1);
      for (int p = 0; p < VL_CHECKER_PATCHES; p++)
        for (int k = 0; k < 3; k++) {
          rgb[p][k] = integral(vl_checker_patches[p], light, sensor->rgb, k) / green;
          xyz[k][p] =
              integral(vl_checker_patches[p], white, eye[k], -1) / white_y * (y / green);
        }
      for (int k = 0; k < 3; k++) {
        double row[3];
        fit((const double(*)[3])rgb, xyz[k], row);
        for (int j = 0; j < 3; j++)
          assert_true(fabs(row[j] - m[3 * k + j]) < 1e-5 * (1 + fabs(row[j])));
      }
      /* White under the sensor's light is near the space's white, as bright as it is. */
      double seen[3], is[3];
      for (int k = 0; k < 3; k++)
        seen[k] = integral(NULL, light, sensor->rgb, k) / y;
      for (int k = 0; k < 3; k++) {
        is[k] = m[3 * k] * seen[0] + m[3 * k + 1] * seen[1] + m[3 * k + 2] * seen[2];
        assert_true(fabs(is[k] - integral(NULL, white, eye[k], -1) / white_y) < 0.05);
      }
    }
}

/* D65 is at 6504 K today; below 4000 K light is a black body's. */
static void daylight(void **state) {
  (void)state;
  double light[VL_LAMBDA_COUNT], sum = 0, whole = 0;
  const float *d65 = vl_named_spectrum("stdillum-D65");
  vl_daylight(6500, light); /* 6504 K with the constant of its time */
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    sum += light[i];
    whole += (double)d65[i];
  }
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    assert_true(fabs(light[i] / sum * whole / (double)d65[i] - 1) < 4e-3);
  vl_daylight(3000, light);
  double t = 3000 * 1.4388 / 1.4380;
  for (int i = 0; i < VL_LAMBDA_COUNT; i += 47) {
    double nm = 360 + i, body = pow(nm, -5) / (exp(1.438776877e7 / (nm * t)) - 1);
    double first = pow(360, -5) / (exp(1.438776877e7 / (360 * t)) - 1);
    assert_true(fabs(light[i] / light[0] / (body / first) - 1) < 1e-9);
  }
}

static void names(void **state) {
  (void)state;
  assert_string_equal(vl_sensor_name(0), "cie1931");
  for (uint32_t i = 1; i <= vl_sensor_count; i++)
    assert_ptr_equal(vl_sensor_find(vl_sensor_name(i)), vl_sensor_curves + i - 1);
  for (uint32_t i = 1; i < vl_sensor_count; i++)
    assert_true(strcmp(vl_sensor_name(i), vl_sensor_name(i + 1)) < 0);
  assert_null(vl_sensor_name(vl_sensor_count + 1));
  assert_null(vl_sensor_find("nikon"));
  assert_null(vl_sensor_find(NULL));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(matrices), cmocka_unit_test(daylight),
                                     cmocka_unit_test(names)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
