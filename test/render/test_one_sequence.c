/* test/render/test_one_sequence.c: a sample depends on the length of the sequence, not on the
 * planned number of samples. So a film that is continued, rendered in parts, or rendered for a
 * given time equals the film of a single render. */
#include "loaded.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

#define ONE(kind, name) +1
enum { SIDE = 24, TRACERS = VL_TRACER_KINDS(ONE), SAMPLERS = VL_SAMPLER_KINDS(ONE) };
static Loaded loaded;

static int begin(void **state) {
  (void)state;
  return !load_world(&loaded, "features/two_way.pbrt", SIDE, SIDE);
}

static int end(void **state) {
  (void)state;
  unload_world(&loaded);
  return 0;
}

static vlFilm *make_film(void) {
  vlFilmDef def = vl_default_film_def(SIDE, SIDE);
  vlFilm *film;
  def.errors = true;
  assert_int_equal(vl_film_create(loaded.context, &def, &film), VL_OK);
  return film;
}

static vlResult render(vlFilm *film, vlRenderDef def, uint32_t spp) {
  def.spp = spp;
  return vl_render(loaded.world, &loaded.camera, film, &def, NULL, NULL);
}

static bool same(const vlFilm *a, const vlFilm *b) {
  vlImage *images[2][2] = {{NULL, NULL}, {NULL, NULL}};
  const vlFilm *films[2] = {a, b};
  bool equal = vl_film_spp(a) == vl_film_spp(b);
  for (int i = 0; i < 2; i++) {
    assert_int_equal(vl_film_develop(films[i], NULL, &images[0][i]), VL_OK);
    assert_int_equal(vl_film_errors(films[i], NULL, &images[1][i]), VL_OK);
  }
  for (int k = 0; k < 2; k++) {
    size_t size = (size_t)SIDE * SIDE * vl_image_channels(images[k][0]) * sizeof(float);
    equal = equal && memcmp(vl_image_const_pixels(images[k][0]),
                            vl_image_const_pixels(images[k][1]), size) == 0;
    vl_image_destroy(images[k][0]);
    vl_image_destroy(images[k][1]);
  }
  return equal;
}

/* Renders to `stop` samples and continues to `all`. Returns whether the film equals one
 * rendered to `all` at once. */
static bool continues(vlRenderDef def, uint32_t stop, uint32_t all) {
  vlFilm *parts = make_film(), *whole = make_film();
  assert_int_equal(render(parts, def, stop), VL_OK);
  assert_int_equal(vl_film_spp(parts), stop);
  assert_int_equal(render(parts, def, all), VL_OK);
  assert_int_equal(render(whole, def, all), VL_OK);
  bool equal = same(parts, whole);
  vl_film_destroy(parts);
  vl_film_destroy(whole);
  return equal;
}

static void each_tracer_continues(void **state) {
  (void)state;
  for (int tracer = 0; tracer < TRACERS; tracer++) {
    vlRenderDef def = vl_default_render_def();
    def.tracer = (vlTracer)tracer;
    if (!continues(def, 2, 7))
      fail_msg("tracer %d", tracer);
  }
}

/* For samplers that divide the sequence into cells, the length is that of the first render. A
 * single render must be given the same length. */
static void each_sampler_continues(void **state) {
  (void)state;
  for (int sampler = 0; sampler < SAMPLERS; sampler++) {
    vlRenderDef def = vl_default_render_def();
    def.sampler = (vlSamplerKind)sampler;
    bool open = sampler == VL_SAMPLER_INDEPENDENT || sampler == VL_SAMPLER_HALTON ||
                sampler == VL_SAMPLER_SOBOL || sampler == VL_SAMPLER_ZSOBOL;
    if (continues(def, 3, 9) != open)
      fail_msg("sampler %d", sampler);
    def.sequence = 3;
    if (!continues(def, 3, 9) || !continues(def, 5, 9))
      fail_msg("sampler %d of length 3", sampler);
  }
}

static void another_length_is_refused(void **state) {
  (void)state;
  vlFilm *film = make_film();
  vlRenderDef def = vl_default_render_def();
  def.sequence = 64;
  assert_int_equal(render(film, def, 2), VL_OK);
  def.sequence = 32;
  assert_int_equal(render(film, def, 3), VL_ERROR_ARGUMENT);
  def.sequence = 0;
  assert_int_equal(render(film, def, 3), VL_OK);
  vl_film_clear(film);
  def.sequence = 32;
  assert_int_equal(render(film, def, 3), VL_OK);
  vl_film_destroy(film);
}

static void a_time_limit_is_the_samples_it_reached(void **state) {
  (void)state;
  vlFilm *timed = make_film(), *counted = make_film();
  vlRenderDef def = vl_default_render_def();
  def.time_limit = 0.1;
  assert_int_equal(render(timed, def, 1 << 20), VL_OK);
  def.time_limit = 0;
  assert_int_equal(render(counted, def, vl_film_spp(timed)), VL_OK);
  assert_true(same(timed, counted));
  vl_film_destroy(timed);
  vl_film_destroy(counted);
}

static void a_later_first_sample_is_another_image(void **state) {
  (void)state;
  vlFilm *early = make_film(), *late = make_film();
  vlRenderDef def = vl_default_render_def();
  assert_int_equal(render(early, def, 2), VL_OK);
  def.first_sample = 2;
  assert_int_equal(render(late, def, 4), VL_OK);
  assert_int_equal(vl_film_spp(late), 2);
  assert_false(same(early, late));
  vl_film_destroy(early);
  vl_film_destroy(late);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_tracer_continues),
                                     cmocka_unit_test(each_sampler_continues),
                                     cmocka_unit_test(another_length_is_refused),
                                     cmocka_unit_test(a_time_limit_is_the_samples_it_reached),
                                     cmocka_unit_test(a_later_first_sample_is_another_image)};
  return cmocka_run_group_tests(tests, begin, end);
}
