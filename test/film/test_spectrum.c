/* test/film/test_spectrum.c: spectra in the film: exact sums of each bucket for any order,
 * grouping and passes; merging; names; invalid defs and samples; failing allocations. */
#include "failing_allocator.h"
#include "film/film.h"
#include "statistics.h"
#include "unit.h"
#include "velo/image.h"

enum { WIDTH = 5, HEIGHT = 4, BUCKETS = 7, COUNT = 4000, CELLS = WIDTH * HEIGHT * BUCKETS };

static vlContext *context_;
static int32_t px_[COUNT], py_[COUNT];
static float value_[4][COUNT], lambda_[4][COUNT], weight_[COUNT], zero_[COUNT];

static int set_up(void **state) {
  (void)state;
  assert_int_equal(vl_context_create(NULL, &context_), VL_OK);
  return 0;
}
static int tear_down(void **state) {
  (void)state;
  assert_int_equal(vl_context_memory(context_, NULL), 0);
  vl_context_destroy(context_);
  return 0;
}

static vlFilmDef film_def(void) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  def.buckets = BUCKETS;
  def.lambda_min = 400;
  def.lambda_max = 700;
  return def;
}
static vlFilm *new_film(void) {
  vlFilmDef def = film_def();
  vlFilm *film;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_OK);
  return film;
}

static void random_samples(uint64_t seed) {
  statRng rng = stat_rng(seed);
  for (int i = 0; i < COUNT; i++) {
    px_[i] = (int32_t)(stat_bits(&rng) % WIDTH);
    py_[i] = (int32_t)(stat_bits(&rng) % HEIGHT);
    weight_[i] = stat_bits(&rng) % 5 ? 1.25f : -0.25f;
    float u = stat_float(&rng);
    for (int c = 0; c < 4; c++) {
      lambda_[c][i] = 400 + 300 * fmodf(u + 0.25f * (float)c, 1);
      value_[c][i] = ldexpf(stat_float(&rng), (int)(stat_bits(&rng) % 40) - 20);
    }
  }
}

static void add(vlFilm *film, int from, int count) {
  vlFilmSpectra s = {
      .n = (uint32_t)count, .px = px_ + from, .py = py_ + from, .weight = weight_ + from};
  for (int c = 0; c < 4; c++) {
    s.radiance[c] = value_[c] + from;
    s.lambda[c] = lambda_[c] + from;
  }
  vl_film_add_spectra(film, &s);
  vlFilmSamples colors = {(uint32_t)count, px_ + from,     py_ + from,
                          zero_ + from,    zero_ + from,   zero_ + from,
                          zero_ + from,    weight_ + from, NULL};
  vl_film_add(film, &colors, NULL, NULL);
}
static void pass(vlFilm *film, int from, int count) {
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  add(film, from, count);
  vl_film_commit_pass(film);
}
static void spectrum(const vlFilm *film, float out[CELLS]) {
  vlImage *image;
  assert_int_equal(vl_film_spectrum(film, &image), VL_OK);
  assert_int_equal(vl_image_channels(image), BUCKETS);
  memcpy(out, vl_image_const_pixels(image), CELLS * sizeof *out);
  vl_image_destroy(image);
}

static float one_[CELLS], two_[CELLS];

static void exact(void **state) {
  (void)state;
  random_samples(3);
  vlFilm *film = new_film();
  pass(film, 0, COUNT);
  spectrum(film, one_);
  vl_film_destroy(film);
  const double y_integral = 106.856895;
  for (int i = 0; i < CELLS; i++) { /* against long double sums */
    int pixel = i / BUCKETS;
    long double sum = 0, all = 0;
    for (int k = 0; k < COUNT; k++)
      for (int c = 0; c < 4 && py_[k] * WIDTH + px_[k] == pixel; c++)
        if ((int)((lambda_[c][k] - 400.0) / (300.0 / BUCKETS)) == i % BUCKETS) {
          sum += (long double)weight_[k] * value_[c][k];
          all += weight_[k];
        }
    assert_true(all > 0);
    long double expected = sum / all * y_integral;
    assert_true(fabsl(one_[i] - expected) <= 1e-5L * fabsl(expected));
  }
  for (int way = 0; way < 3; way++) { /* in passes, backwards, with one given up */
    film = new_film();
    for (int from = 0, k = 0; from < COUNT; k++) {
      int count = way == 0 ? 100 : 37 + 13 * (k % 5);
      count = count < COUNT - from ? count : COUNT - from;
      if (way == 2 && k % 3 == 0) {
        assert_int_equal(vl_film_begin_pass(film), VL_OK);
        add(film, from / 2, 50);
        vl_film_abandon_pass(film);
      }
      pass(film, way == 1 ? COUNT - from - count : from, count);
      from += count;
    }
    spectrum(film, two_);
    assert_memory_equal(one_, two_, sizeof one_);
    vl_film_clear(film);
    spectrum(film, two_);
    for (int i = 0; i < CELLS; i++)
      assert_true(two_[i] == 0);
    pass(film, 0, COUNT);
    spectrum(film, two_);
    assert_memory_equal(one_, two_, sizeof one_);
    vl_film_destroy(film);
  }
}

/* A sample of four wavelengths leaves three of seven buckets empty: they get what lies between
 * those beside them. Pixels without samples are 0, and so is what was seen to be 0. */
static void empty_buckets(void **state) {
  (void)state;
  vlFilm *film = new_film();
  /* buckets 1, 2, 4, 5 */
  const float lambda[4] = {460, 500, 590, 640}, value[4] = {8, 2, 0, 3};
  const float expected[BUCKETS] = {8, 8, 2, 1, 0, 3, 3};
  px_[0] = 1;
  py_[0] = 0;
  weight_[0] = 1;
  for (int c = 0; c < 4; c++) {
    lambda_[c][0] = lambda[c];
    value_[c][0] = value[c];
  }
  pass(film, 0, 1);
  spectrum(film, one_);
  const float unit = one_[BUCKETS] / 8;
  assert_true(unit > 0);
  for (int i = 0; i < CELLS; i++) {
    const bool sampled = i / BUCKETS == 1;
    const float wanted = sampled ? unit * expected[i % BUCKETS] : 0;
    assert_true(fabsf(one_[i] - wanted) <= 1e-5f * unit);
  }
  vl_film_destroy(film);
}

static void names(void **state) {
  (void)state;
  vlFilm *film = new_film();
  vlImage *image;
  assert_int_equal(vl_film_spectrum(film, &image), VL_OK);
  assert_string_equal(vl_image_channel_name(image, 0), "S0.421,429nm");
  assert_string_equal(vl_image_channel_name(image, BUCKETS - 1), "S0.678,571nm");
  vl_image_destroy(image);
  vl_film_destroy(film);
}

static void wrong(void **state) {
  (void)state;
  const double ranges[5][2] = {{400, 400}, {700, 400}, {359, 700}, {400, 831}, {NAN, 700}};
  for (int i = 0; i < 6; i++) {
    vlFilmDef def = film_def();
    vlFilm *film;
    if (i < 5) {
      def.lambda_min = ranges[i][0];
      def.lambda_max = ranges[i][1];
    } else {
      def.buckets = 1001;
    }
    assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  }
  vlFilmDef plain = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *without, *film = new_film();
  vlImage *image;
  assert_int_equal(vl_film_create(context_, &plain, &without), VL_OK);
  assert_int_equal(vl_film_spectrum(without, &image), VL_ERROR_ARGUMENT);
  vl_film_destroy(without);
  /* not finite, too large, outside: the sample adds nothing */
  const float bad[3] = {NAN, INFINITY, 0x1p41f};
  random_samples(5);
  pass(film, 0, 500);
  spectrum(film, one_);
  for (int i = 0; i < 3; i++)
    value_[i][500 + i] = bad[i];
  px_[503] = WIDTH;
  pass(film, 500, 4);
  spectrum(film, two_);
  assert_memory_equal(one_, two_, sizeof one_);
  vl_film_destroy(film);
}

static vlResult whole_film(vlContext *context, void *user) {
  (void)user;
  vlFilmDef def = film_def();
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlResult r = vl_film_create(context, &def, &film);
  if (r == VL_OK)
    r = vl_film_begin_pass(film);
  if (r == VL_OK) {
    vl_film_abandon_pass(film);
    r = vl_film_begin_pass(film);
  }
  if (r == VL_OK) {
    add(film, 0, 100);
    vl_film_commit_pass(film);
    r = vl_film_spectrum(film, &image);
  }
  vl_image_destroy(image);
  vl_film_destroy(film);
  return r;
}
static void no_memory(void **state) {
  (void)state;
  random_samples(7);
  fail_everywhere(whole_film, NULL, 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(exact), cmocka_unit_test(empty_buckets),
                                     cmocka_unit_test(names), cmocka_unit_test(wrong),
                                     cmocka_unit_test(no_memory)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
