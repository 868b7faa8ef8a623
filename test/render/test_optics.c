/* test/render/test_optics.c: lenses in images: blur shape, autofocus, natural vignetting; a
 * lens of many elements: field of view, brightness, mechanical vignetting. */
#include "render/shots.h"

#include "velo/focus.h"
#include "velo/projection.h"

/* A bright dot out of focus shows the opening upright: more light below the middle of a
 * triangle's corner than above. */
static void blur_has_the_openings_shape(void **state) {
  (void)state;
  enum { SIDE = 24 };
  for (int k = 0; k < 2; k++) {
    Stage s = stage_open(SIDE, SIDE);
    s.build.color = VL_COLOR_RGB;
    s.render.spp = 8192;
    s.render.max_depth = 0;
    s.camera.fx = s.camera.fy = 60;
    s.camera.lens_radius = 0.4;
    s.camera.focus_distance = k ? 9 : 2;
    s.camera.lens.blades = 3;
    Quad q = quad_at(0, 0, -4, 0.08f, 0, 0, 0, 0.08f, 0);
    q.emission = add_emission(&s, 100, true);
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    double sum = 0, third = 0, second[2] = {0, 0}, mean[2] = {0, 0};
    for (int pass = 0; pass < 2; pass++)
      for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
          double v = image_at(&p, x, y, 1), dx = x + 0.5 - SIDE / 2, dy = y + 0.5 - SIDE / 2;
          if (!pass) {
            sum += v;
            mean[0] += v * dx;
            mean[1] += v * dy;
          } else {
            dx -= mean[0] / sum;
            dy -= mean[1] / sum;
            third += v * dy * dy * dy;
            second[0] += v * dx * dx;
            second[1] += v * dy * dy;
          }
        }
    assert_near("centre of the blur, x", mean[0] / sum, 0, 0.05);
    assert_near("centre of the blur, y", mean[1] / sum, 0, 0.05);
    /* an equilateral triangle, corner up: the mean of (y up)^3 is R^3/40, of x^2 and y^2
     * R^2/8 */
    double r = 0.4 * fabs(1 / 4.0 - (k ? 1 / 9.0 : 1 / 2.0)) * 60;
    double dot = 0.08 / 4 * 60, small = dot * dot / 3 + 1.0 / 12;
    assert_ratio("x of the triangle", second[0] / sum, r * r / 8 + small, 0.02);
    assert_ratio("y of the triangle", second[1] / sum, r * r / 8 + small, 0.02);
    /* behind the plane in focus it is upright (up is negative here), before it upside down */
    assert_ratio("third moment", third / sum, (k ? 1 : -1) * r * r * r / 40, 0.05);
    image_free(&p);
  }
}

/* A camera focused on a pixel equals one focused at that pixel's depth, to the last bit. Walls
 * at depths 3 and 8. */
static void autofocus(void **state) {
  (void)state;
  Image p[2];
  for (int k = 0; k < 2; k++) {
    Stage s = stage_open(48, 32);
    s.camera.lens_radius = 0.2;
    if (k) {
      s.camera.focus_distance = 3;
    } else {
      s.camera.lens.focus_pixel[0] = 8.25;
      s.camera.lens.focus_pixel[1] = 20;
    }
    Quad a = quad_at(-5, 0, -3, 5, 0, 0, 0, 9, 0), b = quad_at(5, 0, -8, 5, 0, 0, 0, 4, 0);
    a.emission = add_emission(&s, 2, true);
    b.emission = add_emission(&s, 1, true);
    add_quad(&s, &a);
    add_quad(&s, &b);
    if (!k) {
      vlWorld *world = NULL;
      vlCamera camera;
      vlError error;
      double distance;
      assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
      assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
      assert_int_equal(vl_autofocus(world, &camera, 8.25, 20, &distance, &error), VL_OK);
      assert_near("distance", distance, 3, 1e-9);
      assert_int_equal(vl_autofocus(world, &camera, 40, 16, &distance, &error), VL_OK);
      assert_near("distance", distance, 8, 1e-9);
      camera.lens.tilt[1] = 0.1; /* a plane that leans: its distance on the axis is another */
      assert_int_equal(vl_autofocus(world, &camera, 40, 20, &distance, &error), VL_OK);
      assert_near("distance", distance, 8 + 0.1 * 8 * 4 / 16, 1e-9);
      camera.lens.tilt[1] = 0;
      camera.near_plane = 3.5; /* cuts the nearer wall away */
      assert_int_equal(vl_autofocus(world, &camera, 8, 16, &distance, &error),
                       VL_ERROR_ARGUMENT);
      assert_non_null(strstr(error.message, "nothing is seen there"));
      assert_int_equal(vl_autofocus(world, &camera, 48.5, 16, &distance, &error),
                       VL_ERROR_ARGUMENT);
      assert_non_null(strstr(error.message, "outside the image"));
      camera.near_plane = 0;
      assert_int_equal(vl_camera_autofocus(world, &camera, &error), VL_OK);
      assert_near("focus", camera.focus_distance, 3, 1e-9);
      assert_true(camera.lens.focus_pixel[0] != camera.lens.focus_pixel[0]);
      vl_world_destroy(world);
    }
    p[k] = stage_finish(&s);
  }
  /* the distance is 3 up to rounding, so some rays differ in their last bit */
  double off = 0;
  for (uint32_t i = 0; i < 48 * 32 * 4; i++)
    off += fabs((double)p[0].rgba[i] - (double)p[1].rgba[i]);
  assert_true(off / (48 * 32 * 4) < 1e-3);
  image_free(&p[0]);
  image_free(&p[1]);
}

static void natural_vignetting(void **state) {
  (void)state;
  Stage s = stage_open(64, 48);
  s.camera.lens.vignetting = true;
  s.render.spp = 64;
  s.render.max_depth = 0;
  Quad q = quad_at(0, 0, -1, 50, 0, 0, 0, 50, 0);
  q.emission = add_emission(&s, 1, true);
  add_quad(&s, &q);
  Image p = stage_finish(&s);
  for (uint32_t y = 0; y < 48; y += 5)
    for (uint32_t x = 0; x < 64; x += 7) {
      double dx = (x + 0.5 - 32) / 24, dy = (y + 0.5 - 24) / 24, c = 1 + dx * dx + dy * dy;
      assert_ratio("cos^4", image_at(&p, x, y, 1), 1 / (c * c), 0.02);
      assert_near("alpha", image_at(&p, x, y, 3), 1, 0);
    }
  image_free(&p);
}

/* A double Gauss lens in front of a bright wall: pi / (4 N^2) of its light in the middle, less
 * in the corners, alpha 1. Against an empty background the barrel is black and opaque. A dot is
 * imaged where the chief ray meets the film. */
static void many_elements(void **state) {
  (void)state;
  vlOpticsDef def = vl_default_optics_def();
  def.aperture_diameter = 6;
  def.focus_distance = 2;
  for (int k = 0; k < 3; k++) {
    Stage s = stage_open(72, 48);
    vlOptics *optics = NULL;
    vlError error = {0};
    if (vl_optics_load(s.context,
                       VELO_SOURCE_DIR "/scenes/cameras/lenses/double_gauss_50mm.dat", &def,
                       &optics, &error) != VL_OK)
      fail_msg("%s", error.message);
    s.camera.projection = VL_PROJECTION_OPTICS;
    s.camera.lens.optics = optics;
    s.render.spp = 256;
    s.render.max_depth = 0;
    vlCamera camera;
    assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
    double dot[3] = {0.3, -0.2, -2}, pixel[2] = {0, 0};
    Quad q = k == 0 ? quad_at(0, 0, -2, 50, 0, 0, 0, 50, 0)
                    : quad_at(0.3f, -0.2f, -2, 0.01f, 0, 0, 0, 0.01f, 0);
    q.emission = add_emission(&s, 1, true);
    if (k < 2)
      add_quad(&s, &q);
    if (k == 2) {
      /* between film and lens: not seen */
      Quad hidden = quad_at(0, 0, -0.02f, 50, 0, 0, 0, 50, 0);
      hidden.emission = add_emission(&s, 9, true);
      add_quad(&s, &hidden);
    }
    assert_true(vl_camera_project(&camera, dot, pixel, NULL));
    Image p = stage_take(&s);
    if (k == 0) {
      vlOpticsInfo info;
      vl_optics_info(optics, &info);
      /* focused near: the working f-number */
      double n = info.f_number * info.rear_principal / info.focal_length;
      assert_ratio("middle", image_at(&p, 36, 24, 1), 3.14159265 / (4 * n * n), 0.05);
      assert_true(image_at(&p, 0, 0, 1) < 0.9 * image_at(&p, 36, 24, 1));
      for (uint32_t i = 0; i < 72 * 48; i++)
        assert_true(p.rgba[4 * i + 3] == 1);
    } else if (k == 1) {
      double sum = 0, mx = 0, my = 0;
      for (uint32_t y = 0; y < 48; y++)
        for (uint32_t x = 0; x < 72; x++) {
          double v = image_at(&p, x, y, 1);
          sum += v;
          mx += v * (x + 0.5);
          my += v * (y + 0.5);
        }
      assert_near("x of the dot", mx / sum, pixel[0], 0.1);
      assert_near("y of the dot", my / sum, pixel[1], 0.1);
      assert_true(pixel[0] > 36 && pixel[1] > 24);      /* right and below */
      assert_true(p.rgba[4 * (24 * 72 + 5) + 3] < 0.3); /* sky but for the barrel */
    } else {
      for (uint32_t i = 0; i < 72 * 48; i++)
        assert_true(p.rgba[4 * i + 1] == 0);
    }
    image_free(&p);
    vl_optics_destroy(optics);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blur_has_the_openings_shape),
      cmocka_unit_test(autofocus),
      cmocka_unit_test(natural_vignetting),
      cmocka_unit_test(many_elements),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
