/* test/film/test_expose.c: tests the conversion of radiance to the film's colours against the
 * definitions of colour spaces, and the merging of films with error sums against one film with
 * all samples. */
#include <string.h>

#include "base/isa.h"
#include "film/expose.h"
#include "statistics.h"
#include "unit.h"
#include "velo/image.h"

enum { WIDTH = 9, HEIGHT = 7, N = 32 };
static vlContext *context;
static float colors[3][N];

static int begin(void **state) {
  (void)state;
  statRng rng = stat_rng(5);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < N; i++)
      colors[c][i] = i == 0 ? 1.0f : 4.0f * stat_float(&rng);
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  return vl_context_create(&def, &context) != VL_OK;
}

static int end(void **state) {
  (void)state;
  vl_context_destroy(context);
  return 0;
}

static void expose(vlFilmDef def, float exposure, float out[3][N]) {
  vlFilm *film;
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  vlExposure e = {.n = N, .radiance = {colors[0], colors[1], colors[2]}, .exposure = exposure};
  vl_film_expose(film, vl_isa_best(), &e, out[0], out[1], out[2]);
  vl_film_destroy(film);
}

static void rec709_stays_as_it_is(void **state) {
  (void)state;
  float out[3][N];
  expose(vl_default_film_def(WIDTH, HEIGHT), 1.0f, out);
  assert_memory_equal(out, colors, sizeof out);
  expose(vl_default_film_def(WIDTH, HEIGHT), 2.0f, out);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < N; i++)
      assert_true(out[c][i] == 2.0f * colors[c][i]);
}

/* The conversion from linear Rec.709 to Rec.2020 is that of ITU-R BT.2087-0, table 2. Both have
 * the white D65. */
static void rec2020_is_that_of_bt_2087(void **state) {
  (void)state;
  static const double m[3][3] = {
      {0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}};
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  float out[3][N];
  def.space = VL_SPACE_REC2020;
  expose(def, 1.0f, out);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < N; i++) {
      double wanted = m[c][0] * (double)colors[0][i] + m[c][1] * (double)colors[1][i] +
                      m[c][2] * (double)colors[2][i];
      assert_true(fabs((double)out[c][i] - wanted) < 2e-3);
    }
}

/* The largest of X, Y, Z is limited to max_component, and the ratios of the components do not
 * change. */
static void bright_colours_are_scaled(void **state) {
  (void)state;
  static const double m[3][3] = {{0.4124, 0.3576, 0.1805},
                                 {0.2126, 0.7152, 0.0722},
                                 {0.0193, 0.1192, 0.9505}}; /* IEC 61966-2-1 */
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  float out[3][N];
  int scaled = 0;
  def.max_component = 1.5f;
  expose(def, 1.0f, out);
  for (int i = 0; i < N; i++) {
    double before = 0.0, after = 0.0;
    for (int c = 0; c < 3; c++) {
      before = fmax(before, m[c][0] * (double)colors[0][i] + m[c][1] * (double)colors[1][i] +
                                m[c][2] * (double)colors[2][i]);
      after = fmax(after, m[c][0] * (double)out[0][i] + m[c][1] * (double)out[1][i] +
                              m[c][2] * (double)out[2][i]);
    }
    scaled += before > 1.5;
    assert_true(fabs(after - fmin(before, 1.5)) < 2e-3);
    for (int c = 0; c < 3; c++)
      assert_true(
          fabs((double)(out[c][i] * colors[0][i]) - (double)(out[0][i] * colors[c][i])) < 1e-4);
  }
  assert_true(scaled > 0 && scaled < N);
}

/* A white balance does not change by how much a colour is scaled. */
static void white_balance_keeps_limits(void **state) {
  (void)state;
  static const vlColorSpace spaces[] = {VL_SPACE_SRGB, VL_SPACE_REC2020};
  float plain[3][N], limited[3][N], balanced[3][N], both[3][N];
  int scaled = 0;
  for (int k = 0; k < 2; k++) {
    vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT), low = def;
    def.space = low.space = spaces[k];
    low.max_component = 1.5f;
    expose(def, 1.0f, plain);
    expose(low, 1.0f, limited);
    def.white_balance = low.white_balance = 3000;
    expose(def, 1.0f, balanced);
    expose(low, 1.0f, both);
    for (int i = 0; i < N; i++) {
      double by = (double)limited[1][i] / (double)plain[1][i];
      scaled += by < 0.99;
      for (int c = 0; c < 3; c++)
        assert_true(fabs((double)both[c][i] - by * (double)balanced[c][i]) < 2e-3);
    }
  }
  assert_true(scaled > 0 && scaled < 2 * N);
}

static void sensors_have_names(void **state) {
  (void)state;
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  def.sensor = "no such sensor";
  assert_int_equal(vl_film_create(context, &def, &film), VL_ERROR_ARGUMENT);
  assert_null(film);
  def.sensor = vl_sensor_name(1);
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  assert_non_null(vl_film_sensor(film));
  assert_true(vl_film_def(film)->white_balance == 6500.0);
  vl_film_destroy(film);
  def.sensor = vl_sensor_name(0); /* the standard observer */
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  assert_null(vl_film_sensor(film));
  vl_film_destroy(film);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rec709_stays_as_it_is), cmocka_unit_test(rec2020_is_that_of_bt_2087),
      cmocka_unit_test(bright_colours_are_scaled), cmocka_unit_test(white_balance_keeps_limits),
      cmocka_unit_test(sensors_have_names)};
  return cmocka_run_group_tests(tests, begin, end);
}
