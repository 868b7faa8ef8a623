/* test/raw/test_raw_develop.c: development against calculations of its own: levels, white
 * balance, bilinear interpolation with its borders, colours of a sensor that meets Luther's
 * condition under A and D65, tone; the colour matrices; values out of range. */
#include "sample_raw.h"

static vlImage *develop(const vlRaw *raw, vlRawStep step) {
  vlRawDevelopDef def = vl_default_raw_develop_def();
  def.stop_at = step;
  vlImage *image = NULL;
  vlError error;
  if (vl_raw_develop(raw, &def, &image, &error) != VL_OK)
    fail_msg("%s", error.message);
  return image;
}

/* ---- the first steps --------------------------------------------------------------------- */

static void test_levels(void **state) {
  (void)state;
  vlContext *context = make_context(2);
  vlRawDef def = full_def("RG/GB", 10, 6);
  const float neutral[3] = {0.5f, 1.0f, 0.25f};
  memcpy(def.neutral, neutral, sizeof neutral);
  vlRaw *raw = make_raw(context, &def);
  vlImage *black = develop(raw, VL_RAW_STEP_BLACK), *white = develop(raw, VL_RAW_STEP_WHITE);
  for (uint32_t y = 0; y < 6; y++)
    for (uint32_t x = 0; x < 10; x++) {
      static const int color[4] = {0, 1, 1, 2};
      uint32_t cell = y % 2 * 2 + x % 2;
      double number = vl_raw_numbers(raw)[y * 10 + x];
      double level = (number - 64 - cell) / (4000 - 64 - cell);
      double balanced = level / (double)neutral[color[cell]];
      assert_true(fabs((double)vl_image_get(black, x, y, 0) - level) < 1e-7);
      assert_true(fabs((double)vl_image_get(white, x, y, 0) - fmin(balanced, 1.0)) < 2e-7);
    }
  assert_true(vl_image_get(black, 0, 0, 0) == 1.0f);
  vl_image_destroy(black);
  vl_image_destroy(white);
  vl_raw_destroy(raw);
  end_context(context);
}

/* The mean of the mosaic's pixels at these offsets that are in the image. */
static double mean_of(const vlImage *mosaic, int x, int y, const int (*at)[2], int count) {
  double sum = 0.0;
  int found = 0;
  for (int i = 0; i < count; i++) {
    int u = x + at[i][0], v = y + at[i][1];
    if (u < 0 || v < 0 || u >= (int)vl_image_width(mosaic) || v >= (int)vl_image_height(mosaic))
      continue;
    sum += (double)vl_image_get(mosaic, (uint32_t)u, (uint32_t)v, 0);
    found++;
  }
  return sum / found;
}

/* Bilinear interpolation of RG/GB as textbooks write it, with what the border lacks left out.
 */
static double bayer(const vlImage *mosaic, int x, int y, int color) {
  static const int here[1][2] = {{0, 0}}, cross[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}},
                   corners[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}},
                   across[2][2] = {{-1, 0}, {1, 0}}, along[2][2] = {{0, -1}, {0, 1}};
  bool odd_x = x % 2, odd_y = y % 2;
  if (color == 1)
    return odd_x != odd_y ? mean_of(mosaic, x, y, here, 1) : mean_of(mosaic, x, y, cross, 4);
  bool own_x = odd_x == (color == 2), own_y = odd_y == (color == 2);
  if (own_x && own_y)
    return mean_of(mosaic, x, y, here, 1);
  if (own_y)
    return mean_of(mosaic, x, y, across, 2);
  return own_x ? mean_of(mosaic, x, y, along, 2) : mean_of(mosaic, x, y, corners, 4);
}

static void test_bilinear(void **state) {
  (void)state;
  vlContext *context = make_context(3);
  vlRawDef def = full_def("RG/GB", 11, 8);
  vlRaw *raw = make_raw(context, &def);
  vlImage *mosaic = develop(raw, VL_RAW_STEP_WHITE);
  vlImage *image = develop(raw, VL_RAW_STEP_DEMOSAIC);
  assert_int_equal(vl_image_channels(image), 3);
  assert_string_equal(vl_image_channel_name(image, 2), "B");
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 11; x++)
      for (int k = 0; k < 3; k++) {
        double got = (double)vl_image_get(image, (uint32_t)x, (uint32_t)y, (uint32_t)k);
        assert_true(fabs(got - bayer(mosaic, x, y, k)) < 2e-7);
      }
  vl_image_destroy(mosaic);
  vl_image_destroy(image);
  vl_raw_destroy(raw);
  end_context(context);
}

/* A uniform colour stays uniform with any pattern, at borders and corners, too. */
static void test_uniform(void **state) {
  static const char *const patterns[] = {"BG/GR",
                                         "RRGG/RRGG/GGBB/GGBB",
                                         "RGGB",
                                         "RG/BW",
                                         "GGRGGB/GGBGGR/BRGRBG/GGBGGR/GGRGGB/RBGBRG",
                                         "CMYG"};
  (void)state;
  vlContext *context = make_context(1);
  for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
    vlRawDef def = vl_default_raw_def(17, 13);
    assert_int_equal(vl_raw_set_pattern(&def, patterns[i], NULL), VL_OK);
    vlRaw *raw = make_raw(context, &def);
    uint8_t colors[VL_RAW_MAX_COLORS];
    uint32_t count = vl_raw_colors(&def, colors);
    for (uint32_t y = 0; y < 13; y++)
      for (uint32_t x = 0; x < 17; x++)
        vl_raw_numbers(raw)[y * 17 + x] =
            (uint16_t)(100 * (1 + def.pattern[y % def.pattern_rows * def.pattern_columns +
                                              x % def.pattern_columns]));
    vlImage *image = develop(raw, VL_RAW_STEP_DEMOSAIC);
    assert_int_equal(vl_image_channels(image), count);
    for (uint32_t y = 0; y < 13; y++)
      for (uint32_t x = 0; x < 17; x++)
        for (uint32_t k = 0; k < count; k++) {
          float expected = (float)(100 * (1 + colors[k])) / 4095.0f;
          assert_true(fabsf(vl_image_get(image, x, y, k) - expected) < 1e-6f);
        }
    vl_image_destroy(image);
    vl_raw_destroy(raw);
  }
  end_context(context);
}

/* ---- colour ------------------------------------------------------------------------------ */

static double lab_curve(double t) {
  return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

/* CIE L*a*b* of linear sRGB, white D65. */
static void lab_of(const double rgb[3], double lab[3]) {
  static const double m[9] = {0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522,
                              0.0721750, 0.0193339, 0.1191920, 0.9503041};
  double f[3];
  for (int i = 0; i < 3; i++) {
    double sum = m[3 * i] + m[3 * i + 1] + m[3 * i + 2];
    f[i] = lab_curve((m[3 * i] * rgb[0] + m[3 * i + 1] * rgb[1] + m[3 * i + 2] * rgb[2]) / sum);
  }
  lab[0] = 116.0 * f[1] - 16.0;
  lab[1] = 500.0 * (f[0] - f[1]);
  lab[2] = 200.0 * (f[1] - f[2]);
}

static double degrees(double radians) {
  double d = radians * 180.0 / acos(-1.0);
  return d < 0.0 ? d + 360.0 : d;
}

static double cos_degrees(double d) {
  return cos(d * acos(-1.0) / 180.0);
}

/* CIEDE2000 (Sharma, Wu, Dalal 2005). */
static double delta_e(const double p[3], const double q[3]) {
  double c1 = hypot(p[1], p[2]), c2 = hypot(q[1], q[2]), mean = (c1 + c2) / 2.0;
  double g = 0.5 * (1.0 - sqrt(pow(mean, 7) / (pow(mean, 7) + pow(25.0, 7))));
  double a1 = (1.0 + g) * p[1], a2 = (1.0 + g) * q[1];
  double d1 = hypot(a1, p[2]), d2 = hypot(a2, q[2]);
  double h1 = d1 > 0.0 ? degrees(atan2(p[2], a1)) : 0.0;
  double h2 = d2 > 0.0 ? degrees(atan2(q[2], a2)) : 0.0;
  double dh = h2 - h1, h = (h1 + h2) / 2.0;
  if (d1 * d2 == 0.0)
    dh = 0.0;
  if (dh > 180.0 || dh < -180.0) {
    dh += dh > 0.0 ? -360.0 : 360.0;
    h += h < 180.0 ? 180.0 : -180.0;
  }
  double l = (p[0] + q[0]) / 2.0, d = (d1 + d2) / 2.0;
  double dH = 2.0 * sqrt(d1 * d2) * sin(dh / 2.0 * acos(-1.0) / 180.0);
  double t = 1.0 - 0.17 * cos_degrees(h - 30.0) + 0.24 * cos_degrees(2.0 * h) +
             0.32 * cos_degrees(3.0 * h + 6.0) - 0.20 * cos_degrees(4.0 * h - 63.0);
  double sl = 1.0 + 0.015 * (l - 50.0) * (l - 50.0) / sqrt(20.0 + (l - 50.0) * (l - 50.0));
  double sc = 1.0 + 0.045 * d, sh = 1.0 + 0.015 * d * t;
  double turn = 30.0 * exp(-(h - 275.0) / 25.0 * ((h - 275.0) / 25.0));
  double rt = -2.0 * sqrt(pow(d, 7) / (pow(d, 7) + pow(25.0, 7))) *
              sin(2.0 * turn * acos(-1.0) / 180.0);
  double x = (q[0] - p[0]) / sl, y = (d2 - d1) / sc, z = dH / sh;
  return sqrt(x * x + y * y + z * z + rt * y * z);
}

/* A smooth reflectance between 0.02 and 0.98; the first is white. */
static double reflectance(int patch, int i) {
  double phase = 0.7 * patch, rate = 0.004 * (1 + patch % 5);
  return patch == 0 ? 0.9 : 0.5 + 0.48 * sin(phase + rate * i) * (1 - 0.03 * (patch % 7));
}

/* Linear sRGB of XYZ, adapted by Bradford from a white to D65: formulas of Lindbloom's pages.
 */
static void srgb_of(const double xyz[3], const double white[3], double rgb[3]) {
  static const double b[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                              0.0367, 0.0389, -0.0685, 1.0296};
  static const double back[9] = {0.9869929, -0.1470543, 0.1599627, 0.4323053, 0.5183603,
                                 0.0492912, -0.0085287, 0.0400428, 0.9684867};
  static const double srgb[9] = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                                 0.0415560, 0.0556434,  -0.2040259, 1.0572252};
  static const double d65[3] = {0.95047, 1.0, 1.08883};
  double cone[3], adapted[3];
  for (int i = 0; i < 3; i++) {
    double seen = 0.0, from = 0.0, to = 0.0;
    for (int k = 0; k < 3; k++) {
      seen += b[3 * i + k] * xyz[k];
      from += b[3 * i + k] * white[k];
      to += b[3 * i + k] * d65[k];
    }
    cone[i] = seen * to / from;
  }
  for (int i = 0; i < 3; i++)
    adapted[i] = back[3 * i] * cone[0] + back[3 * i + 1] * cone[1] + back[3 * i + 2] * cone[2];
  for (int i = 0; i < 3; i++)
    rgb[i] =
        srgb[3 * i] * adapted[0] + srgb[3 * i + 1] * adapted[1] + srgb[3 * i + 2] * adapted[2];
}

enum { PATCHES = 40, PATCH = 8 };

static void see(const float *curves, int stride, int step, const float *light, int patch,
                double seen[3]) {
  memset(seen, 0, 3 * sizeof *seen);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++) {
    double power = (double)light[i] * (patch < 0 ? 1.0 : reflectance(patch, i));
    for (int k = 0; k < 3; k++)
      seen[k] += power * (double)curves[k * stride + i * step];
  }
}

/* The mosaic of a row of patches in a light. full: the sensor's sum that gives white. */
static vlRaw *shoot(vlContext *context, const vlRawDef *def, const float *sensitivities,
                    const float *light, double full) {
  vlRaw *raw = make_raw(context, def);
  for (int p = 0; p < PATCHES; p++) {
    double seen[3];
    see(sensitivities, VL_SPECTRUM_VALUES, 1, light, p, seen);
    for (int y = 0; y < PATCH; y++)
      for (int x = p * PATCH; x < (p + 1) * PATCH; x++) {
        int k = def->pattern[y % 2 * 2 + x % 2];
        vl_raw_numbers(raw)[y * PATCHES * PATCH + x] =
            (uint16_t)(def->black[0] + seen[k] / full * (def->white - def->black[0]) + 0.5);
      }
  }
  return raw;
}

static void check_colors(vlContext *context, const float *rows, const char *name) {
  static float sensitivities[3 * VL_SPECTRUM_VALUES], xyz[3 * VL_SPECTRUM_VALUES];
  float light[VL_SPECTRUM_VALUES];
  vlSpectrum spectrum = vl_spectrum_named(name);
  double white[3], full[3], worst = 0.0;
  mix_observer(rows, sensitivities);
  vl_observer_tabulate(xyz);
  assert_int_equal(vl_spectrum_tabulate(&spectrum, VL_PARAMETER_UNBOUNDED, light, NULL), VL_OK);
  see(xyz, 1, 3, light, -1, white);
  see(sensitivities, VL_SPECTRUM_VALUES, 1, light, -1, full);
  double max = fmax(full[0], fmax(full[1], full[2]));
  vlRawDef def = vl_default_raw_def(PATCHES * PATCH, PATCH);
  def.bits = 16;
  def.white = 65000;
  for (int i = 0; i < 4; i++)
    def.black[i] = 512;
  assert_int_equal(vl_raw_match_color(&def, sensitivities, light, NULL), VL_OK);
  vlRaw *raw = shoot(context, &def, sensitivities, light, max);
  vlImage *image = develop(raw, VL_RAW_STEP_COLOR);
  for (int p = 0; p < PATCHES; p++) {
    double seen[3], truth[3], got[3], a[3], b[3], one[3];
    see(xyz, 1, 3, light, p, seen);
    for (int k = 0; k < 3; k++) {
      seen[k] /= white[1];
      one[k] = white[k] / white[1];
      got[k] = (double)vl_image_get(image, (uint32_t)(p * PATCH + 4), 4, (uint32_t)k);
    }
    srgb_of(seen, one, truth);
    lab_of(truth, a);
    lab_of(got, b);
    worst = fmax(worst, delta_e(a, b));
  }
  if (!(worst < 0.05))
    fail_msg("%s: colours differ by %g", name, worst);
  vl_image_destroy(image);
  vl_raw_destroy(raw);
}

/* A sensor that meets Luther's condition has the observer's colours, in any light. */
static void test_luther(void **state) {
  static const float same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const float mixed[9] = {0.9f, 0.3f, 0.0f, 0.1f, 1.0f, 0.05f, 0.02f, 0.1f, 0.8f};
  static const char *const lights[] = {"stdillum-D65", "stdillum-A", "stdillum-D50",
                                       "stdillum-F11"};
  (void)state;
  vlContext *context = make_context(1);
  for (int i = 0; i < 4; i++) {
    check_colors(context, same, lights[i]);
    check_colors(context, mixed, lights[i]);
  }
  end_context(context);
}

/* White is neutral with every sensor, and its matrices map white to the neutral. */
static void test_white(void **state) {
  (void)state;
  static float sensitivities[4 * VL_SPECTRUM_VALUES];
  vlContext *context = make_context(1);
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < VL_SPECTRUM_VALUES; i++) {
      double t = (360 + i - (610 - 75 * k)) / 35.0;
      sensitivities[k * VL_SPECTRUM_VALUES + i] = (float)((1.0 + 0.2 * k) * exp(-t * t));
    }
  static const char *const patterns[] = {"RG/GB", "RG/BW"};
  for (int i = 0; i < 2; i++) {
    vlRawDef def = vl_default_raw_def(8, 8);
    assert_int_equal(vl_raw_set_pattern(&def, patterns[i], NULL), VL_OK);
    assert_int_equal(vl_raw_match_color(&def, sensitivities, NULL, NULL), VL_OK);
    vlRaw *raw = make_raw(context, &def);
    uint8_t colors[VL_RAW_MAX_COLORS];
    uint32_t count = vl_raw_colors(&def, colors);
    for (uint32_t at = 0; at < 64; at++)
      for (uint32_t k = 0; k < count; k++)
        if (colors[k] == def.pattern[at / 8 % 2 * 2 + at % 2])
          vl_raw_numbers(raw)[at] = (uint16_t)(2000.0f * def.neutral[k] + 0.5f);
    vlImage *image = develop(raw, VL_RAW_STEP_COLOR);
    for (uint32_t k = 0; k < 3; k++)
      assert_true(fabsf(vl_image_get(image, 4, 4, k) - 2000.0f / 4095.0f) < 1e-3f);
    vl_image_destroy(image);
    vl_raw_destroy(raw);
  }
  end_context(context);
}

static void test_tone(void **state) {
  (void)state;
  vlContext *context = make_context(1);
  vlRawDef def = vl_default_raw_def(8, 1);
  assert_int_equal(vl_raw_set_pattern(&def, "W", NULL), VL_OK);
  def.baseline_exposure = 1.0f;
  vlRaw *raw = make_raw(context, &def);
  for (uint32_t x = 0; x < 8; x++)
    vl_raw_numbers(raw)[x] = (uint16_t)(300 * x);
  vlRawDevelopDef how = vl_default_raw_develop_def();
  how.exposure = 0.5f;
  vlImage *image = NULL;
  assert_int_equal(vl_raw_develop(raw, &how, &image, NULL), VL_OK);
  assert_int_equal(vl_image_type(image), VL_PIXEL_U16);
  assert_int_equal(vl_image_channels(image), 1);
  for (uint32_t x = 0; x < 8; x++) {
    double v = fmin(300.0 * x / 4095.0 * pow(2.0, 1.5), 1.0);
    double curve = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    double got = ((const uint16_t *)vl_image_const_pixels(image))[x];
    assert_true(fabs(got - 65535.0 * curve) <= 0.501);
  }
  vl_image_destroy(image);
  vl_raw_destroy(raw);
  end_context(context);
}

/* ---- what is refused --------------------------------------------------------------------- */

static void refuse_def(const vlRawDef *def, const char *text) {
  vlContext *context = make_context(1);
  vlRaw *raw = NULL;
  vlError error = {0};
  assert_int_equal(vl_raw_create(context, def, &raw, &error), VL_ERROR_ARGUMENT);
  assert_null(raw);
  if (!strstr(error.message, text))
    fail_msg("\"%s\" lacks \"%s\"", error.message, text);
  end_context(context);
}

/* Refuses a def with one wrong value. */
#define REFUSE(field, value, text)               \
  do {                                           \
    vlRawDef wrong = vl_default_raw_def(16, 16); \
    wrong.field = value;                         \
    refuse_def(&wrong, text);                    \
  } while (0)

static void test_refused_defs(void **state) {
  (void)state;
  REFUSE(cookie, 0, "cookie");
  REFUSE(width, 0, "width");
  REFUSE(height, 70000, "height");
  REFUSE(bits, 17, "bits");
  REFUSE(bits, 11, "white");
  REFUSE(white, 0, "black");
  REFUSE(black[3], 4095, "black");
  REFUSE(pattern_rows, 9, "pattern");
  REFUSE(pattern[1], 7, "pattern");
  REFUSE(camera[0], '\n', "camera");
  REFUSE(exposure_time, NAN, "exposure_time");
  REFUSE(f_number, -1.0f, "f_number");
  REFUSE(focal_length, INFINITY, "focal_length");
  REFUSE(iso, 65536, "iso");
  REFUSE(gain, NAN, "gain");
  REFUSE(read_noise, 1e9f, "read_noise");
  REFUSE(baseline_exposure, NAN, "baseline_exposure");
  REFUSE(neutral[0], 0.5f, "neutral");
  REFUSE(neutral[1], NAN, "neutral");
  REFUSE(matrices[1][4], NAN, "matrices");
}

static void refuse_pattern(const char *text) {
  vlRawDef def = vl_default_raw_def(4, 4), before = def;
  vlError error = {0};
  assert_int_equal(vl_raw_set_pattern(&def, text, &error), VL_ERROR_ARGUMENT);
  assert_true(error.message[0]);
  assert_memory_equal(&def, &before, sizeof def);
}

static void test_refused_patterns(void **state) {
  (void)state;
  static const char *const wrong[] = {
      "",      "/",         "RG/",   "RG/G",   "R/GB",
      "rg/gb", "RGGBRGGBR", "RGBCM", "RG//GB", "R/R/R/R/R/R/R/R/R"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    refuse_pattern(wrong[i]);
  char text[80];
  vlRawDef def = vl_default_raw_def(4, 4);
  vl_raw_pattern_text(&def, text);
  assert_string_equal(text, "RG/GB");
}

static void test_refused_colors(void **state) {
  (void)state;
  static float s[3 * VL_SPECTRUM_VALUES];
  static const float same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  vlRawDef def = vl_default_raw_def(4, 4), before = def;
  vlError error = {0};
  mix_observer(same, s);
  s[100] = NAN;
  assert_int_equal(vl_raw_match_color(&def, s, NULL, &error), VL_ERROR_ARGUMENT);
  s[100] = -1.0f;
  assert_int_equal(vl_raw_match_color(&def, s, NULL, &error), VL_ERROR_ARGUMENT);
  memcpy(s, s + VL_SPECTRUM_VALUES, sizeof(float) * VL_SPECTRUM_VALUES);
  assert_int_equal(vl_raw_match_color(&def, s, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "dependent"));
  assert_int_equal(vl_raw_match_color(&def, NULL, NULL, &error), VL_ERROR_ARGUMENT);
  assert_memory_equal(&def, &before, sizeof def);
  vlContext *context = make_context(1);
  vlRaw *raw = make_raw(context, &def);
  vlImage *image = NULL;
  assert_int_equal(vl_raw_develop(raw, NULL, &image, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "matrices"));
  assert_null(image);
  vlRawDevelopDef how = vl_default_raw_develop_def();
  how.exposure = NAN;
  assert_int_equal(vl_raw_develop(raw, &how, &image, &error), VL_ERROR_ARGUMENT);
  vl_raw_destroy(raw);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_levels),        cmocka_unit_test(test_bilinear),
      cmocka_unit_test(test_uniform),       cmocka_unit_test(test_luther),
      cmocka_unit_test(test_white),         cmocka_unit_test(test_tone),
      cmocka_unit_test(test_refused_defs),  cmocka_unit_test(test_refused_patterns),
      cmocka_unit_test(test_refused_colors)};
  return cmocka_run_group_tests(tests, NULL, remove_folder);
}
