/* test/film/test_film.c: the film: exact sums for any order and grouping, constant images,
 * passes without effect on the bits, merging, invalid samples, invalid defs, failing
 * allocations, memory with junk. */
#include "film/film.h"
#include "film/sums.h"
#include "statistics.h"
#include "unit.h"
#include "velo/image.h"

enum { WIDTH = 12, HEIGHT = 9, COUNT = 6000 };

static vlContext *context_;
static int32_t px_[COUNT], py_[COUNT];
static float r_[COUNT], g_[COUNT], b_[COUNT], a_[COUNT], w_[COUNT];

static int set_up(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  assert_int_equal(vl_context_create(&def, &context_), VL_OK);
  return 0;
}
static int tear_down(void **state) {
  (void)state;
  vl_context_destroy(context_);
  return 0;
}

static vlFilm *new_film(void) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_OK);
  return film;
}

/* Values over 60 powers of two, weights of both signs. */
static void random_samples(uint64_t seed) {
  statRng rng = stat_rng(seed);
  for (int i = 0; i < COUNT; i++) {
    px_[i] = (int32_t)(stat_bits(&rng) % WIDTH);
    py_[i] = (int32_t)(stat_bits(&rng) % HEIGHT);
    r_[i] = ldexpf(stat_float(&rng), (int)(stat_bits(&rng) % 60) - 30);
    g_[i] = stat_float(&rng) - 0.3f;
    b_[i] = ldexpf(stat_float(&rng), -20);
    a_[i] = stat_float(&rng) * 1.2f - 0.1f;
    w_[i] = 2.5f * stat_float(&rng) - 0.5f;
  }
}
static void shuffle(uint64_t seed) {
  statRng rng = stat_rng(seed);
  float *columns[5] = {r_, g_, b_, a_, w_};
  for (int i = COUNT - 1; i > 0; i--) {
    int j = (int)(stat_bits(&rng) % (uint64_t)(i + 1));
    int32_t x = px_[i], y = py_[i];
    px_[i] = px_[j];
    py_[i] = py_[j];
    px_[j] = x;
    py_[j] = y;
    for (int c = 0; c < 5; c++) {
      float t = columns[c][i];
      columns[c][i] = columns[c][j];
      columns[c][j] = t;
    }
  }
}
static uint32_t add(vlFilm *film, int from, int count) {
  vlFilmSamples s = {(uint32_t)count, px_ + from, py_ + from, r_ + from, g_ + from,
                     b_ + from,       a_ + from,  w_ + from,  NULL};
  return vl_film_add(film, &s, NULL, NULL);
}
static void whole_pass(vlFilm *film, int from, int count) {
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  assert_int_equal(add(film, from, count), 0);
  vl_film_commit_pass(film);
}
static void develop(const vlFilm *film, float *out) {
  vlDevelopDef def = vl_default_develop_def();
  vlImage *image;
  assert_int_equal(vl_film_develop(film, &def, &image), VL_OK);
  memcpy(out, vl_image_const_pixels(image),
         (size_t)vl_image_width(image) * vl_image_height(image) * 16);
  vl_image_destroy(image);
}

static float one_[WIDTH * HEIGHT * 4], two_[WIDTH * HEIGHT * 4];

static void test_exact(void **state) {
  (void)state;
  random_samples(1);
  vlFilm *film = new_film();
  whole_pass(film, 0, COUNT);
  develop(film, one_);
  vl_film_destroy(film);
  /* against long double sums */
  for (int p = 0; p < WIDTH * HEIGHT; p++) {
    long double sum = 0, weight = 0;
    for (int i = 0; i < COUNT; i++)
      if (py_[i] * WIDTH + px_[i] == p) {
        long double w = roundl((long double)w_[i] * 0x1p24L) * 0x1p-24L;
        sum += w * r_[i];
        weight += w;
      }
    assert_true(weight > 0);
    assert_true(fabsl(one_[4 * p] - sum / weight) <= 1e-7L * fabsl(sum / weight));
  }
  for (uint64_t k = 0; k < 8; k++) { /* any order, any grouping into batches and passes */
    shuffle(k);
    statRng rng = stat_rng(k);
    film = new_film();
    for (int from = 0; from < COUNT;) {
      int count = 1 + (int)(stat_bits(&rng) % (k < 4 ? 100 : 3000));
      count = count < COUNT - from ? count : COUNT - from;
      whole_pass(film, from, count);
      from += count;
    }
    develop(film, two_);
    assert_memory_equal(one_, two_, sizeof one_);
    vl_film_destroy(film);
  }
}

/* A product is rounded to the nearest unit of the sum, however small it is. */
static void test_small_products(void **state) {
  (void)state;
  const int64_t weights[3] = {1, (INT64_C(1) << VL_WEIGHT_BITS) / 3, INT64_C(1) << 28};
  for (int exponent = -149; exponent < 40; exponent++)
    for (int k = 0; k < 3; k++) {
      float value = (float)ldexp(k & 1 ? -1.3 : 1.7, exponent);
      double units = ldexp((double)value * (double)weights[k], VL_COLOR_BITS - VL_WEIGHT_BITS);
      double product = (double)vl_film_product(value, weights[k]);
      assert_true(fabs(product - units) <= 0.5 + 1e-15 * fabs(units));
    }
}

static void test_constant(void **state) {
  (void)state;
  static const float VALUES[] = {0.18f, 1.0f, 1.0f / 3.0f, 1234.567f,
                                 1e-4f, 7e8f, 0.0f,        0.7310586f};
  vlFilm *film = new_film();
  statRng rng = stat_rng(9);
  for (size_t k = 0; k < sizeof VALUES / sizeof VALUES[0]; k++) {
    vl_film_destroy(film);
    film = new_film();
    for (int i = 0; i < COUNT; i++) {
      px_[i] = i % WIDTH;
      py_[i] = i / WIDTH % HEIGHT;
      r_[i] = g_[i] = VALUES[k];
      b_[i] = -VALUES[k];
      a_[i] = 1.0f;
      w_[i] = stat_bits(&rng) % 5 == 0 ? -1.1376f : 1.1376f * stat_float(&rng) + 0.5f;
    }
    whole_pass(film, 0, COUNT);
    develop(film, one_);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
      assert_true(one_[4 * p] == VALUES[k] && one_[4 * p + 1] == VALUES[k] &&
                  one_[4 * p + 2] == -VALUES[k] && one_[4 * p + 3] == 1.0f);
  }
  vl_film_destroy(film);
}

static void test_passes(void **state) {
  (void)state;
  random_samples(2);
  vlFilm *plain = new_film(), *film = new_film();
  develop(film, one_); /* nothing yet: black */
  for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
    assert_true(one_[i] == 0);
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  add(film, 4000, 2000);
  vl_film_abandon_pass(film);
  develop(film, two_);
  assert_memory_equal(one_, two_, sizeof one_);
  for (int from = 0; from < COUNT; from += 50) {
    whole_pass(plain, from, 50); /* touches fewer pixels than there are */
    assert_int_equal(vl_film_begin_pass(film), VL_OK);
    add(film, (from * 7) % 3000, 777);
    vl_film_abandon_pass(film);
    whole_pass(film, from, 50);
    vl_film_set_spp(film, (uint32_t)from + 1);
    assert_int_equal(vl_film_spp(film), from + 1);
    develop(plain, one_);
    develop(film, two_);
    assert_memory_equal(one_, two_, sizeof one_);
  }
  assert_int_equal(add(film, 0, 10), 10); /* outside a pass nothing is taken */
  develop(film, two_);
  assert_memory_equal(one_, two_, sizeof one_);
  vl_film_destroy(plain);
  vl_film_destroy(film);
}

/* After 2^32 - 1 passes the numbers begin again: what the first pass touched does not count as
 * touched by the next. */
static void test_pass_numbers_wrap(void **state) {
  (void)state;
  random_samples(3);
  vlFilm *plain = new_film(), *film = new_film();
  for (int i = 0; i < 2; i++)
    whole_pass(i ? film : plain, 0, 50);
  film->pass = UINT32_MAX;
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  add(film, 4000, 3);
  vl_film_abandon_pass(film);
  assert_int_equal(film->pass, 1);
  for (int i = 0; i < 2; i++)
    whole_pass(i ? film : plain, 50, 3);
  develop(plain, one_);
  develop(film, two_);
  assert_memory_equal(one_, two_, sizeof one_);
  vl_film_destroy(plain);
  vl_film_destroy(film);
}

/* The bytes that a film holds after passes, and what vl_film_memory tells. */
static double held_memory(const vlFilmDef *def, double *told) {
  const uint64_t before = vl_context_memory(context_, NULL);
  vlFilm *film;
  assert_int_equal(vl_film_create(context_, def, &film), VL_OK);
  for (int pass = 0; pass < 2; pass++)
    whole_pass(film, 0, COUNT);
  const double held = (double)(vl_context_memory(context_, NULL) - before);
  *told = (double)vl_film_memory(def);
  vl_film_destroy(film);
  return held;
}

/* They grow alike with the number of pixels. */
static void test_told_memory(void **state) {
  (void)state;
  random_samples(5);
  for (int i = 0; i < 6; i++) {
    vlFilmDef def = vl_default_film_def(200, 100);
    def.errors = i % 2;
    def.buckets = (uint32_t)(i / 2 * 4); /* 0, 4, 8 */
    double told[2];
    const double whole = held_memory(&def, &told[0]);
    def.crop[2] = 150;
    def.crop[3] = 60;
    const double held = whole - held_memory(&def, &told[1]);
    if (!(fabs(held / (told[0] - told[1]) - 1) < 0.02))
      fail_msg("film %d: %.0f bytes more, not %.0f", i, held, told[0] - told[1]);
  }
}

/* A coarse film covers the crop of the fine one, and begins where it begins. */
static void test_coarse_def(void **state) {
  (void)state;
  vlFilmDef def = vl_default_film_def(33, 17);
  const uint32_t crop[4] = {5, 3, 30, 16}, covered[4] = {1, 0, 8, 4};
  memcpy(def.crop, crop, sizeof crop);
  def.errors = true;
  def.buckets = 3;
  vlFilmDef coarse = vl_coarse_film_def(&def, 4), same = vl_coarse_film_def(&def, 0);
  assert_int_equal(coarse.width, 9);
  assert_int_equal(coarse.height, 5);
  assert_memory_equal(coarse.crop, covered, sizeof covered);
  assert_false(coarse.errors || coarse.buckets);
  assert_int_equal(same.width, 33);
  assert_memory_equal(same.crop, crop, sizeof crop);
}

static void test_wrong_samples(void **state) {
  (void)state;
  random_samples(4);
  vlFilm *film = new_film(), *clean = new_film();
  for (int i = 0; i < 100; i++)
    w_[i] = 1;
  whole_pass(clean, 0, 100);
  develop(clean, one_);
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  assert_int_equal(add(film, 0, 100), 0);
  float bad[] = {NAN, -NAN, INFINITY, -INFINITY, 0x1p40f, -0x1p40f, 3e38f};
  float *columns[5] = {r_, g_, b_, a_, w_};
  for (size_t k = 0; k < 7; k++)
    for (int c = 0; c < 5; c++) {
      if (c == 3 && k > 3)
        continue; /* alpha is clamped */
      random_samples(5);
      w_[0] = 1;
      columns[c][1] = bad[k];
      px_[1] = 7;
      py_[1] = 3;
      int32_t x = -1, y = -1;
      vlFilmSamples s = {1, px_ + 1, py_ + 1, r_ + 1, g_ + 1, b_ + 1, a_ + 1, w_ + 1, NULL};
      assert_int_equal(vl_film_add(film, &s, &x, &y), 1);
      assert_true(x == 7 && y == 3);
    }
  px_[1] = WIDTH; /* outside */
  r_[1] = g_[1] = b_[1] = a_[1] = w_[1] = 1;
  assert_int_equal(add(film, 1, 1), 1);
  px_[1] = -1;
  assert_int_equal(add(film, 1, 1), 1);
  vl_film_commit_pass(film);
  develop(film, two_);
  assert_memory_equal(one_, two_, sizeof one_);
  vl_film_destroy(film);
  vl_film_destroy(clean);

  /* weights that sum to nothing or less give black; tiny and denormal values pass; large sums
   * do not overflow */
  film = new_film();
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  px_[0] = py_[0] = px_[1] = py_[1] = 0;
  r_[0] = g_[0] = b_[0] = a_[0] = r_[1] = g_[1] = b_[1] = a_[1] = 1;
  w_[0] = 1;
  w_[1] = -1;
  assert_int_equal(add(film, 0, 2), 0);
  for (int i = 0; i < COUNT; i++) {
    px_[i] = 1;
    py_[i] = 0;
    r_[i] = 0x1.fffffep39f;
    g_[i] = -0x1.fffffep39f;
    b_[i] = 1e-42f;
    a_[i] = 1;
    w_[i] = 15.5f;
  }
  for (int k = 0; k < 20; k++)
    assert_int_equal(add(film, 0, COUNT), 0);
  vl_film_commit_pass(film);
  develop(film, one_);
  assert_true(one_[0] == 0 && one_[1] == 0 && one_[2] == 0 && one_[3] == 0);
  assert_true(one_[4] == 0x1.fffffep39f && one_[5] == -0x1.fffffep39f && one_[6] == 0 &&
              one_[7] == 1);
  vl_film_destroy(film);
}

static void test_crop_and_develop(void **state) {
  (void)state;
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  def.crop[0] = 3;
  def.crop[1] = 2;
  def.crop[2] = 7;
  def.crop[3] = 8;
  vlFilm *film;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_OK);
  for (int i = 0; i < 24; i++) {
    px_[i] = 3 + i % 4;
    py_[i] = 2 + i / 4;
    r_[i] = (float)i;
    g_[i] = b_[i] = 0.25f;
    a_[i] = 0.5f;
    w_[i] = 1;
  }
  whole_pass(film, 0, 24);
  vlDevelopDef develop_def = vl_default_develop_def();
  develop_def.exposure = 4;
  vlImage *image;
  assert_int_equal(vl_film_develop(film, &develop_def, &image), VL_OK);
  assert_true(vl_image_width(image) == 4 && vl_image_height(image) == 6 &&
              vl_image_channels(image) == 4);
  for (uint32_t y = 0; y < 6; y++)
    for (uint32_t x = 0; x < 4; x++) {
      assert_true(vl_image_get(image, x, y, 0) == 4.0f * (float)(4 * y + x));
      assert_true(vl_image_get(image, x, y, 1) == 1.0f && vl_image_get(image, x, y, 3) == 0.5f);
    }
  vlAttribute a;
  assert_int_equal(vl_image_find_attribute(image, "dataWindow", &a), VL_OK);
  assert_true(a.numbers[0] == 3 && a.numbers[1] == 2 && a.numbers[2] == 6 && a.numbers[3] == 7);
  assert_int_equal(vl_image_find_attribute(image, "displayWindow", &a), VL_OK);
  assert_true(a.numbers[0] == 0 && a.numbers[1] == 0 && a.numbers[2] == WIDTH - 1 &&
              a.numbers[3] == HEIGHT - 1);
  assert_int_equal(vl_image_find_attribute(image, "chromaticities", &a), VL_OK);
  assert_true(fabs(a.numbers[0] - 0.64) < 1e-3 && fabs(a.numbers[7] - 0.329) < 1e-3);
  vl_image_destroy(image);
  develop_def.cookie = 0;
  assert_int_equal(vl_film_develop(film, &develop_def, &image), VL_ERROR_ARGUMENT);
  vl_film_destroy(film);
}

static void test_wrong_defs(void **state) {
  (void)state;
  vlFilm *film;
  vlFilmDef good = vl_default_film_def(WIDTH, HEIGHT), def = good;
  def.cookie = 0;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  def = vl_default_film_def(0, 5);
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  def = vl_default_film_def(70000, 5);
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  def = good;
  def.crop[2] = WIDTH + 1;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  def = good;
  def.crop[1] = def.crop[3];
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  def = good;
  def.filter.radius_x = NAN;
  assert_int_equal(vl_film_create(context_, &def, &film), VL_ERROR_ARGUMENT);
  assert_null(film);
  assert_int_equal(vl_film_create(NULL, &good, &film), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_film_create(context_, &good, NULL), VL_ERROR_ARGUMENT);
  vl_film_destroy(NULL);
}

typedef struct Meager {
  int left, held;
} Meager;
static void *meager_allocate(void *user, size_t size) {
  Meager *m = user;
  if (m->left-- <= 0)
    return NULL;
  m->held++;
  return malloc(size);
}
static void meager_release(void *user, void *block) {
  if (block)
    ((Meager *)user)->held--;
  free(block);
}

static void test_memory(void **state) {
  (void)state;
  bool done = false;
  for (int n = 0; n < 200 && !done; n++) {
    Meager meager = {1000, 0};
    vlContextDef def = vl_default_context_def();
    def.allocator = (vlAllocator){&meager, meager_allocate, meager_release};
    def.threads = 1;
    vlContext *context;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    meager.left = n;
    vlFilmDef film_def = vl_default_film_def(WIDTH, HEIGHT);
    vlFilm *film = NULL;
    vlImage *image = NULL;
    vlResult result = vl_film_create(context, &film_def, &film);
    for (int pass = 0; pass < 2 && result == VL_OK; pass++) {
      result = vl_film_begin_pass(film);
      if (result == VL_OK)
        vl_film_commit_pass(film);
    }
    vlDevelopDef develop_def = vl_default_develop_def();
    if (result == VL_OK)
      result = vl_film_develop(film, &develop_def, &image);
    assert_true(result == VL_OK || result == VL_ERROR_MEMORY);
    done = result == VL_OK;
    vl_image_destroy(image);
    vl_film_destroy(film);
    vl_context_destroy(context);
    assert_int_equal(meager.held, 0);
  }
  assert_true(done);
}

enum { JUNK = 0xa5 };
static void *junk_allocate(void *user, size_t size) {
  (void)user;
  void *block = malloc(size);
  if (block)
    memset(block, JUNK, size);
  return block;
}
static void junk_release(void *user, void *block) {
  (void)user;
  free(block);
}

static vlFilm *film_with_errors(vlContext *context) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  def.errors = true;
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  return film;
}

/* Two passes, the first of which leaves pixels without samples. */
static void two_passes(vlFilm *film) {
  whole_pass(film, 0, WIDTH);
  whole_pass(film, WIDTH, COUNT - WIDTH);
  vl_film_set_spp(film, 2);
}

static void assert_same_sums(const vlFilm *a, const vlFilm *b) {
  assert_memory_equal(a->front, b->front, WIDTH * HEIGHT * sizeof *a->front);
  assert_memory_equal(a->moments[0], b->moments[0], WIDTH * HEIGHT * sizeof *a->moments[0]);
}

/* The moments of a film, which are many, are not cleared at the begin of its first pass, where
 * nobody could end the render. What their memory held is in no sum: not after an abandoned
 * pass, nor after the film was cleared. */
static void test_moments_are_not_cleared(void **state) {
  (void)state;
  random_samples(7);
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){NULL, junk_allocate, junk_release};
  def.threads = 1;
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlFilm *plain = film_with_errors(context_), *film = film_with_errors(context);
  two_passes(plain);
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  for (int i = 0; i < 2; i++) {
    const unsigned char *bytes = (const unsigned char *)film->moments[i];
    for (size_t k = 0; k < WIDTH * HEIGHT * sizeof *film->moments[i]; k++)
      assert_int_equal(bytes[k], JUNK);
  }
  add(film, 3000, 500);
  vl_film_abandon_pass(film);
  two_passes(film);
  assert_same_sums(film, plain);
  vl_film_clear(film);
  two_passes(film);
  assert_same_sums(film, plain);
  vl_film_destroy(plain);
  vl_film_destroy(film);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_exact),
      cmocka_unit_test(test_small_products),
      cmocka_unit_test(test_constant),
      cmocka_unit_test(test_passes),
      cmocka_unit_test(test_pass_numbers_wrap),
      cmocka_unit_test(test_told_memory),
      cmocka_unit_test(test_coarse_def),
      cmocka_unit_test(test_wrong_samples),
      cmocka_unit_test(test_crop_and_develop),
      cmocka_unit_test(test_wrong_defs),
      cmocka_unit_test(test_memory),
      cmocka_unit_test(test_moments_are_not_cleared),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
