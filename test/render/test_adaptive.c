/* test/render/test_adaptive.c: adaptive sampling: for every tracer, a film whose blocks have
 * different numbers of samples is filled up to the film of a plain render; so is one whose
 * passes go over a part of the rows; a threshold that every block is below stops all at the
 * first comparison; wrong defs. */
#include "loaded.h"
#include "velo/render.h"
#include "velo/tracer.h"

#define ONE(kind, name) +1
enum { WIDTH = 72, HEIGHT = 40, TRACERS = VL_TRACER_KINDS(ONE) };
static Loaded loaded;

static int begin(void **state) {
  (void)state;
  return !load_world(&loaded, "features/two_way.pbrt", WIDTH, HEIGHT);
}

static int end(void **state) {
  (void)state;
  unload_world(&loaded);
  return 0;
}

static vlFilm *make_film(bool errors) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  vlFilm *film;
  def.errors = errors;
  assert_int_equal(vl_film_create(loaded.context, &def, &film), VL_OK);
  return film;
}

static bool same(const vlFilm *a, const vlFilm *b) {
  vlImage *images[2] = {NULL, NULL};
  assert_int_equal(vl_film_errors(a, NULL, &images[0]), VL_OK);
  assert_int_equal(vl_film_errors(b, NULL, &images[1]), VL_OK);
  bool equal = memcmp(vl_image_const_pixels(images[0]), vl_image_const_pixels(images[1]),
                      (size_t)WIDTH * HEIGHT * 3 * sizeof(float)) == 0;
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  return equal;
}

static vlRenderDef render_def(vlTracer tracer, double noise, uint32_t spp) {
  vlRenderDef def = vl_default_render_def();
  def.tracer = tracer;
  def.noise = noise;
  def.spp = spp;
  return def;
}

static void filled(void **state) {
  (void)state;
  int adaptive = 0;
  for (int tracer = 0; tracer < TRACERS; tracer++) {
    vlFilm *parts = make_film(true), *whole = make_film(true);
    vlRenderDef def = render_def((vlTracer)tracer, 0.05, 20);
    vlRenderStats stats;
    assert_int_equal(vl_render(loaded.world, &loaded.camera, parts, &def, &stats, NULL), VL_OK);
    adaptive += stats.mean_spp < stats.spp;
    assert_int_equal(stats.blocks, 6);
    def.noise = 0;
    assert_int_equal(vl_render(loaded.world, &loaded.camera, parts, &def, &stats, NULL), VL_OK);
    assert_true(stats.mean_spp == 20 && stats.noisy_blocks == 0);
    assert_int_equal(vl_render(loaded.world, &loaded.camera, whole, &def, NULL, NULL), VL_OK);
    if (!same(parts, whole))
      fail_msg("tracer %d: the filled film differs", tracer);
    vl_film_destroy(parts);
    vl_film_destroy(whole);
  }
  assert_true(adaptive >= 4); /* else nothing was filled */
}

static void first_comparison(void **state) {
  (void)state;
  vlFilm *film = make_film(true);
  vlRenderDef def = render_def(VL_TRACER_PATH, 0.9, 1000);
  vlRenderStats stats;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, film, &def, &stats, NULL), VL_OK);
  /* compared at 8; one more that knows nothing of the decision */
  assert_int_equal(stats.spp, 9);
  assert_true(stats.mean_spp == 9 && stats.noisy_blocks == 0);
  def.noise = 1e-9;
  def.spp = 24;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, film, &def, &stats, NULL), VL_OK);
  assert_true(stats.mean_spp == 24 && stats.noisy_blocks > 0);
  vl_film_destroy(film);
}

typedef struct Rows {
  const vlFilm *film;
  uint32_t passes, rows[4];
  uint64_t empty[4]; /* of each pass: pixels of the rows without samples that have a value */
} Rows;

static bool note_rows(void *user, const vlProgress *p) {
  Rows *r = user;
  vlImage *image = NULL;
  if (!p->pass_done || r->passes == 4)
    return true;
  assert_int_equal(vl_film_develop(r->film, NULL, &image), VL_OK);
  const float *pixels = vl_image_const_pixels(image);
  for (size_t i = (size_t)WIDTH * p->rows; i < (size_t)WIDTH * HEIGHT; i++)
    r->empty[r->passes] += pixels[4 * i + 3] != 0.0f;
  vl_image_destroy(image);
  r->rows[r->passes++] = p->rows;
  return true;
}

/* Passes over a part of the rows: the film can be read after each, and ends with the samples
 * of whole passes. */
static void rows(void **state) {
  (void)state;
  vlFilm *parts = make_film(true), *whole = make_film(true);
  Rows seen = {.film = parts};
  vlRenderDef def = render_def(VL_TRACER_PATH, 0, 1);
  assert_int_equal(vl_render(loaded.world, &loaded.camera, whole, &def, NULL, NULL), VL_OK);
  def.pass_rows = 32;
  def.progress = note_rows;
  def.progress_user = &seen;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, parts, &def, NULL, NULL), VL_OK);
  assert_int_equal(seen.passes, 2);
  assert_int_equal(seen.rows[0], 32);
  assert_int_equal(seen.rows[1], HEIGHT);
  assert_int_equal(seen.empty[0], 0);
  assert_int_equal(vl_film_spp(parts), 1);
  def.progress = NULL;
  def.spp = 5; /* the samples 1 to 4 come in passes over parts, too */
  assert_int_equal(vl_render(loaded.world, &loaded.camera, parts, &def, NULL, NULL), VL_OK);
  def.pass_rows = 0;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, whole, &def, NULL, NULL), VL_OK);
  assert_true(same(parts, whole));
  vl_film_destroy(parts);
  vl_film_destroy(whole);
}

static void wrong_defs(void **state) {
  (void)state;
  vlFilm *plain = make_film(false), *film = make_film(true);
  vlError error;
  vlRenderDef def = render_def(VL_TRACER_PATH, 0.1, 4);
  assert_int_equal(vl_render(loaded.world, &loaded.camera, plain, &def, NULL, &error),
                   VL_ERROR_ARGUMENT);
  def.noise = -1;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, film, &def, NULL, &error),
                   VL_ERROR_ARGUMENT);
  def.noise = 0.1;
  def.first_sample = 2;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, film, &def, NULL, &error),
                   VL_ERROR_ARGUMENT);
  def.first_sample = 0;
  def.noise_scale = 0;
  assert_int_equal(vl_render(loaded.world, &loaded.camera, film, &def, NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "noise"));
  vl_film_destroy(plain);
  vl_film_destroy(film);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(filled),
                                     cmocka_unit_test(first_comparison), cmocka_unit_test(rows),
                                     cmocka_unit_test(wrong_defs)};
  return cmocka_run_group_tests(tests, begin, end);
}
