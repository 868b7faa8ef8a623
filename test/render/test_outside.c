/* test/render/test_outside.c: pixels without a camera ray are black with alpha 0, under a sky
 * and inside a closed room. Within the image circle the image is as without the limit. */
#include "render/shots.h"
#include "velo/distortion.h"
#include "velo/projection.h"
#include "velo/shape_kinds.h"

static void image_circle(void **state) {
  (void)state;
  for (int closed = 0; closed < 2; closed++) {
    Stage s = stage_open(48, 48);
    s.camera.projection = closed ? VL_PROJECTION_PERSPECTIVE : VL_PROJECTION_EQUIDISTANT;
    if (closed) { /* r (1 - 0.4 r^2) reaches no further than 0.6086 */
      s.camera.fx = 30;
      s.camera.distortion = VL_DISTORTION_RADIAL;
      s.camera.distortion_count = 1;
      s.camera.distortion_coefficients[0] = -0.4;
    }
    add_sky(&s, 1);
    if (closed) {
      vlShapeDef room = vl_default_shape_def(VL_SHAPE_SPHERE);
      room.radius = 5;
      room.z_min = -5;
      room.z_max = 5;
      room.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
      assert_int_not_equal(vl_scene_add_shape(s.scene, &room).index, 0);
    }
    s.render.spp = 4;
    Image p = stage_finish(&s);
    double radius = closed ? 30 * 0.60858 : 24;
    for (uint32_t y = 0; y < 48; y++)
      for (uint32_t x = 0; x < 48; x++) {
        double r = hypot(x + 0.5 - 24, y + 0.5 - 24);
        if (r > radius + 0.75)
          for (int c = 0; c < 4; c++)
            assert_true(image_at(&p, x, y, c) == 0);
        if (r < radius - 0.75 && closed)
          assert_near("alpha", image_at(&p, x, y, 3), 1, 1e-6);
        if (r < radius - 0.75 && !closed)
          assert_true(image_at(&p, x, y, 1) > 0);
      }
    image_free(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(image_circle)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
