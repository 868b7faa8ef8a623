/* test/render/test_denormals.c: numbers below the smallest normal float are kept
 * (docs/decisions/0024-denormal-numbers.md), in whatever floating-point state the caller's
 * threads are. */
#include "render/shots.h"
#include "velo/shape_kinds.h"
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/* A ball that reflects 5e-39 of a light of 1e36. */
static Image denormal_ball(vlColorMode color) {
  Stage s = stage_open(8, 8);
  s.camera.eye[0] = 3;
  s.camera.eye[1] = 0.5;
  s.camera.eye[2] = 0.2;
  s.camera.lookat[2] = 0;
  s.render.spp = s.render.sequence = 64;
  s.render.max_depth = 3;
  s.build.color = color;
  add_sky(&s, 1e36f);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.material = add_diffuse(&s, 5e-39f, 5e-39f, 5e-39f);
  assert_int_not_equal(vl_scene_add_shape(s.scene, &ball).index, 0);
  return stage_finish(&s);
}

/* A convex body under a uniform sky reflects its albedo times the sky's radiance. */
static void denormal_albedo_is_kept(void **state) {
  (void)state;
  for (int rgb = 0; rgb < 2; rgb++) {
    Image p = denormal_ball(rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL);
    for (int c = 0; c < 3; c++)
      assert_ratio("ball", image_at(&p, 3, 3, c), 5e-3, 0.05);
    image_free(&p);
  }
}

/* Libraries that were compiled with -ffast-math set the mode that makes denormals 0, and
 * threads inherit it. */
static void state_of_the_caller_does_not_count(void **state) {
  (void)state;
#if defined(__SSE__)
  Image a = denormal_ball(VL_COLOR_RGB);
  unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040u);
  Image b = denormal_ball(VL_COLOR_RGB);
  assert_int_equal(_mm_getcsr() & 0x8040u, 0x8040u);
  _mm_setcsr(before);
  assert_true(image_at(&a, 3, 3, 0) > 0);
  assert_memory_equal(a.rgba, b.rgba, 4 * sizeof(float) * 64);
  image_free(&a);
  image_free(&b);
#else
  skip();
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(denormal_albedo_is_kept),
                                     cmocka_unit_test(state_of_the_caller_does_not_count)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
