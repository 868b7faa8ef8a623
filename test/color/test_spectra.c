/* test/color/test_spectra.c: spectra and colour spaces: standard values of the CIE, measured
 * materials, the meaning of a vlSpectrum, its errors. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "color/color.h"
#include "color/named.h"
#include "unit.h"

static void xyz_of(const float *dense, double xyz[3]) {
  const float *cmf[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  for (int k = 0; k < 3; k++) {
    xyz[k] = 0;
    for (int i = 0; i < VL_LAMBDA_COUNT; i++)
      xyz[k] += (double)cmf[k][i] * (double)dense[i];
  }
}

static void test_observer(void **state) {
  (void)state;
  double sum[3] = {0};
  const float *cmf[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      assert_true(cmf[k][i] >= 0);
      sum[k] += (double)cmf[k][i];
    }
  /* CIE 15: the three areas agree (equal-energy white), up to rounding of the tables */
  assert_float_equal(sum[0], 106.865, 0.005);
  assert_float_equal(sum[1], 106.857, 0.001);
  assert_float_equal(sum[2], 106.892, 0.005);
  /* rows of the CIE's own 1 nm table */
  assert_float_equal(vl_cie_y()[555 - 360], 1.0, 1e-7);
  assert_float_equal(vl_cie_x()[441 - 360], 0.3495999, 2e-5);
  assert_float_equal(vl_cie_x()[408 - 360], 0.03388092, 3e-5);
  assert_float_equal(vl_cie_z()[445 - 360], 1.7826, 1e-6);
}

static void test_illuminants(void **state) {
  (void)state;
  /* chromaticities as published (CIE 15; ACES: SMPTE ST 2065-1) */
  static const struct {
    const char *name;
    double x, y, tolerance;
  } known[] = {
      {"stdillum-A", 0.44757, 0.40745, 3e-5},     {"stdillum-D50", 0.34567, 0.35850, 3e-5},
      {"stdillum-D65", 0.31272, 0.32903, 3e-5},   {"illum-acesD60", 0.32168, 0.33767, 3e-5},
      {"stdillum-F1", 0.31310, 0.33727, 1.5e-4},  {"stdillum-F2", 0.37208, 0.37529, 1.5e-4},
      {"stdillum-F3", 0.40910, 0.39430, 1.5e-4},  {"stdillum-F4", 0.44018, 0.40329, 1.5e-4},
      {"stdillum-F5", 0.31379, 0.34531, 1.5e-4},  {"stdillum-F6", 0.37790, 0.38835, 1.5e-4},
      {"stdillum-F7", 0.31292, 0.32933, 1.5e-4},  {"stdillum-F8", 0.34588, 0.35875, 1.5e-4},
      {"stdillum-F9", 0.37417, 0.37281, 1.5e-4},  {"stdillum-F11", 0.38052, 0.37713, 1.5e-4},
      {"stdillum-F12", 0.43695, 0.40441, 1.5e-4},
  };
  double unit = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    unit += (double)vl_cie_y()[i];
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const float *dense = vl_named_spectrum(known[i].name);
    assert_non_null(dense);
    double xyz[3];
    xyz_of(dense, xyz);
    double sum = xyz[0] + xyz[1] + xyz[2];
    if (fabs(xyz[0] / sum - known[i].x) > known[i].tolerance ||
        fabs(xyz[1] / sum - known[i].y) > known[i].tolerance)
      fail_msg("%s is at %.5f %.5f, not %.5f %.5f", known[i].name, xyz[0] / sum, xyz[1] / sum,
               known[i].x, known[i].y);
    assert_float_equal(xyz[1] / unit, 1.0, 1e-6);
  }
}

static void test_spaces(void **state) {
  (void)state;
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    float to[9], from[9], xy[8];
    vl_rgb_from_xyz((vlColorSpace)space, to);
    vl_xyz_from_rgb((vlColorSpace)space, from);
    vl_space_chromaticities((vlColorSpace)space, xy);
    double xyz[3], unit = 0;
    xyz_of(vl_space_illuminant((vlColorSpace)space), xyz);
    for (int i = 0; i < VL_LAMBDA_COUNT; i++)
      unit += (double)vl_cie_y()[i];
    for (int i = 0; i < 3; i++) {
      /* the illuminant is white */
      double white = 0;
      for (int k = 0; k < 3; k++)
        white += (double)to[3 * i + k] * xyz[k] / unit;
      assert_float_equal(white, 1.0, 1e-6);
      /* forwards and backwards */
      for (int j = 0; j < 3; j++) {
        double product = 0;
        for (int k = 0; k < 3; k++)
          product += (double)to[3 * i + k] * (double)from[3 * k + j];
        assert_float_equal(product, i == j ? 1.0 : 0.0, 2e-6);
      }
      /* primaries */
      double sum = (double)from[i] + (double)from[3 + i] + (double)from[6 + i];
      assert_float_equal((double)from[i] / sum, xy[2 * i], 1e-5);
      assert_float_equal((double)from[3 + i] / sum, xy[2 * i + 1], 1e-5);
    }
  }
  /* IEC 61966-2-1 rounds to four digits */
  float m[9];
  vl_rgb_from_xyz(VL_SPACE_SRGB, m);
  static const double published[9] = {3.2406, -1.5372, -0.4986, -0.9689, 1.8758,
                                      0.0415, 0.0557,  -0.2040, 1.0570};
  for (int i = 0; i < 9; i++)
    assert_float_equal(m[i], published[i], 5e-4);
}

static double reflectance(const char *metal, int lambda) {
  char name[32];
  snprintf(name, sizeof name, "metal-%s-eta", metal);
  const float *eta = vl_named_spectrum(name);
  snprintf(name, sizeof name, "metal-%s-k", metal);
  const float *k = vl_named_spectrum(name);
  assert_non_null(eta);
  assert_non_null(k);
  double n = (double)eta[lambda - 360], kk = (double)k[lambda - 360] * (double)k[lambda - 360];
  return ((n - 1) * (n - 1) + kk) / ((n + 1) * (n + 1) + kk);
}

static void test_metals(void **state) {
  (void)state;
  /* normal reflectances as handbooks give them (CRC Handbook of Chemistry and Physics, optical
   * properties of metals) */
  for (int l = 450; l <= 750; l += 50)
    assert_in_range((int)(1000 * reflectance("Ag", l)), 910, 995);
  for (int l = 400; l <= 650; l += 50)
    assert_in_range((int)(1000 * reflectance("Al", l)), 890, 930);
  assert_in_range((int)(1000 * reflectance("Au", 450)), 330, 430);
  assert_in_range((int)(1000 * reflectance("Au", 650)), 930, 980);
  assert_in_range((int)(1000 * reflectance("Cu", 500)), 550, 650);
  assert_in_range((int)(1000 * reflectance("Cu", 700)), 930, 985);
  assert_in_range((int)(1000 * reflectance("CuZn", 450)), 380, 480);
  assert_in_range((int)(1000 * reflectance("CuZn", 650)), 850, 950);
  assert_in_range((int)(1000 * reflectance("MgO", 550)), 70, 75);
  assert_in_range((int)(1000 * reflectance("TiO2", 550)), 220, 260);
  /* linear sRGB of metals as published (Hoffman, Physics and math of shading, SIGGRAPH course
   * 2015): gold is yellow, copper reddish */
  static const struct {
    const char *name;
    double rgb[3];
  } hue[] = {{"Au", {1.0, 0.782, 0.344}},
             {"Cu", {0.955, 0.638, 0.538}},
             {"Ag", {0.972, 0.960, 0.915}},
             {"Al", {0.913, 0.922, 0.924}}};
  for (int i = 0; i < 4; i++) {
    float dense[VL_LAMBDA_COUNT], rgb[3], l[VL_LAMBDA_COUNT];
    for (int j = 0; j < VL_LAMBDA_COUNT; j++) {
      l[j] = (float)(360 + j);
      dense[j] = (float)reflectance(hue[i].name, 360 + j);
    }
    vlSpectrum s = {.kind = VL_SPECTRUM_SAMPLED,
                    .scale = 1,
                    .count = VL_LAMBDA_COUNT,
                    .wavelengths = l,
                    .values = dense};
    assert_int_equal(vl_spectrum_to_rgb(&s, VL_ROLE_ALBEDO, VL_SPACE_SRGB, rgb, NULL), VL_OK);
    for (int c = 0; c < 3; c++) {
      if (fabs((double)rgb[c] - hue[i].rgb[c]) > 0.015)
        fail_msg("%s: %g %g %g", hue[i].name, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
    }
  }
}

static void test_glasses(void **state) {
  (void)state;
  /* n_d (587.56 nm) of Schott's catalogue */
  static const struct {
    const char *name;
    double n;
  } known[] = {{"glass-BK7", 1.51680},   {"glass-BAF10", 1.67003}, {"glass-FK51A", 1.48656},
               {"glass-LASF9", 1.85025}, {"glass-SF5", 1.67271},   {"glass-SF10", 1.72828},
               {"glass-SF11", 1.78472},  {"glass-F5", 1.67271},    {"glass-F10", 1.72828},
               {"glass-F11", 1.78472}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const float *dense = vl_named_spectrum(known[i].name);
    assert_non_null(dense);
    assert_float_equal(vl_dense_at(dense, 587.56f), known[i].n, 1.5e-5);
    for (int j = 1; j < VL_LAMBDA_COUNT; j++)
      assert_true(dense[j] <= dense[j - 1]); /* normal dispersion */
  }
}

/* Gold from a file of pairs (wavelength, value), as scenes of others have it. */
static void test_gold_file(void **state) {
  (void)state;
  static const char *const names[2] = {"eta", "k"};
  for (int f = 0; f < 2; f++) {
    char path[512], name[32];
    snprintf(path, sizeof path, "%s/../shared/scenes/pbrt/pbrt-killeroos/spds/Au.%s.spd",
             VELO_SOURCE_DIR, names[f]);
    FILE *file = fopen(path, "r");
    if (!file) {
      print_message("skipped: no %s\n", path);
      skip();
    }
    snprintf(name, sizeof name, "metal-Au-%s", names[f]);
    const float *dense = vl_named_spectrum(name);
    assert_non_null(dense);
    double l, v, l0 = 0, v0 = 0;
    int checked = 0;
    while (fscanf(file, "%lf %lf", &l, &v) == 2) {
      for (int w = (int)ceil(l0); w <= (int)l; w++) {
        if (l0 <= 0 || w < 360 || w > 830)
          continue;
        assert_float_equal(dense[w - 360], v0 + (w - l0) / (l - l0) * (v - v0), 1e-5);
        checked++;
      }
      l0 = l;
      v0 = v;
    }
    fclose(file);
    assert_true(checked >= VL_LAMBDA_COUNT);
  }
}

static void test_meaning(void **state) {
  (void)state;
  float dense[VL_LAMBDA_COUNT], rgb[3], value;
  vlSpectrum s = vl_spectrum_constant(0.25f);
  s.scale = 2;
  assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_ALBEDO, dense, NULL), VL_OK);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    assert_true(dense[i] == 0.5f);
  assert_true(vl_spectrum_is_constant(&s, &value) && value == 0.5f);
  assert_int_equal(vl_spectrum_to_rgb(&s, VL_ROLE_ALBEDO, VL_SPACE_ACES2065_1, rgb, NULL),
                   VL_OK);
  for (int i = 0; i < 3; i++)
    assert_true(rgb[i] == 0.5f);

  /* sampled: linear between, 0 outside */
  float l[3] = {400.5f, 500, 600}, v[3] = {1, 3, 2};
  s = (vlSpectrum){
      .kind = VL_SPECTRUM_SAMPLED, .scale = 1, .count = 3, .wavelengths = l, .values = v};
  assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_UNBOUNDED, dense, NULL), VL_OK);
  assert_true(dense[40] == 0 && dense[241] == 0 && dense[140] == 3 && dense[240] == 2);
  assert_float_equal(dense[41], 1 + 0.5 / 99.5 * 2, 1e-6);
  assert_float_equal(dense[190], 2.5, 1e-6);
  assert_false(vl_spectrum_is_constant(&s, &value));
  s.count = 1;
  assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_UNBOUNDED, dense, NULL), VL_OK);
  float wide[2] = {300, 900}, same[2] = {1.5f, 1.5f};
  s = (vlSpectrum){
      .kind = VL_SPECTRUM_SAMPLED, .scale = 1, .count = 2, .wavelengths = wide, .values = same};
  assert_true(vl_spectrum_is_constant(&s, &value) && value == 1.5f);

  /* black body: maximum 1 at Wien's wavelength; its colour at 6504 K is near daylight; very low
   * and very high temperatures give finite values */
  s = vl_spectrum_blackbody(5000);
  assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_ILLUMINANT, dense, NULL), VL_OK);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    assert_true(dense[i] > 0.4f && dense[i] <= 1.0f);
  assert_true(dense[580 - 360] > 0.99999f);
  double xyz[3];
  xyz_of(dense, xyz);
  /* Planckian locus at 5000 K */
  assert_float_equal(xyz[0] / (xyz[0] + xyz[1] + xyz[2]), 0.3451, 2e-4);
  assert_float_equal(xyz[1] / (xyz[0] + xyz[1] + xyz[2]), 0.3516, 2e-4);
  static const float kelvin[4] = {1e-30f, 10, 1e9f, 3e38f};
  for (int i = 0; i < 4; i++) {
    s = vl_spectrum_blackbody(kelvin[i]);
    assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_ILLUMINANT, dense, NULL), VL_OK);
    for (int j = 0; j < VL_LAMBDA_COUNT; j++)
      assert_true(dense[j] >= 0 && dense[j] <= 1);
  }
}

static void test_lights(void **state) {
  (void)state;
  /* An RGB light divided by its photometric value gives its RGB in every colour space; named
   * spectra and black bodies give luminance 1. */
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    vlSpectrum s = vl_spectrum_rgb(17, 12, 4);
    s.space = (vlColorSpace)space;
    float dense[VL_LAMBDA_COUNT], m[9], rgb[3];
    assert_int_equal(vl_spectrum_dense(&s, VL_ROLE_ILLUMINANT, dense, NULL), VL_OK);
    double photometric = vl_spectrum_photometric(&s, NULL), xyz[3];
    xyz_of(dense, xyz);
    vl_rgb_from_xyz(s.space, m);
    assert_int_equal(vl_spectrum_to_rgb(&s, VL_ROLE_ILLUMINANT, s.space, rgb, NULL), VL_OK);
    for (int i = 0; i < 3; i++) {
      double v = 0;
      for (int k = 0; k < 3; k++)
        v += (double)m[3 * i + k] * xyz[k] / photometric;
      assert_float_equal(v, s.rgb[i], 1e-4);
      assert_true(rgb[i] == s.rgb[i]);
    }
  }
  vlSpectrum lights[3] = {vl_spectrum_named("stdillum-F11"), vl_spectrum_blackbody(3000),
                          vl_spectrum_constant(7)};
  for (int i = 0; i < 3; i++) {
    float dense[VL_LAMBDA_COUNT], rgb[3], back[9];
    double xyz[3];
    assert_int_equal(vl_spectrum_dense(&lights[i], VL_ROLE_ILLUMINANT, dense, NULL), VL_OK);
    xyz_of(dense, xyz);
    assert_float_equal(xyz[1] / vl_spectrum_photometric(&lights[i], NULL), 1.0, 1e-9);
    assert_int_equal(
        vl_spectrum_to_rgb(&lights[i], VL_ROLE_ILLUMINANT, VL_SPACE_REC2020, rgb, NULL), VL_OK);
    vl_xyz_from_rgb(VL_SPACE_REC2020, back);
    assert_float_equal(back[3] * rgb[0] + back[4] * rgb[1] + back[5] * rgb[2], 1.0, 1e-4);
  }
  /* the white of one space is white in another as a reflectance */
  vlSpectrum white = vl_spectrum_rgb(0.5f, 0.5f, 0.5f);
  float rgb[3];
  assert_int_equal(vl_spectrum_to_rgb(&white, VL_ROLE_ALBEDO, VL_SPACE_ACES2065_1, rgb, NULL),
                   VL_OK);
  for (int i = 0; i < 3; i++)
    assert_float_equal(rgb[i], 0.5, 1e-5);
}

static void expect(const vlSpectrum *s, vlResult code, const char *words) {
  float dense[VL_LAMBDA_COUNT];
  vlError error = {0};
  assert_int_equal(vl_spectrum_dense(s, VL_ROLE_ALBEDO, dense, &error), code);
  if (!strstr(error.message, words))
    fail_msg("\"%s\" does not say \"%s\"", error.message, words);
  assert_int_equal(vl_spectrum_dense(s, VL_ROLE_ALBEDO, dense, NULL), code);
}

static void test_errors(void **state) {
  (void)state;
  vlSpectrum s = vl_spectrum_named("metal-Au-etta");
  expect(&s, VL_ERROR_SCENE, "metal-Au-eta");
  s = vl_spectrum_named(NULL);
  expect(&s, VL_ERROR_SCENE, "unknown spectrum");
  s = vl_spectrum_named("what on earth is this supposed to be");
  expect(&s, VL_ERROR_SCENE, "unknown spectrum \"what on earth is this supposed to be\"");
  float l[2] = {500, 500}, v[2] = {1, 1};
  s = (vlSpectrum){
      .kind = VL_SPECTRUM_SAMPLED, .scale = 1, .count = 2, .wavelengths = l, .values = v};
  expect(&s, VL_ERROR_SCENE, "ascend");
  l[1] = NAN;
  expect(&s, VL_ERROR_SCENE, "sample 2");
  s.count = 0;
  expect(&s, VL_ERROR_SCENE, "no samples");
  s = vl_spectrum_blackbody(-1);
  expect(&s, VL_ERROR_SCENE, "kelvin");
  s = vl_spectrum_rgb(1, INFINITY, 0);
  expect(&s, VL_ERROR_SCENE, "not finite");
  s = vl_spectrum_rgb(1, 1, 0);
  s.space = (vlColorSpace)9;
  expect(&s, VL_ERROR_ARGUMENT, "colour space");
  s = vl_spectrum_constant(3e38f);
  s.scale = 10;
  expect(&s, VL_ERROR_SCENE, "too large");
  s.kind = (vlSpectrumKind)99;
  expect(&s, VL_ERROR_ARGUMENT, "kind");
  expect(NULL, VL_ERROR_ARGUMENT, "null");
}

/* The shares of the three channels lie in [0, 1] and add up to 1, and their colours are the
 * primaries. So any transmittance by channel is a spectrum of exactly that colour. */
static void test_channels(void **state) {
  (void)state;
  const float *light = vl_space_illuminant(VL_SPACE_SRGB);
  const float passed[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1e-3f, 0.2f, 1}};
  float m[9];
  vl_rgb_from_xyz(VL_SPACE_SRGB, m);
  for (int k = 0; k < 4; k++) {
    double xyz[3] = {0, 0, 0}, y = 0;
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      const float *share = vl_channel_shares + 4 * i;
      double t = (double)vl_channels_at(passed[k], (float)(VL_LAMBDA_MIN + i)),
             l = (double)light[i];
      assert_true(t >= 0 && t <= 1 && share[3] == 0);
      assert_true(fabs((double)share[0] + (double)share[1] + (double)share[2] - 1) < 2e-7);
      xyz[0] += t * l * (double)vl_cie_x()[i];
      xyz[1] += t * l * (double)vl_cie_y()[i];
      xyz[2] += t * l * (double)vl_cie_z()[i];
      y += l * (double)vl_cie_y()[i];
    }
    for (int c = 0; c < 3; c++) {
      double seen = ((double)m[3 * c] * xyz[0] + (double)m[3 * c + 1] * xyz[1] +
                     (double)m[3 * c + 2] * xyz[2]) /
                    y;
      assert_true(fabs(seen - (double)passed[k][c]) < 2e-6);
    }
  }
}

static void test_names(void **state) {
  (void)state;
  unsigned count = 0;
  for (const char *name, *last = ""; (name = vl_spectrum_name(count)); last = name, count++) {
    assert_true(strcmp(last, name) < 0);
    const float *dense = vl_named_spectrum(name);
    assert_non_null(dense);
    for (int i = 0; i < VL_LAMBDA_COUNT; i++)
      assert_true(isfinite(dense[i]) && dense[i] >= 0);
  }
  assert_true(count >= 41);
  assert_null(vl_spectrum_name(count + 1000));
  assert_null(vl_named_spectrum("metal-Au"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_observer), cmocka_unit_test(test_illuminants),
      cmocka_unit_test(test_spaces),   cmocka_unit_test(test_metals),
      cmocka_unit_test(test_glasses),  cmocka_unit_test(test_gold_file),
      cmocka_unit_test(test_meaning),  cmocka_unit_test(test_lights),
      cmocka_unit_test(test_errors),   cmocka_unit_test(test_names),
      cmocka_unit_test(test_channels),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
