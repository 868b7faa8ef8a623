/* test/camera/test_camera.c: the camera as a value: descriptions, pose, resizing, projection
 * and unprojection, error messages. */
#include "camera/cameras.h"

#include <stdio.h>

static void round_trip(void **state) {
  (void)state;
  double worst = 0;
  for (int k = 0; k < CAMERA_COUNT; k++) {
    vlCamera camera = camera_of(k);
    uint64_t random = 7;
    for (int i = 0; i < 2000; i++) {
      double x = next_between(&random, -50, camera.width + 50.0),
             y = next_between(&random, -50, camera.height + 50.0);
      double t = exp(next_between(&random, -3, 9));
      double o[3], d[3], p[3], pixel[2], z;
      assert_true(vl_camera_unproject(&camera, x, y, o, d));
      assert_true(fabs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1) < 1e-14);
      for (int a = 0; a < 3; a++)
        p[a] = o[a] + t * d[a];
      assert_true(vl_camera_project(&camera, p, pixel, &z));
      assert_true(z > 0);
      /* far from a far eye the point itself is rounded: allow one bit of its coordinates, seen
       * at its distance */
      double size =
          fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))) + fabs(o[0]) + fabs(o[1]) + fabs(o[2]);
      double blur = camera.projection == VL_PROJECTION_PERSPECTIVE ? camera.fx * size / z
                                                                   : camera.fx * size;
      double error = fmax(fabs(pixel[0] - x), fabs(pixel[1] - y));
      assert_true(error <= 8 * 0x1p-53 * blur + 1e-11);
      if (t > 1 && error > worst && blur < 1e5)
        worst = error;
    }
  }
  assert_true(worst <= 1e-9);
}

static void project_round_trip_is_a_nanopixel(void **state) {
  (void)state;
  /* points within a scene's usual distances: no allowance at all */
  vlCamera camera = camera_of(0);
  uint64_t random = 11;
  for (int i = 0; i < 20000; i++) {
    double x = next_between(&random, 0, 400), y = next_between(&random, 0, 400),
           t = next_between(&random, 1, 5000);
    double o[3], d[3], pixel[2], z;
    assert_true(vl_camera_unproject(&camera, x, y, o, d));
    double p[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
    assert_true(vl_camera_project(&camera, p, pixel, &z));
    assert_true(fabs(pixel[0] - x) <= 1e-9 && fabs(pixel[1] - y) <= 1e-9);
  }
}

static void outside_the_domain(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(100, 100);
  vlCamera camera = make_or_fail(&def); /* at the origin, looking along -z */
  double pixel[2] = {1, 2}, z, o[3], d[3];
  const double behind[3] = {0, 0, 1}, at[3] = {0, 0, 0}, beside[3] = {5, 0, 0},
               nan[3] = {NAN, 0, -1}, ahead[3] = {0, 0, -2};
  const double huge[3] = {1e300, 0, -1e-300};
  assert_false(vl_camera_project(&camera, behind, pixel, &z));
  assert_false(vl_camera_project(&camera, at, pixel, &z));
  assert_false(vl_camera_project(&camera, beside, pixel, &z));
  assert_false(vl_camera_project(&camera, nan, pixel, &z));
  assert_false(vl_camera_project(&camera, huge, pixel, &z));
  assert_true(pixel[0] == 1 && pixel[1] == 2);
  assert_true(vl_camera_project(&camera, ahead, pixel, NULL));
  assert_true(pixel[0] == 50 && pixel[1] == 50);
  assert_false(vl_camera_unproject(&camera, NAN, 0, o, d));
  assert_false(vl_camera_unproject(&camera, 0, INFINITY, o, d));
}

/* Whatever way the same focal length is said in, the camera is the same. */
static void ways_in_agree(void **state) {
  (void)state;
  const double f = 500, w = 640, h = 480;
  vlCameraDef way[10];
  int n = 0;
  for (int i = 0; i < 10; i++)
    way[i] = vl_default_camera_def(640, 480);
  way[n++].fx = f;
  way[n++].fy = f;
  way[n++].view_distance = f;
  way[n].view_distance = 5;
  way[n].zoom = 2;
  way[n++].pixel_size = 0.02;
  way[n].focal_mm = 36 * f / w;
  way[n++].sensor_width_mm = 36;
  way[n].fov = 2 * atan(h / 2 / f);
  way[n++].fov_axis = VL_FOV_VERTICAL;
  way[n].fov = 2 * atan(w / 2 / f);
  way[n++].fov_axis = VL_FOV_HORIZONTAL;
  way[n].fov = 2 * atan(sqrt(w * w + h * h) / 2 / f);
  way[n++].fov_axis = VL_FOV_DIAGONAL;
  way[n].fov = 2 * atan(h / 2 / f);
  way[n++].fov_axis = VL_FOV_SMALLER;
  way[n].fov = 2 * atan(w / 2 / f);
  way[n++].fov_axis = VL_FOV_LARGER;
  assert_int_equal(n, 10);
  vlCameraDef all = way[5];
  for (int i = 0; i < n; i++) {
    vlCamera c = make_or_fail(&way[i]);
    assert_true(fabs(c.fx - f) < 1e-9 && fabs(c.fy - f) < 1e-9 && c.cx == 320 && c.cy == 240 &&
                c.skew == 0);
    if (i != 2 && i < 5) {
      if (i == 0)
        all.fx = f;
      if (i == 1)
        all.fy = f;
      if (i == 3) {
        all.view_distance = 5;
        all.zoom = 2;
        all.pixel_size = 0.02;
      }
      if (i == 4) {
        all.focal_mm = way[4].focal_mm;
        all.sensor_width_mm = 36;
      }
    }
  }
  /* all at once, one of them written with few digits */
  all.fov = RADIANS(51.2820);
  vlCamera c = make_or_fail(&all);
  assert_true(c.fx == f);

  vlCameraDef portrait = vl_default_camera_def(480, 640);
  portrait.fov = 2 * atan(h / 2 / f);
  portrait.fov_axis = VL_FOV_SMALLER;
  assert_true(fabs(make_or_fail(&portrait).fx - f) < 1e-9);
  portrait.fov_axis = VL_FOV_HORIZONTAL;
  assert_true(fabs(make_or_fail(&portrait).fx - f) < 1e-9);
  portrait.fov = 2 * atan(w / 2 / f);
  portrait.fov_axis = VL_FOV_LARGER;
  assert_true(fabs(make_or_fail(&portrait).fx - f) < 1e-9);

  vlCameraDef nothing = vl_default_camera_def(640, 480);
  assert_true(make_or_fail(&nothing).fx == 240); /* 90 degrees across the smaller side */
}

/* A screen window equal to the default one changes nothing. One that is twice as wide halves
 * the focal length. */
static void screen_window(void **state) {
  (void)state;
  vlCameraDef plain = vl_default_camera_def(600, 400), def = plain;
  plain.fov = def.fov = RADIANS(40);
  def.screen_min_x = -1.5;
  def.screen_max_x = 1.5;
  def.screen_min_y = -1;
  def.screen_max_y = 1;
  vlCamera a = make_or_fail(&plain), b = make_or_fail(&def);
  assert_true(fabs(a.fx / b.fx - 1) < 1e-15 && fabs(a.fy / b.fy - 1) < 1e-15 && b.cx == 300 &&
              b.cy == 200);
  def.screen_min_x = 0;
  def.screen_max_x = 6;
  def.screen_min_y = -3;
  def.screen_max_y = 1;
  b = make_or_fail(&def);
  /* the view axis goes through x = 0 (the left side) and y = 0, a quarter from the top */
  assert_true(fabs(a.fx / b.fx - 2) < 1e-15 && fabs(a.fy / b.fy - 2) < 1e-15 && b.cx == 0 &&
              b.cy == 100);
}

static void lecture_basis(void **state) {
  (void)state;
  vlCameraDef def = lecture_def(400, 300);
  vlCamera c = make_or_fail(&def);
  /* the slides, term by term */
  double w[3] = {300, 400, 550}, n = sqrt(300. * 300 + 400. * 400 + 550. * 550);
  for (int i = 0; i < 3; i++)
    w[i] /= n;
  double u[3] = {w[2], 0, -w[0]}; /* (0,1,0) x w */
  n = sqrt(u[0] * u[0] + u[2] * u[2]);
  for (int i = 0; i < 3; i++)
    u[i] /= n;
  double v[3] = {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2],
                 w[0] * u[1] - w[1] * u[0]};
  const double *m = c.world_from_camera;
  for (int i = 0; i < 3; i++) {
    assert_true(fabs(m[4 * i + 0] - u[i]) < 1e-15);
    assert_true(fabs(m[4 * i + 1] + v[i]) < 1e-15); /* y down */
    assert_true(fabs(m[4 * i + 2] + w[i]) < 1e-15); /* z forward */
    assert_true(m[4 * i + 3] == def.eye[i]);
  }
  /* lookat is seen in the middle, at the distance |e - l| */
  double pixel[2], z;
  assert_true(vl_camera_project(&c, def.lookat, pixel, &z));
  assert_true(fabs(pixel[0] - 200) < 1e-10 && fabs(pixel[1] - 150) < 1e-10 &&
              fabs(z - sqrt(552500)) < 1e-10);
}

static void roll_turns_clockwise(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(100, 100);
  def.view_distance = 50;
  def.roll = RADIANS(90);
  vlCamera c = make_or_fail(&def);
  /* the camera turned clockwise by a quarter: its right hand points down, so what is above
   * appears at the left */
  const double above[3] = {0, 1, -5};
  double pixel[2], z;
  assert_true(vl_camera_project(&c, above, pixel, &z));
  assert_true(fabs(pixel[0] - 40) < 1e-12 && fabs(pixel[1] - 50) < 1e-12);
  /* the same through a matrix */
  vlCameraDef matrix = def;
  const double m[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
  matrix.has_matrix = true;
  memcpy(matrix.world_from_camera, m, sizeof m);
  vlCamera d = make_or_fail(&matrix);
  assert_memory_equal(c.world_from_camera, d.world_from_camera, sizeof c.world_from_camera);
}

static void up_parallel_to_the_view(void **state) {
  (void)state;
  const double looks[6][3] = {{0, -1, 0}, {0, 1, 0}, {1, 0, 0},
                              {-1, 0, 0}, {0, 0, 1}, {1, 2, -2}};
  for (int k = 0; k < 6; k++) {
    vlCameraDef def = vl_default_camera_def(100, 100);
    vlCamera c;
    const char *warning = NULL;
    vlError error;
    set3(def.eye, 1, 2, 3);
    for (int i = 0; i < 3; i++) {
      def.lookat[i] = def.eye[i] + looks[k][i];
      def.up[i] = -2 * looks[k][i];
    }
    assert_int_equal(vl_camera_make(&def, &c, &warning, &error), VL_OK);
    assert_non_null(warning);
    assert_int_equal(vl_camera_make(&def, &c, NULL, NULL), VL_OK);
    const double *m = c.world_from_camera;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        double dot = m[a] * m[b] + m[4 + a] * m[4 + b] + m[8 + a] * m[8 + b];
        assert_true(fabs(dot - (a == b)) < 1e-15);
      }
    if (k < 2)
      assert_true(m[0] == 1); /* right stays x, looking down as looking up */
  }
}

static void resize_keeps_the_framing(void **state) {
  (void)state;
  vlCamera c = camera_of(1), twice, square, back;
  assert_int_equal(vl_camera_resize(&c, 1282, 958, &twice), VL_OK);
  assert_true(twice.width == 1282 && twice.height == 958 && twice.fx == 2 * c.fx &&
              twice.fy == 2 * c.fy);
  assert_true(fabs(twice.cx - 2 * c.cx) < 1e-12 && fabs(twice.cy - 2 * c.cy) < 1e-12 &&
              twice.skew == 2 * c.skew);
  assert_int_equal(vl_camera_resize(&twice, 641, 479, &back), VL_OK);
  assert_true(fabs(back.fx - c.fx) < 1e-12 && fabs(back.cx - c.cx) < 1e-12 &&
              fabs(back.cy - c.cy) < 1e-12);
  /* another shape: the smaller side keeps its field of view, as a fov camera made at that
   * size */
  vlCameraDef def = vl_default_camera_def(640, 480);
  def.fov = RADIANS(50);
  c = make_or_fail(&def);
  assert_int_equal(vl_camera_resize(&c, 300, 900, &square), VL_OK);
  def.width = 300;
  def.height = 900;
  vlCamera direct = make_or_fail(&def);
  assert_true(fabs(square.fx - direct.fx) < 1e-11 && square.cx == 150 && square.cy == 450);
  assert_int_equal(vl_camera_resize(&c, 0, 4, &square), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_resize(&c, 4, 1u << 25, &square), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_resize(NULL, 4, 4, &square), VL_ERROR_ARGUMENT);
}

static void orthographic(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(300, 200);
  def.projection = VL_PROJECTION_ORTHOGRAPHIC;
  def.pixel_size = 0.5;
  vlCamera c = make_or_fail(&def);
  double o[3], d[3], pixel[2], z;
  assert_true(vl_camera_unproject(&c, 0.5, 0.5, o, d));
  assert_true(o[0] == -74.75 && o[1] == 49.75 && o[2] == 0 && d[0] == 0 && d[1] == 0 &&
              d[2] == -1);
  /* size does not depend on distance */
  const double near[3] = {10, 5, -1}, far[3] = {10, 5, -1000};
  assert_true(vl_camera_project(&c, near, pixel, &z) && pixel[0] == 170 && pixel[1] == 90 &&
              z == 1);
  assert_true(vl_camera_project(&c, far, pixel, &z) && pixel[0] == 170 && pixel[1] == 90 &&
              z == 1000);
  def.pixel_size = VL_UNSET;
  assert_true(make_or_fail(&def).fy == 100); /* default: -1 to 1 across the smaller side */
}

static void error_messages(void **state) {
  (void)state;
  EXPECT_ERROR(d.cookie = 0, "def.cookie", NULL);
  /* over-determined: both values are named */
  EXPECT_ERROR((d.fov = RADIANS(60), d.view_distance = 500), "fov 60 degrees", "d 500");
  EXPECT_ERROR((d.fov = RADIANS(60), d.fov_axis = VL_FOV_VERTICAL, d.view_distance = 500),
               "415.69", "500");
  EXPECT_ERROR((d.fx = 100, d.fy = 200, d.view_distance = 100), "fy gives", "d 100");
  EXPECT_ERROR((d.focal_mm = 50, d.sensor_width_mm = 36, d.fx = 500), "fx gives",
               "focal_mm 50");
  EXPECT_ERROR((d.cx = 10, d.screen_min_x = -1, d.screen_max_x = 1, d.screen_min_y = -1,
                d.screen_max_y = 1),
               "cx", "screen window");
  EXPECT_ERROR((d.fx = 500, d.fov = RADIANS(53.13), d.fov_axis = VL_FOV_HORIZONTAL), "fx gives",
               "640.0");
  EXPECT_ERROR((d.projection = VL_PROJECTION_ORTHOGRAPHIC, d.fx = 3, d.pixel_size = 0.5), "3",
               "pixel size 0.5");
  /* half a way */
  EXPECT_ERROR(d.zoom = 2, "zoom 2", "view distance");
  EXPECT_ERROR(d.pixel_size = 0.1, "pixel size 0.1", "view distance");
  EXPECT_ERROR(d.focal_mm = 50, "focal_mm", "sensor_width_mm");
  EXPECT_ERROR(d.sensor_width_mm = 50, "sensor_width_mm is given without focal_mm", NULL);
  EXPECT_ERROR(d.screen_min_x = 1, "1 of its 4 sides", NULL);
  EXPECT_ERROR((d.screen_min_x = d.screen_max_x = 1, d.screen_min_y = -1, d.screen_max_y = 1),
               "empty", NULL);
  EXPECT_ERROR((d.projection = VL_PROJECTION_ORTHOGRAPHIC, d.fov = 1), "fov", "orthographic");
  EXPECT_ERROR((d.projection = VL_PROJECTION_ORTHOGRAPHIC, d.zoom = 2), "zoom 2", "pixel size");
  /* ranges */
  EXPECT_ERROR(d.fov = RADIANS(180), "180 degrees", NULL);
  EXPECT_ERROR(d.fov = 0, "fov is 0", NULL);
  EXPECT_ERROR((d.view_distance = 1e300, d.pixel_size = 1e-300), "no finite focal length",
               NULL);
  EXPECT_ERROR(d.view_distance = 1e200, "out of range", NULL);
  /* each number alone is fine, but no ray of the image is */
  EXPECT_ERROR((d.fx = d.fy = 500, d.cy = 1e300), "rays are not finite", "cy 1e+300");
  EXPECT_ERROR((d.eye[0] = 1e39, d.lookat[0] = 2e39), "rays are not finite", "1e+39");
  EXPECT_ERROR((d.projection = VL_PROJECTION_ORTHOGRAPHIC, d.fx = d.fy = 1, d.cy = 1e39),
               "rays are not finite", "cy 1e+39");
  /* pose */
  EXPECT_ERROR((set3(d.eye, 1, 2, 3), set3(d.lookat, 1, 2, 3)),
               "eye and lookat are the same point (1 2 3)", NULL);
  EXPECT_ERROR((d.eye[0] = 1.7e308, d.lookat[0] = -1.7e308), "too far apart", NULL);
  EXPECT_ERROR(set3(d.up, 0, 0, 0), "up is the zero vector", NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[5] = NAN), "not finite", NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[5] = 0), "singular", NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[5] = 1e308), "stretches by 1e+308",
               NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[1] = 1, d.world_from_camera[5] = 0),
               "singular", NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[14] = 1), "last row", NULL);
  /* the rest */
  EXPECT_ERROR(d.shutter_close = -1, "shutter opens at 0", "closes at -1");
  EXPECT_ERROR((d.near_plane = 5, d.far_plane = 5), "far plane 5", NULL);
  /* null arguments; after an error the camera is unchanged */
  vlCameraDef good = vl_default_camera_def(4, 4), bad = good;
  vlCamera c = camera_of(0), before = c;
  bad.fov = -1;
  assert_int_equal(vl_camera_make(&bad, &c, NULL, NULL), VL_ERROR_ARGUMENT);
  assert_memory_equal(&c, &before, sizeof c);
  assert_int_equal(vl_camera_make(NULL, &c, NULL, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_make(&good, NULL, NULL, NULL), VL_ERROR_ARGUMENT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(round_trip),
      cmocka_unit_test(project_round_trip_is_a_nanopixel),
      cmocka_unit_test(outside_the_domain),
      cmocka_unit_test(ways_in_agree),
      cmocka_unit_test(screen_window),
      cmocka_unit_test(lecture_basis),
      cmocka_unit_test(roll_turns_clockwise),
      cmocka_unit_test(up_parallel_to_the_view),
      cmocka_unit_test(resize_keeps_the_framing),
      cmocka_unit_test(orthographic),
      cmocka_unit_test(error_messages),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
