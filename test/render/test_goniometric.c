/* test_goniometric.c: goniometric and projection lights: their intensity where a formula gives
 * it, the orientation of their images, their power. A wall is at z = -2, camera and light at
 * the origin. */
#include "render/shots.h"

#define PI 3.14159265358979

static vlImage *gradient_image(Stage *s, uint32_t width, uint32_t height) {
  vlImage *image = NULL;
  vlImageDef def = vl_default_image_def(width, height, 3);
  def.type = VL_PIXEL_F32;
  def.encoding = VL_ENCODING_LINEAR;
  assert_int_equal(vl_image_create(s->context, &def, &image), VL_OK);
  return image;
}

static void set(vlImage *image, uint32_t x, uint32_t y, float r, float g, float b) {
  float *at = (float *)vl_image_pixels(image) + 3 * ((size_t)y * vl_image_width(image) + x);
  at[0] = r;
  at[1] = g;
  at[2] = b;
}

static Stage stage(void) {
  Stage s = stage_open(31, 31);
  s.camera.fov = PI / 2;
  s.build.color = VL_COLOR_RGB;
  s.render.spp = 4;
  s.render.max_depth = 1;
  Quad wall = quad_at(0, 0, -2, 40, 0, 0, 0, 40, 0);
  wall.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  add_quad(&s, &wall);
  return s;
}

/* Radiance of the wall at a pixel for intensity 1 towards it. */
static double expected(uint32_t x, uint32_t y) {
  double a = (x + 0.5) / 15.5 - 1, b = (y + 0.5) / 15.5 - 1, l2 = 1 + a * a + b * b;
  return 0.5 / PI / (4 * l2) / sqrt(l2);
}

static void goniometric(void **state) {
  (void)state;
  for (int which = 0; which < 4; which++) { /* all over, above, below, above with a power */
    Stage s = stage();
    vlImage *image = gradient_image(&s, 16, 16);
    for (uint32_t y = 0; y < 16; y++)
      /* the diamond in the middle is the half about the axis */
      for (uint32_t x = 0; x < 16; x++) {
        bool upper = fabs(x + 0.5 - 8) + fabs(y + 0.5 - 8) < 8;
        float v = which == 0 || upper == (which != 2) ? 1 : 0;
        set(image, x, y, 3 * v, 0, 0); /* channels count by their mean */
      }
    vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
    def.image = image;
    if (which == 3)
      def.power = 100;
    /* the light's y to the world's -z */
    const double turn[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
    memcpy(def.world_from_light, turn, sizeof turn);
    assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
    vl_image_destroy(image);
    Image p = stage_finish(&s);
    double upper_share = 0;
    for (int y = 0; y < 16; y++)
      for (int x = 0; x < 16; x++)
        upper_share += (fabs(x + 0.5 - 8) + fabs(y + 0.5 - 8) < 8) / 256.0;
    double intensity = which == 2 ? 0 : which == 3 ? 100 / (4 * PI * upper_share) : 1;
    for (uint32_t k = 0; k < 31; k += 5)
      assert_near("goniometric", image_at(&p, k, 15, 0), intensity * expected(k, 15),
                  0.02 * intensity * expected(k, 15) + 1e-7);
    image_free(&p);
  }
}

static void projection(void **state) {
  (void)state;
  for (int which = 0; which < 3; which++) {
    Stage s = stage();
    uint32_t w = which == 1 ? 40 : 20;
    vlImage *image = gradient_image(&s, w, 20);
    for (uint32_t y = 0; y < 20; y++)
      for (uint32_t x = 0; x < w; x++) {
        if (which == 2)
          set(image, x, y, 1, 1, 1);
        else
          set(image, x, y, x < w / 2 ? 1 : 0, y < 10 ? 1 : 0, 1); /* red left, green above */
      }
    vlLightDef def = vl_default_light_def(VL_LIGHT_PROJECTION);
    def.image = image;
    def.fov = which == 2 ? (float)(PI / 2) : (float)(2 * atan(0.4));
    if (which == 2)
      def.power = 10;
    /* z ahead, to the world's -z; y up; so x goes to the left of one who looks along it, in
     * numbers: -x */
    const double turn[16] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    memcpy(def.world_from_light, turn, sizeof turn);
    assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
    vl_image_destroy(image);
    Image p = stage_finish(&s);
    if (which == 2) { /* a sixth of the sphere */
      for (uint32_t k = 1; k < 30; k += 4)
        assert_ratio("power", image_at(&p, k, 15, 0), 10 / (4 * PI / 6) * expected(k, 15),
                     0.02);
    } else {
      double half = which == 1 ? 0.8 : 0.4;
      for (uint32_t y = 0; y < 31; y++)
        for (uint32_t x = 0; x < 31; x++) {
          double a = (x + 0.5) / 15.5 - 1, b = (y + 0.5) / 15.5 - 1; /* b downwards */
          bool edge = fabs(fabs(a) - half) < 0.04 || fabs(fabs(b) - 0.4) < 0.04 ||
                      fabs(a) < 0.04 || fabs(b) < 0.04;
          if (edge)
            continue;
          bool in = fabs(a) < half && fabs(b) < 0.4;
          double e = expected(x, y);
          /* a world that is mirrored to pbrt's */
          double want[3] = {in && a > 0 ? e : 0, in && b < 0 ? e : 0, in ? e : 0};
          for (int c = 0; c < 3; c++)
            assert_near("slide", image_at(&p, x, y, c), want[c], 0.02 * e);
        }
    }
    image_free(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(goniometric),
                                     cmocka_unit_test(projection)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
