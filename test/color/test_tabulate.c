/* test/color/test_tabulate.c: the public numbers behind a spectrum (velo/color.h): the tables
 * agree with the spectra that velo renders with. */
#include <math.h>

#include <velo/color.h>

#include "color/color.h"
#include "unit.h"

static void roles_give_their_spectra(void **state) {
  (void)state;
  vlSpectrum green = vl_spectrum_rgb(0.1f, 0.8f, 0.2f);
  float values[VL_SPECTRUM_VALUES], dense[VL_LAMBDA_COUNT], white[VL_SPECTRUM_VALUES];
  const vlParameterRole roles[3] = {VL_PARAMETER_ALBEDO, VL_PARAMETER_UNBOUNDED,
                                    VL_PARAMETER_ILLUMINANT};
  const vlSpectrumRole own[3] = {VL_ROLE_ALBEDO, VL_ROLE_UNBOUNDED, VL_ROLE_ILLUMINANT};
  for (int k = 0; k < 3; k++) {
    assert_int_equal(vl_spectrum_tabulate(&green, roles[k], values, NULL), VL_OK);
    assert_int_equal(vl_spectrum_dense(&green, own[k], dense, NULL), VL_OK);
    assert_memory_equal(values, dense, sizeof values);
  }
  assert_int_equal(vl_white_tabulate(VL_SPACE_SRGB, white), VL_OK);
  vlSpectrum one = vl_spectrum_rgb(1, 1, 1);
  assert_int_equal(vl_spectrum_tabulate(&one, VL_PARAMETER_ILLUMINANT, values, NULL), VL_OK);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
    assert_float_equal(values[i], white[i], 1e-4f * white[i]);
}

/* A reflectance looked up for a texel has its colour under the white: the integral of observer,
 * white and spectrum. */
static void reflectances_have_their_color(void **state) {
  (void)state;
  static const float colors[4][3] = {
      {0.5f, 0.5f, 0.5f}, {0.9f, 0.1f, 0.1f}, {0.05f, 0.3f, 0.7f}, {0.8f, 0.75f, 0.1f}};
  static float observer[3 * VL_SPECTRUM_VALUES], white[VL_SPECTRUM_VALUES];
  double nm[VL_SPECTRUM_VALUES], values[VL_SPECTRUM_VALUES], matrix[9];
  vl_observer_tabulate(observer);
  assert_int_equal(vl_white_tabulate(VL_SPACE_SRGB, white), VL_OK);
  assert_int_equal(vl_color_space_matrix(VL_SPACE_SRGB, matrix), VL_OK);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
    nm[i] = VL_SPECTRUM_FIRST_NM + i;
  for (int c = 0; c < 4; c++) {
    double xyz[3] = {0, 0, 0}, luminance = 0;
    assert_int_equal(
        vl_reflectance_at(VL_SPACE_SRGB, colors[c], VL_SPECTRUM_VALUES, nm, values), VL_OK);
    for (int i = 0; i < VL_SPECTRUM_VALUES; i++) {
      for (int k = 0; k < 3; k++)
        xyz[k] += (double)observer[3 * i + k] * (double)white[i] * values[i];
      luminance += (double)observer[3 * i + 1] * (double)white[i];
    }
    for (int k = 0; k < 3; k++) {
      double rgb =
          (matrix[3 * k] * xyz[0] + matrix[3 * k + 1] * xyz[1] + matrix[3 * k + 2] * xyz[2]) /
          luminance;
      assert_float_equal(rgb, colors[c][k], 2e-3);
    }
  }
}

/* White light of which one channel alone is left has that channel's colour; the three together
 * are white light. */
static void channels_have_their_colors(void **state) {
  (void)state;
  static float observer[3 * VL_SPECTRUM_VALUES], white[VL_SPECTRUM_VALUES],
      shares[3 * VL_SPECTRUM_VALUES];
  double matrix[9], luminance = 0, xyz[3][3] = {{0}};
  vl_observer_tabulate(observer);
  vl_channels_tabulate(shares);
  assert_int_equal(vl_white_tabulate(VL_SPACE_SRGB, white), VL_OK);
  assert_int_equal(vl_color_space_matrix(VL_SPACE_SRGB, matrix), VL_OK);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++) {
    const float *s = shares + 3 * i;
    assert_true(s[0] >= 0 && s[1] >= 0 && s[2] >= 0);
    assert_float_equal(s[0] + s[1] + s[2], 1, 1e-5);
    luminance += (double)observer[3 * i + 1] * (double)white[i];
    for (int c = 0; c < 3; c++) {
      for (int k = 0; k < 3; k++)
        xyz[c][k] += (double)observer[3 * i + k] * (double)white[i] * (double)s[c];
    }
  }
  for (int c = 0; c < 3; c++) {
    for (int k = 0; k < 3; k++) {
      double rgb = (matrix[3 * k] * xyz[c][0] + matrix[3 * k + 1] * xyz[c][1] +
                    matrix[3 * k + 2] * xyz[c][2]) /
                   luminance;
      assert_float_equal(rgb, c == k ? 1 : 0, 2e-3);
    }
  }
}

static void wrong_arguments_are_refused(void **state) {
  (void)state;
  float values[VL_SPECTRUM_VALUES], rgb[3] = {0, 0, 0};
  double matrix[9];
  vlSpectrum s = vl_spectrum_named("no such glass");
  vlError error = {0};
  assert_int_equal(vl_spectrum_tabulate(&s, VL_PARAMETER_ALBEDO, values, &error),
                   VL_ERROR_SCENE);
  assert_int_equal(vl_spectrum_tabulate(NULL, VL_PARAMETER_ALBEDO, values, &error),
                   VL_ERROR_ARGUMENT);
  s = vl_spectrum_constant(1);
  assert_int_equal(vl_spectrum_tabulate(&s, VL_PARAMETER_NO_ROLE, values, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_spectrum_linear_rgb(&s, VL_PARAMETER_NO_ROLE, rgb, &error),
                   VL_ERROR_ARGUMENT);
  assert_float_equal(vl_spectrum_luminance(NULL, &error), 0, 0);
  assert_int_equal(vl_color_space_matrix((vlColorSpace)99, matrix), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_white_tabulate((vlColorSpace)99, values), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_reflectance_at((vlColorSpace)99, rgb, 0, NULL, NULL), VL_ERROR_ARGUMENT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(roles_give_their_spectra),
      cmocka_unit_test(reflectances_have_their_color),
      cmocka_unit_test(channels_have_their_colors),
      cmocka_unit_test(wrong_arguments_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
