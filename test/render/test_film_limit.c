/* test_film_limit.c: vlFilmDef.max_component: samples above the limit are scaled down as a
 * whole, others are unchanged. */
#include "render/shots.h"

static Image sky(float radiance, float max, vlColorMode mode) {
  Stage s = stage_open(8, 8);
  s.build.color = mode;
  s.render.spp = 64;
  s.film.max_component = max;
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = vl_spectrum_rgb(radiance, radiance, radiance);
  vl_scene_add_light(s.scene, &def);
  return stage_finish(&s);
}

static void limits(void **state) {
  (void)state;
  Image p = sky(10, 2, VL_COLOR_RGB);
  /* white of D65 has Z = 1.089 Y */
  for (int c = 0; c < 3; c++)
    assert_ratio("limited", image_mean(&p, c), 2 / 1.08883, 1e-3);
  image_free(&p);
  p = sky(10, 0, VL_COLOR_RGB);
  assert_true(image_mean(&p, 1) == 0);
  image_free(&p);
  for (int mode = 0; mode < 2; mode++) {
    Image a = sky(1, INFINITY, (vlColorMode)mode), b = sky(1, 1e6f, (vlColorMode)mode);
    assert_memory_equal(a.rgba, b.rgba, sizeof(float) * 4 * 64);
    image_free(&a);
    image_free(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(limits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
