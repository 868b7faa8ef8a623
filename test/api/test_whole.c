/* test/api/test_whole.c: the whole pipeline through the public API: the same bits for any
 * number of threads, instruction set, crop and split into calls; cancellation; a failure of
 * every single allocation. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "api/small_world.h"
#include "failing_allocator.h"
#include "unit.h"

static vlImage *take_image(vlContext *context, uint32_t spp, const uint32_t crop[4],
                           vlColorMode color) {
  vlRenderDef render = vl_default_render_def();
  render.spp = spp;
  vlImage *image = NULL;
  assert_int_equal(small_image(context, &render, crop, color, &image), VL_OK);
  return image;
}

static vlContext *make_context(uint32_t threads, vlIsa isa) {
  vlContextDef def = vl_default_context_def();
  def.threads = threads;
  def.isa = isa;
  vlContext *context = NULL;
  vlResult result = vl_context_create(&def, &context);
  if (result == VL_ERROR_UNSUPPORTED)
    return NULL;
  assert_int_equal(result, VL_OK);
  return context;
}

static size_t size_of(const vlImage *image) {
  assert_int_equal(vl_image_type(image), VL_PIXEL_F32);
  return (size_t)vl_image_width(image) * vl_image_height(image) * vl_image_channels(image) *
         sizeof(float);
}

static void the_same_bits_everywhere(void **state) {
  (void)state;
  for (int color = VL_COLOR_SPECTRAL; color <= VL_COLOR_RGB; color++) {
    vlContext *first = make_context(1, VL_ISA_BASE);
    vlImage *reference = take_image(first, 4, NULL, (vlColorMode)color);
    double sum = 0;
    for (uint32_t i = 0; i < SMALL_WIDTH * SMALL_HEIGHT; i++) {
      float value = vl_image_get(reference, i % SMALL_WIDTH, i / SMALL_WIDTH, 1);
      assert_true(isfinite(value));
      sum += value;
    }
    assert_true(sum > 1);
    static const struct {
      uint32_t threads;
      vlIsa isa;
    } runs[] = {
        {2, VL_ISA_BASE}, {3, VL_ISA_V3}, {8, VL_ISA_V4}, {1, VL_ISA_V4}, {1, VL_ISA_V3}};
    for (unsigned i = 0; i < sizeof runs / sizeof *runs; i++) {
      vlContext *context = make_context(runs[i].threads, runs[i].isa);
      if (!context)
        continue;
      vlImage *image = take_image(context, 4, NULL, (vlColorMode)color);
      assert_memory_equal(vl_image_const_pixels(image), vl_image_const_pixels(reference),
                          size_of(reference));
      vl_image_destroy(image);
      vl_context_destroy(context);
    }
    vl_image_destroy(reference);
    vl_context_destroy(first);
  }
}

static void a_crop_is_a_cut(void **state) {
  (void)state;
  vlContext *context = make_context(2, VL_ISA_AUTO);
  vlImage *whole = take_image(context, 2, NULL, VL_COLOR_SPECTRAL);
  static const uint32_t crops[][4] = {
      {0, 0, 1, 1}, {7, 5, 24, 29}, {39, 29, 40, 30}, {0, 13, 40, 14}};
  for (unsigned i = 0; i < 4; i++) {
    const uint32_t *c = crops[i];
    vlImage *cut = take_image(context, 2, c, VL_COLOR_SPECTRAL);
    assert_int_equal(vl_image_width(cut), c[2] - c[0]);
    assert_int_equal(vl_image_height(cut), c[3] - c[1]);
    for (uint32_t y = c[1]; y < c[3]; y++)
      for (uint32_t x = c[0]; x < c[2]; x++)
        for (uint32_t k = 0; k < vl_image_channels(cut); k++)
          assert_true(vl_image_get(cut, x - c[0], y - c[1], k) == vl_image_get(whole, x, y, k));
    vl_image_destroy(cut);
  }
  vl_image_destroy(whole);
  vl_context_destroy(context);
}

/* 1, then 3, then 8 samples into one film are the 8 of one call. */
static void passes_may_be_split(void **state) {
  (void)state;
  vlContext *context = make_context(2, VL_ISA_AUTO);
  vlImage *at_once = take_image(context, 8, NULL, VL_COLOR_SPECTRAL), *in_parts = NULL;
  vlBuildDef build = vl_default_build_def();
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlCamera camera;
  vlError error;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  small_scene(scene);
  assert_int_equal(vl_world_build(scene, &build, &world, &error), VL_OK);
  vl_scene_destroy(scene);
  assert_int_equal(small_camera(&camera), VL_OK);
  vlDevelopDef develop = vl_default_develop_def();
  vlFilmDef film_def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_OK);
  vlRenderDef render = vl_default_render_def();
  render.spp = 8; /* the sampler is the one of 8 samples; time ends the first calls */
  assert_int_equal(vl_film_spp(film), 0);
  render.time_limit = 1e-9;
  for (int calls = 0; vl_film_spp(film) < 8 && calls < 20; calls++) {
    uint32_t before = vl_film_spp(film);
    assert_int_equal(vl_render(world, &camera, film, &render, NULL, &error), VL_OK);
    assert_true(vl_film_spp(film) > before);
  }
  assert_int_equal(vl_film_spp(film), 8);
  assert_int_equal(vl_film_develop(film, &develop, &in_parts), VL_OK);
  assert_memory_equal(vl_image_const_pixels(in_parts), vl_image_const_pixels(at_once),
                      size_of(at_once));
  vl_image_destroy(in_parts);
  vl_image_destroy(at_once);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_context_destroy(context);
}

typedef struct Stopper {
  uint32_t stop_at;
  uint32_t last;
  bool went_back;
  double fraction;
} Stopper;
static bool stop(void *user, const vlProgress *progress) {
  Stopper *stopper = user;
  if (progress->spp_done < stopper->last || progress->fraction < stopper->fraction - 1e-9)
    stopper->went_back = true;
  stopper->last = progress->spp_done;
  stopper->fraction = progress->fraction;
  return !(progress->pass_done && progress->spp_done >= stopper->stop_at);
}

static void a_render_can_be_stopped(void **state) {
  (void)state;
  vlContext *context = make_context(2, VL_ISA_AUTO);
  Stopper stopper = {.stop_at = 1};
  vlRenderDef render = vl_default_render_def();
  render.spp = 64;
  render.progress = stop;
  render.progress_user = &stopper;
  vlImage *image = NULL;
  assert_int_equal(small_image(context, &render, NULL, VL_COLOR_SPECTRAL, &image),
                   VL_CANCELLED);
  assert_non_null(image); /* whole passes are kept */
  assert_true(stopper.last >= 1 && stopper.last < 64);
  assert_false(stopper.went_back);
  vl_image_destroy(image);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* Memory runs out at the 1st, 2nd, 3rd ... call. */
static void memory_may_run_out_anywhere(void **state) {
  (void)state;
  vlRenderDef render = vl_default_render_def();
  render.spp = 1;
  long n = 1, refused = 0;
  for (;; n += 1 + n / 40) {
    failAllocator allocator = {.fail_at = n};
    vlContextDef def = vl_default_context_def();
    def.threads = 2;
    def.allocator = fail_allocator(&allocator);
    vlContext *context = NULL;
    vlImage *image = NULL;
    vlResult result = vl_context_create(&def, &context);
    if (result == VL_OK) {
      result = small_image(context, &render, NULL, VL_COLOR_RGB, &image);
      vl_image_destroy(image);
      vl_context_destroy(context);
    }
    if (allocator.refused)
      refused++;
    assert_int_equal(result, allocator.refused ? VL_ERROR_MEMORY : VL_OK);
    assert_int_equal(allocator.blocks, 0);
    if (!allocator.refused)
      break;
  }
  assert_true(refused > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_same_bits_everywhere),    cmocka_unit_test(a_crop_is_a_cut),
      cmocka_unit_test(passes_may_be_split),         cmocka_unit_test(a_render_can_be_stopped),
      cmocka_unit_test(memory_may_run_out_anywhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
