/* test_lamp.c: lamp files: their intensities against the formulas that the files were written
 * from, in every symmetry and coordinate system; flux against an integration of the test's own;
 * factors; messages about wrong files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/lamp.h"

#define PI 3.14159265358979323846

static vlContext *context;

static int open_context(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  return vl_context_create(&def, &context) == VL_OK ? 0 : -1;
}

static int close_context(void **state) {
  (void)state;
  size_t held = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return held == 0 ? 0 : -1;
}

static vlLamp *read_lamp(const char *text) {
  vlLamp *lamp = NULL;
  vlError error = {0};
  if (vl_lamp_read(context, "lamp", text, strlen(text), &lamp, &error) != VL_OK)
    fail_msg("line %u: %s", error.line, error.message);
  return lamp;
}

static void assert_close(const char *what, double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance * fmax(1, fabs(expected))))
    fail_msg("%s: %.9g, expected %.9g", what, value, expected);
}

/* ---- directions -------------------------------------------------------------------------- */

/* The direction of C and gamma, degrees, in light space. */
static void c_direction(double c, double gamma, double d[3]) {
  c *= PI / 180;
  gamma *= PI / 180;
  d[0] = sin(gamma) * cos(c);
  d[1] = -cos(gamma);
  d[2] = -sin(gamma) * sin(c);
}

/* The same of the horizontal and vertical angle of type A, whose pole is vertical, and of type
 * B, whose pole is horizontal. */
static void a_direction(double h, double v, double d[3]) {
  h *= PI / 180;
  v *= PI / 180;
  d[0] = sin(v);
  d[1] = -cos(v) * cos(h);
  d[2] = cos(v) * sin(h);
}

static void b_direction(double h, double v, double d[3]) {
  h *= PI / 180;
  v *= PI / 180;
  d[0] = cos(h) * sin(v);
  d[1] = -cos(h) * cos(v);
  d[2] = sin(h);
}

/* ---- files of a formula ------------------------------------------------------------------ */

typedef double Formula(double first, double second); /* degrees: C, gamma, or H, V */

static double round_lamp(double c, double gamma) {
  (void)c;
  return 100 + 50 * cos(gamma * PI / 180);
}

static double quarter_lamp(double c, double gamma) {
  return 100 + 60 * cos(2 * c * PI / 180) * sin(gamma * PI / 180);
}

static double half_lamp(double c, double gamma) {
  return 100 + 60 * cos(c * PI / 180) * sin(gamma * PI / 180) + 30 * cos(gamma * PI / 180);
}

static double other_half_lamp(double c, double gamma) {
  return 100 + 60 * sin(c * PI / 180) * sin(gamma * PI / 180) + 30 * cos(gamma * PI / 180);
}

static double free_lamp(double c, double gamma) {
  return 100 + sin(gamma * PI / 180) * (40 * sin(c * PI / 180) + 30 * cos(c * PI / 180) +
                                        20 * sin(2 * c * PI / 180));
}

static double even_lamp(double h, double v) {
  return 100 + 40 * cos(h * PI / 90) + 30 * cos(v * PI / 90);
}

enum { MAX_TEXT = 1 << 18 };
static char text[MAX_TEXT];
static size_t written;

static void put(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  written += (size_t)vsnprintf(text + written, MAX_TEXT - written, format, arguments);
  va_end(arguments);
  assert_true(written < MAX_TEXT - 100);
}

typedef struct Range {
  int first, last, step; /* degrees */
} Range;

static int steps_of(Range r) {
  return (r.last - r.first) / r.step + 1;
}

/* An IES file of a formula of the two angles. type: 1 C, 2 B, 3 A. */
static void write_ies(Formula *formula, int type, Range h, Range v) {
  written = 0;
  put("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 %d %d %d 2 0 0 0\n1 1 0\n", steps_of(v), steps_of(h),
      type);
  for (int k = v.first; k <= v.last; k += v.step)
    put("%d\n", k);
  for (int k = h.first; k <= h.last; k += h.step)
    put(" %d", k);
  for (int i = h.first; i <= h.last; i += h.step) {
    put("\n");
    for (int j = v.first; j <= v.last; j += v.step)
      put("%.7f\n", formula(i, j));
  }
}

/* A EULUMDAT file: 24 planes, of which those from `first` on are stored; 2000 lm, so that the
 * numbers are half the candela. */
static void write_ldt(Formula *formula, int symmetry, int first, int stored) {
  written = 0;
  put("company\n1\n%d\n24\n15\n37\n5\nreport\nname\nnumber\nfile\ndate\n", symmetry);
  for (int k = 0; k < 9; k++)
    put("0\n");
  put("100\n80\n1\n0\n1\n2\ntype\n2000\ncolour\n80\n30\n");
  for (int k = 0; k < 10; k++)
    put("0,5\n");
  for (int k = 0; k < 24; k++)
    put("%d\n", 15 * k);
  for (int k = 0; k <= 36; k++)
    put("%d\n", 5 * k);
  for (int i = first; i < first + stored; i++)
    for (int k = 0; k <= 36; k++)
      put("%.7f\n", 0.5 * formula(15 * i, 5 * k));
}

/* The formula at the angles of a grid of step degrees around (x, y), interpolated. */
static double interpolated(Formula *formula, double x, double y, double x_step, double y_step) {
  double i = floor(x / x_step), j = floor(y / y_step);
  double s = x / x_step - i, t = y / y_step - j;
  double low =
      (1 - s) * formula(i * x_step, j * y_step) + s * formula((i + 1) * x_step, j * y_step);
  double high = (1 - s) * formula(i * x_step, (j + 1) * y_step) +
                s * formula((i + 1) * x_step, (j + 1) * y_step);
  return (1 - t) * low + t * high;
}

/* ---- symmetries of type C ---------------------------------------------------------------- */

static void compare_c(const char *what, Formula *formula) {
  vlLamp *lamp = read_lamp(text);
  for (int c = -7; c < 360; c += 13)
    for (double gamma = 0.5; gamma < 180; gamma += 4.3) {
      double d[3];
      c_direction(c, gamma, d);
      assert_close(what, vl_lamp_intensity(lamp, d), interpolated(formula, c, gamma, 15, 5),
                   2e-6);
    }
  double flux = 0;
  enum { ACROSS = 720, DOWN = 1440 };
  for (int i = 0; i < ACROSS; i++)
    for (int j = 0; j < DOWN; j++) {
      double gamma = (j + 0.5) * 180 / DOWN;
      flux += interpolated(formula, (i + 0.5) * 360 / ACROSS, gamma, 15, 5) *
              sin(gamma * PI / 180) * (2 * PI / ACROSS) * (PI / DOWN);
    }
  vlLampInfo info;
  vl_lamp_info(lamp, &info);
  assert_close(what, info.flux, flux, 2e-5);
  vl_lamp_destroy(lamp);
}

static void symmetries(void **state) {
  (void)state;
  const Range gammas = {0, 180, 5};
  const struct {
    Formula *formula;
    Range range;
  } cases[] = {
      {round_lamp, {0, 0, 15}},         {round_lamp, {0, 90, 15}},
      {quarter_lamp, {0, 90, 15}},      {quarter_lamp, {0, 180, 15}},
      {quarter_lamp, {90, 270, 15}},    {quarter_lamp, {0, 360, 15}},
      {half_lamp, {0, 180, 15}},        {half_lamp, {0, 360, 15}},
      {other_half_lamp, {90, 270, 15}}, {other_half_lamp, {0, 360, 15}},
      {free_lamp, {0, 360, 15}},        {free_lamp, {0, 345, 15}},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    write_ies(cases[i].formula, 1, cases[i].range, gammas);
    compare_c("IES", cases[i].formula);
  }
  const struct {
    Formula *formula;
    int symmetry, first, stored;
  } planes[] = {{free_lamp, 0, 0, 24},
                {round_lamp, 1, 0, 1},
                {half_lamp, 2, 0, 13},
                {other_half_lamp, 3, 18, 13},
                {quarter_lamp, 4, 0, 7}};
  for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
    write_ldt(planes[i].formula, planes[i].symmetry, planes[i].first, planes[i].stored);
    compare_c("EULUMDAT", planes[i].formula);
  }
}

/* ---- types A and B ----------------------------------------------------------------------- */

static double slanted(double h, double v) {
  return 200 + h + 0.5 * v + 0.01 * h * v; /* bilinear: its own interpolation */
}

static void poles(void **state) {
  (void)state;
  for (int type = 2; type <= 3; type++) {
    write_ies(slanted, type, (Range){-90, 90, 10}, (Range){-90, 90, 15});
    vlLamp *lamp = read_lamp(text);
    double d[3], flux = 0;
    for (int h = -88; h <= 88; h += 11)
      for (int v = -88; v <= 88; v += 11) {
        (type == 2 ? b_direction : a_direction)(h, v, d);
        assert_close("pole", vl_lamp_intensity(lamp, d), slanted(h, v), 3e-6);
      }
    const double behind[3] = {0.1, 1, 0.2};
    assert_close("behind", vl_lamp_intensity(lamp, behind), 0, 0);
    for (int i = 0; i < 900; i++)
      for (int j = 0; j < 900; j++) {
        double h = -90 + (i + 0.5) / 5, v = -90 + (j + 0.5) / 5;
        flux += slanted(h, v) * cos((type == 2 ? h : v) * PI / 180) * pow(PI / 900, 2);
      }
    vlLampInfo info;
    vl_lamp_info(lamp, &info);
    assert_close("flux", info.flux, flux, 2e-5);
    assert_int_equal(info.type, type == 2 ? 'B' : 'A');
    vl_lamp_destroy(lamp);
    /* a quarter is mirrored at both axes */
    write_ies(even_lamp, type, (Range){0, 90, 10}, (Range){0, 90, 15});
    lamp = read_lamp(text);
    for (int h = -80; h <= 80; h += 40)
      for (int v = -60; v <= 60; v += 30) {
        (type == 2 ? b_direction : a_direction)(h, v, d);
        assert_close("mirrored", vl_lamp_intensity(lamp, d), even_lamp(h, v), 3e-6);
      }
    vl_lamp_destroy(lamp);
  }
}

/* ---- lamps with known numbers ------------------------------------------------------------ */

static double cosine_lamp(double c, double gamma) {
  (void)c;
  return gamma < 90 ? 1000 * cos(gamma * PI / 180) : 0;
}

static double no_lamp(double c, double gamma) {
  (void)c;
  (void)gamma;
  return 0;
}

static vlLampInfo info_of(const char *file) {
  vlLamp *lamp = read_lamp(file);
  vlLampInfo info;
  vl_lamp_info(lamp, &info);
  vl_lamp_destroy(lamp);
  return info;
}

static void known(void **state) {
  (void)state;
  vlLampInfo info = info_of("TILT=NONE\n1 1000 1 2 1 1 1 0 0 0\n1 1 0\n0 180\n0\n50 50\n");
  assert_string_equal(info.format, "IES LM-63-1986");
  assert_close("even flux", info.flux, 4 * PI * 50, 1e-6);
  assert_close("even beam", info.beam[0], 2 * PI, 1e-6);
  assert_close("lamps", info.lamps_flux, 1000, 0);
  assert_false(info.watts == info.watts);
  write_ies(cosine_lamp, 1, (Range){0, 0, 1}, (Range){0, 90, 1});
  info = info_of(text);
  assert_close("cosine flux", info.flux, 1000 * PI, 5e-5);
  assert_close("cosine maximum", info.max_intensity, 1000, 1e-6);
  assert_close("cosine, down", info.max_direction[1], -1, 1e-6);
  assert_false(info.lamps_flux == info.lamps_flux);
  for (int k = 0; k < 2; k++) {
    assert_close("cosine beam", info.beam[k] * 180 / PI, 120, 1e-3);
    assert_close("cosine field", info.field[k] * 180 / PI, 2 * acos(0.1) * 180 / PI, 1e-3);
  }
  info = info_of("TILT=NONE\n1 1000 1 2 1 1 1 0 0 0\n1 1 0\n0 90\n0\n100 7\n");
  assert_close("straight beam", info.beam[0] * 180 / PI, 2 * 50 * 90 / 93.0, 1e-6);
  info = info_of(
      "TILT=NONE\n1 1000 1 4 2 1 1 0 0 0\n1 1 0\n0 30 60 90\n0 180\n"
      "5 5 5 5\n5 5 5 50\n");
  assert_close("maximum at the end", info.max_intensity, 50, 1e-6);
  assert_close("it is level", info.max_direction[1], 0, 1e-6);
  write_ies(no_lamp, 1, (Range){0, 0, 1}, (Range){0, 90, 10});
  info = info_of(text);
  assert_close("dark", info.flux + info.beam[0] + info.max_intensity, 0, 0);
}

static void factors(void **state) {
  (void)state;
#define FACTORS "3 1000 2 2 1 1 1 0 0 0\n.9 .8 40\n0 180\n0\n50 50\n"
  const struct {
    const char *first, *format;
    double factor;
  } cases[] = {{"", "IES LM-63-1986", 1.44},
               {"IESNA91\n", "IES LM-63-1991", 1.44},
               {"IESNA:LM-63-1995\n", "IES LM-63-1995", 1.44},
               {"IESNA:LM-63-2002\r\n", "IES LM-63-2002", 1.44},
               {"IES:LM-63-2019\n", "IES LM-63-2019", 1.8}}; /* .8: how the file was made */
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char file[400];
    snprintf(file, sizeof file, "%s[LUMINAIRE]  A lamp \nTILT=NONE\n" FACTORS, cases[i].first);
    vlLampInfo info = info_of(file);
    assert_string_equal(info.format, cases[i].format);
    assert_string_equal(info.name, "A lamp");
    assert_close("factor", info.flux, 4 * PI * 50 * cases[i].factor, 1e-6);
    assert_close("lamps", info.lamps_flux, 3000, 0);
    assert_close("watts", info.watts, 40, 0);
  }
  char file[400];
  snprintf(file, sizeof file, "[LUMINAIRE] %0200d\nTILT=NONE\n" FACTORS, 7);
  vlLampInfo info = info_of(file);
  assert_int_equal(strlen(info.name), sizeof info.name - 1); /* what fits of a long name */
  info = info_of("TILT=INCLUDE\n1 3\n0 45 90\n1 .9 .8\n" FACTORS);
  assert_close("tilt", info.flux, 4 * PI * 50 * 1.44, 1e-6);
}

/* ---- wrong files ------------------------------------------------------------------------- */

#define HEAD "TILT=NONE\n1 1000 1 2 1 1 1 0 0 0\n1 1 0\n"

static void wrong_files(void **state) {
  (void)state;
  const struct {
    const char *file;
    uint32_t line;
    const char *message;
  } cases[] = {
      {"", 1, "it ends before the company"},
      {"IESNA91\nno tilt\n", 0, "has a line \"TILT=\""},
      {"TILT=NONE\n1 1000\n", 3, "it ends before the candela multiplier"},
      {"TILT=NONE\n1 1000 nan", 2, "candela multiplier: \"nan\" is not a number"},
      {"TILT=NONE\n1 1000 1 2 1 4", 2, "photometric type is 4"},
      {"TILT=NONE\n1 1000 1 2.5 1 1", 2, "number of vertical angles is 2.5"},
      {"TILT=NONE\n1 1000 0 2 1 1 1 0 0 0 1 1 0\n", 2, "candela multiplier is 0"},
      {"TILT=NONE\n1 1000 1 2 1 1 1 0 0 0 -1 1 0\n", 2, "ballast factor is -1"},
      {"TILT=NONE\n1 1000 1 9999 9999 1 1 0 0 0 1 1 0\n", 2, "too short for 9999 x 9999"},
      {HEAD "0 180\n0\n50 -1\n", 6, "-1, times the factors 1, is not between 0"},
      {HEAD "0 180\n0\n50 1e300\n", 6, "is not a number"},
      {HEAD "0 180\n0\n50 1e20\n", 6, "is not between 0 and 1e+12"},
      {HEAD "0 180\n0\n50 50 50\n", 6, "more numbers than 1 x 2 angles"},
      {HEAD "180 0\n0\n50 50\n", 4, "vertical angle 0 follows 180"},
      {HEAD "0 200\n0\n50 50\n", 4, "vertical angle 200 is not between"},
      {HEAD "0 100\n0\n50 50\n", 5, "vertical angles go from 0 to 100"},
      {HEAD "0 180\n10\n50 50\n", 5, "horizontal angles go from 10 to 10"},
      {"TILT=NONE\n1 1000 1 2 4 1 1 0 0 0\n1 1 0\n0 180\n0 90 180 200\n1 1 1 1 1 1 1 1\n", 5,
       "horizontal angles go from 0 to 200"},
      {HEAD "0 180\n", 5, "it ends before the horizontal angle"},
      {"a\n1\n7\n", 3, "symmetry is 7"},
      {"a\n1\n4\n6\n15\n3\n", 7, "ends before the distance of intensities"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    vlLamp *lamp = NULL;
    vlError error = {0};
    vlResult r =
        vl_lamp_read(context, "lamp.ies", cases[i].file, strlen(cases[i].file), &lamp, &error);
    if (r != VL_ERROR_SCENE || lamp || error.line != cases[i].line ||
        strcmp(error.file, "lamp.ies") != 0 || !strstr(error.message, cases[i].message))
      fail_msg("%zu: result %d, %s:%u: %s", i, r, error.file, error.line, error.message);
  }
  vlLamp *lamp = NULL;
  vlError error = {0};
  assert_int_equal(vl_lamp_load(context, "/no/such/lamp.ies", &lamp, &error), VL_ERROR_MISSING);
  assert_int_equal(vl_lamp_load(context, NULL, &lamp, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_lamp_read(context, "x", NULL, 1, &lamp, &error), VL_ERROR_ARGUMENT);
}

static void wrong_directions(void **state) {
  (void)state;
  vlLamp *lamp = read_lamp(HEAD "0 180\n0\n50 50\n");
  const double none[3] = {0, 0, 0}, bad[3] = {NAN, 0, 1}, far[3] = {0, INFINITY, 0};
  const double large[3] = {1e200, 0, 0};
  assert_close("none", vl_lamp_intensity(lamp, none), 0, 0);
  assert_close("nan", vl_lamp_intensity(lamp, bad), 0, 0);
  assert_close("infinite", vl_lamp_intensity(lamp, far), 0, 0);
  (void)vl_lamp_intensity(lamp, large);
  vl_lamp_destroy(lamp);
  vl_lamp_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(symmetries, open_context, close_context),
      cmocka_unit_test_setup_teardown(poles, open_context, close_context),
      cmocka_unit_test_setup_teardown(known, open_context, close_context),
      cmocka_unit_test_setup_teardown(factors, open_context, close_context),
      cmocka_unit_test_setup_teardown(wrong_files, open_context, close_context),
      cmocka_unit_test_setup_teardown(wrong_directions, open_context, close_context)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
