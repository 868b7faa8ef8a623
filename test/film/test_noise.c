/* test/film/test_noise.c: the noise of a film's blocks: against the known standard error of
 * normal samples, for each view; how often it is below the true error; against the true error
 * of rare bright samples; blocks at the edges of a crop. */
#include "film/film.h"
#include "statistics.h"
#include "unit.h"
#include "velo/filter_kinds.h"

enum { WIDTH = 100, HEIGHT = 70, SPP = 16 };
static const uint32_t crop_[4] = {16, 8, 96, 70};

typedef float Draw(statRng *rng, float mean, float deviation);

static float draw_normal(statRng *rng, float mean, float deviation) {
  float u = 1.0f - stat_float(rng), v = stat_float(rng);
  return mean + deviation * sqrtf(-2 * logf(u)) * cosf(6.2831853f * v);
}

enum { RARE = 64 };
static const float dark_sample = 0.01f, bright_sample = 2;

static float draw_rare(statRng *rng, float mean, float deviation) {
  (void)mean;
  (void)deviation;
  return stat_float(rng) * RARE < 1 ? bright_sample : dark_sample;
}

/* A film of grey samples. */
static vlFilm *film_of(vlContext *context, Draw *draw, float mean, float deviation,
                       uint64_t seed) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  def.errors = true;
  def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  memcpy(def.crop, crop_, sizeof crop_);
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  statRng rng = stat_rng(seed);
  assert_int_equal(vl_film_begin_pass(film), VL_OK);
  for (int32_t y = (int32_t)crop_[1]; y < (int32_t)crop_[3]; y++)
    for (int32_t x = (int32_t)crop_[0]; x < (int32_t)crop_[2]; x++)
      for (int s = 0; s < SPP; s++) {
        float value = draw(&rng, mean, deviation), alpha = 1, weight = 1;
        vlFilmSamples samples = {1, &x, &y, &value, &value, &value, &alpha, &weight, NULL};
        assert_int_equal(vl_film_add(film, &samples, NULL, NULL), 0);
      }
  vl_film_commit_pass(film);
  vl_film_set_spp(film, SPP);
  return film;
}

static vlFilm *noisy_film(vlContext *context, float mean, float deviation, uint64_t seed) {
  return film_of(context, draw_normal, mean, deviation, seed);
}

static void blocks_of_a_crop(void **state) {
  (void)state;
  /* columns 0-31, 32-63, 64-95; rows 0-31, 32-63, 64-69 */
  assert_int_equal(vl_film_block_count(crop_), 9);
  uint32_t pixels = 0;
  for (uint32_t i = 0; i < 9; i++) {
    uint32_t place[4];
    vl_film_block_window(crop_, i, place);
    pixels += (place[2] - place[0]) * (place[3] - place[1]);
    assert_int_equal(vl_film_block_at(crop_, place[0], place[1]), i);
    assert_int_equal(vl_film_block_at(crop_, place[2] - 1, place[3] - 1), i);
  }
  assert_int_equal(pixels, 80 * 62);
}

/* Of grey x the noise is the standard error times the slope of the view, and a little more: the
 * bound. */
static void expected_noise(void **state) {
  vlContext *context = *state;
  const float mean = 0.25f, deviation = 0.02f;
  const double error = (double)deviation / sqrt(SPP);
  const double slope = 1.055 / 2.4 * pow(0.25, 1 / 2.4 - 1);
  vlFilm *film = noisy_film(context, mean, deviation, 1);
  /* those of the lowest row have 6 lines: their bound is wider */
  for (uint32_t i = 0; i < 6; i++) {
    double raw = vl_film_block_noise(film, i, VL_VIEW_RAW, 0, 1, 1), standard;
    double bright = vl_film_block_noise(film, i, VL_VIEW_RAW, 1, 0.75f, 1);
    standard = vl_film_block_noise(film, i, VL_VIEW_STANDARD, 0, 1, 1);
    if (!(raw > 0.97 * error && raw < 1.06 * error))
      fail_msg("block %u: noise %g, error %g", i, raw, error);
    assert_true(fabs(bright / raw - 1.5) < 1e-5);
    assert_true(fabs(standard / (raw * slope) - 1) < 2e-3);
  }
  /* black and white are clipped: half of the interval remains at 0, nothing far above 1 */
  vlFilm *white = noisy_film(context, 3, deviation, 2),
         *black = noisy_film(context, 0, deviation, 3);
  assert_true(vl_film_block_noise(white, 4, VL_VIEW_STANDARD, 0, 1, 1) == 0);
  double half = vl_film_block_noise(black, 4, VL_VIEW_RAW, 0, 1, 1);
  assert_true(half > 0.4 * error && half < 0.7 * error);
  assert_true(vl_film_block_noise(white, 4, VL_VIEW_KHRONOS_NEUTRAL, 0, 1, 1) > 0);
  vl_film_destroy(film);
  vl_film_destroy(white);
  vl_film_destroy(black);
}

/* The squared noise lies three standard errors of its mean above the square of the error, in
 * the mean of 240 blocks: 40 films of 6. A variance from SPP normal samples has a relative
 * standard error of sqrt(2 / (SPP - 1)). */
static void bound_holds(void **state) {
  vlContext *context = *state;
  const double square = 0.05 * 0.05 / SPP;
  double sum = 0, squares = 0;
  for (uint64_t seed = 10; seed < 50; seed++) {
    vlFilm *film = noisy_film(context, 0.5f, 0.05f, seed);
    for (uint32_t i = 0; i < 6; i++) {
      uint32_t place[4];
      vl_film_block_window(crop_, i, place);
      double pixels = (double)((place[2] - place[0]) * (place[3] - place[1])), noise;
      noise = vl_film_block_noise(film, i, VL_VIEW_RAW, 0, 1, 1);
      double errors = (noise * noise / square - 1) / sqrt(2.0 / (SPP - 1) / pixels);
      sum += errors;
      squares += errors * errors;
    }
    vl_film_destroy(film);
  }
  double mean = sum / 240, deviation = sqrt(squares / 240 - mean * mean);
  if (!(fabs(mean - 3) < 4 / sqrt(240)))
    fail_msg("%g standard errors above", mean);
  if (!(deviation > 0.8 && deviation < 1.2))
    fail_msg("spread of %g standard errors", deviation);
}

/* Samples of a pixel, a random permutation of strata. */
static vlFilm *stratified_film(vlContext *context, uint32_t strata, uint64_t seed,
                               double *true_noise) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  def.errors = true;
  def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  statRng rng = stat_rng(seed);
  float done[WIDTH * HEIGHT] = {0};
  uint32_t places[WIDTH * HEIGHT];
  for (uint32_t end = 8, first = 0; end <= SPP; first = end, end += 8) {
    assert_int_equal(vl_film_begin_pass(film), VL_OK);
    vl_film_set_pass_samples(film, first, end);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
      for (uint32_t s = first; s < end; s++) {
        if (s % strata == 0)
          places[i] = (uint32_t)(stat_float(&rng) * (float)strata);
        /* s * 5 mod strata: each stratum once */
        uint32_t stratum = (s * 5 + places[i]) % strata;
        float value = ((float)stratum + stat_float(&rng)) / (float)strata, one = 1;
        int32_t x = i % WIDTH, y = i / WIDTH;
        vlFilmSamples samples = {1, &x, &y, &value, &value, &value, &one, &one, &s};
        assert_int_equal(vl_film_add(film, &samples, NULL, NULL), 0);
        done[i] += value / SPP;
      }
    vl_film_commit_pass(film);
    vl_film_set_spp(film, end);
  }
  double sum = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    sum += ((double)done[i] - 0.5) * ((double)done[i] - 0.5);
  *true_noise = sqrt(sum / (WIDTH * HEIGHT));
  return film;
}

/* Of better distributed samples the noise is lower, by what the first half shows, and still
 * above the error. Of independent samples (one stratum) it is not. */
static void distribution_counts(void **state) {
  vlContext *context = *state;
  const double independent = sqrt(1.0 / 12 / SPP);
  const struct {
    uint32_t strata;
    double min, max; /* noise over that of independent samples */
  } rows[4] = {{1, 0.97, 1.08}, {2, 0.45, 0.60}, {4, 0.22, 0.30}, {8, 0.11, 0.15}};
  for (int k = 0; k < 4; k++) {
    double error;
    vlFilm *film = stratified_film(context, rows[k].strata, 7 + (uint64_t)k, &error);
    for (uint32_t i = 0; i < 6; i++) { /* the others have few pixels */
      double noise = vl_film_block_noise(film, i, VL_VIEW_RAW, 0, 1, 1);
      if (!(noise > error))
        fail_msg("%u strata: noise %g, error %g", rows[k].strata, noise, error);
      noise /= independent;
      if (!(noise > rows[k].min && noise < rows[k].max))
        fail_msg("%u strata: %g", rows[k].strata, noise);
    }
    vl_film_destroy(film);
  }
}

static double srgb(double x) {
  x = x < 0 ? 0 : x > 1 ? 1 : x;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/* 78 % of the pixels have no bright sample and no variance. The true error is a sum over the
 * binomial distribution of a pixel's bright samples. The noise may be above it, since it is a
 * bound, but not below. */
static void rare_light_is_not_missed(void **state) {
  vlContext *context = *state;
  const double p = 1.0 / RARE, mean = (1 - p) * (double)dark_sample + p * (double)bright_sample;
  double probability = pow(1 - p, SPP), square = 0;
  for (int k = 0; k <= SPP; k++) {
    double d =
        srgb(((SPP - k) * (double)dark_sample + k * (double)bright_sample) / SPP) - srgb(mean);
    square += probability * d * d;
    probability *= (double)(SPP - k) / (k + 1) * p / (1 - p);
  }
  vlFilm *film = film_of(context, draw_rare, 0, 0, 5);
  /* the bound's distance from the mean */
  double apart = vl_film_block_noise(film, 0, VL_VIEW_STANDARD, 0, 1, 1), alike[2];
  for (int k = 0; k < 2; k++)
    alike[k] = vl_film_block_noise(film, 0, VL_VIEW_STANDARD, 0, 1, k ? 4 : 0);
  double none = alike[0] * alike[0], one = apart * apart - none,
         four = alike[1] * alike[1] - none;
  assert_true(one > 0 && fabs(four / one - 2) < 1e-3);
  for (uint32_t i = 0; i < 6; i++) {
    double noise = vl_film_block_noise(film, i, VL_VIEW_STANDARD, 0, 1, 1) / sqrt(square);
    if (!(noise > 1 && noise < 1.5))
      fail_msg("block %u: %g times the true error, %g", i, noise, sqrt(square));
  }
  vl_film_destroy(film);
}

static void without_samples(void **state) {
  vlContext *context = *state;
  vlFilmDef def = vl_default_film_def(40, 40);
  vlFilm *film;
  def.errors = true;
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  assert_true(isinf(vl_film_block_noise(film, 0, VL_VIEW_STANDARD, 0, 1, 1)));
  assert_false(vl_film_is_adaptive(film));
  assert_int_equal(vl_film_set_block_spp(film, 3, 5), VL_OK);
  assert_true(vl_film_is_adaptive(film));
  assert_int_equal(vl_film_spp(film), 5);
  assert_int_equal(vl_film_block_spp(film, 0), 0);
  vl_film_clear(film);
  assert_int_equal(vl_film_block_spp(film, 3), 0);
  assert_false(vl_film_is_adaptive(film));
  vl_film_destroy(film);
}

static int begin(void **state) {
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  return vl_context_create(&def, (vlContext **)state) != VL_OK;
}
static int end(void **state) {
  vl_context_destroy(*state);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(blocks_of_a_crop),
                                     cmocka_unit_test(expected_noise),
                                     cmocka_unit_test(bound_holds),
                                     cmocka_unit_test(distribution_counts),
                                     cmocka_unit_test(rare_light_is_not_missed),
                                     cmocka_unit_test(without_samples)};
  return cmocka_run_group_tests(tests, begin, end);
}
