/* test/render/test_frames.c: one film for many images: after clearing, it gives the same image
 * as a new film. */
#include <math.h>
#include <string.h>

#include "unit.h"
#include "velo/load.h"
#include "velo/render.h"

static vlContext *context;
static vlWorld *world;

static int begin(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  vlScene *scene = NULL;
  vlError error;
  def.threads = 2;
  if (vl_context_create(&def, &context) != VL_OK || vl_scene_create(context, &scene) != VL_OK)
    return 1;
  vlResult result =
      vl_scene_load(scene, VELO_SOURCE_DIR "/scenes/cameras/perspective.pbrt", NULL, &error);
  if (result == VL_OK)
    result = vl_world_build(scene, NULL, &world, &error);
  vl_scene_destroy(scene);
  return result != VL_OK;
}

static int end(void **state) {
  (void)state;
  vl_world_destroy(world);
  vl_context_destroy(context);
  return 0;
}

static vlCamera camera_at(double x) {
  vlCameraDef def = vl_default_camera_def(50, 40);
  vlCamera camera;
  def.eye[0] = x;
  def.eye[1] = 1.2;
  def.lookat[0] = x;
  def.lookat[1] = 1.2;
  assert_int_equal(vl_camera_make(&def, &camera, NULL, NULL), VL_OK);
  return camera;
}

static vlFilm *make_film(bool errors) {
  vlFilmDef def = vl_default_film_def(50, 40);
  vlFilm *film;
  def.crop[0] = 3;
  def.crop[3] = 37;
  def.errors = errors;
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  return film;
}

static vlImage *image(vlFilm *film, double x, uint32_t spp, bool errors) {
  vlCamera camera = camera_at(x);
  vlRenderDef def = vl_default_render_def();
  vlImage *image;
  def.spp = spp;
  assert_int_equal(vl_render(world, &camera, film, &def, NULL, NULL), VL_OK);
  assert_int_equal(
      errors ? vl_film_errors(film, NULL, &image) : vl_film_develop(film, NULL, &image), VL_OK);
  return image;
}

static void same(const vlImage *a, const vlImage *b) {
  assert_memory_equal(
      vl_image_const_pixels(a), vl_image_const_pixels(b),
      (size_t)vl_image_width(a) * vl_image_height(a) * vl_image_channels(a) * sizeof(float));
}

static void a_cleared_film_is_new(void **state) {
  (void)state;
  for (int errors = 0; errors < 2; errors++)
    for (uint32_t first = 1; first < 5; first++)
      for (uint32_t then = 2; then < 5; then++) {
        vlFilm *old = make_film(errors), *fresh = make_film(errors);
        vlImage *before = image(old, -1.5, first, errors);
        vl_film_clear(old);
        assert_int_equal(vl_film_spp(old), 0);
        vlImage *a = image(old, 1, then, errors), *b = image(fresh, 1, then, errors);
        same(a, b);
        vl_image_destroy(before);
        vl_image_destroy(a);
        vl_image_destroy(b);
        vl_film_destroy(old);
        vl_film_destroy(fresh);
      }
}

/* After the first image no more memory is allocated: the tenth image holds as much as the
 * second. */
static void frames_take_no_memory(void **state) {
  (void)state;
  vlFilm *film = make_film(false);
  size_t held = 0;
  for (int i = 0; i < 10; i++) {
    vl_film_clear(film);
    vl_image_destroy(image(film, 0.1 * i, 1, false));
    if (i == 1)
      held = vl_context_memory(context, NULL);
    if (i > 1)
      assert_int_equal(vl_context_memory(context, NULL), held);
  }
  vl_film_destroy(film);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_cleared_film_is_new),
                                     cmocka_unit_test(frames_take_no_memory)};
  return cmocka_run_group_tests(tests, begin, end);
}
