/* test/import/test_cameras.c: further kinds of the Camera directive: pbrt's spherical camera
 * against pbrt's formulas, velo's projections and calibrated lenses with the lecture's
 * parameters. */
#include "import/load.h"
#include "velo/projection.h"

#define W "WorldBegin\nShape \"sphere\"\n"
#define FILM "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 200\n"

static vlCamera camera_of(Loaded *l, const char *text) {
  vlCamera camera;
  vlError error;
  load_fine(l, text);
  if (vl_camera_make(&vl_scene_defs(l->scene)->camera, &camera, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  end_load(l);
  return camera;
}

/* Direction of the film point (x, y), given as fractions of the image, in pbrt's camera space
 * (x right, y up, z forward). The camera is at the origin without a transform. */
static void look(const vlCamera *c, double x, double y, double d[3]) {
  double o[3];
  assert_true(vl_camera_unproject(c, x * c->width, y * c->height, o, d));
}

static void pbrt_spherical(void **state) {
  (void)state;
  const double pi = 3.14159265358979323846;
  Loaded l;
  vlCamera c =
      camera_of(&l, FILM "Camera \"spherical\" \"string mapping\" \"equirectangular\"\n" W);
  for (int i = 0; i < 40; i++)
    for (int j = 0; j < 20; j++) {
      double u = (i + 0.5) / 40, v = (j + 0.5) / 20, theta = pi * v, phi = 2 * pi * u, d[3];
      look(&c, u, v, d);
      assert_true(fabs(d[0] - sin(theta) * cos(phi)) < 1e-12);
      assert_true(fabs(d[1] - cos(theta)) < 1e-12);
      assert_true(fabs(d[2] - sin(theta) * sin(phi)) < 1e-12);
    }
  c = camera_of(&l, FILM "Camera \"spherical\"\n" W);
  assert_int_equal(c.projection, VL_PROJECTION_EQUAL_AREA);
  for (int i = 0; i < 40; i++)
    for (int j = 0; j < 40; j++) {
      /* EqualAreaSquareToSphere, then y and z exchanged (pbrt book 3.8.3 and 5.3) */
      double x = (i + 0.3) / 40, y = (j + 0.7) / 40, u = 2 * x - 1, v = 2 * y - 1, d[3];
      double signed_distance = 1 - (fabs(u) + fabs(v)), r = 1 - fabs(signed_distance);
      double phi = (r == 0 ? 1 : (fabs(v) - fabs(u)) / r + 1) * pi / 4,
             z = copysign(1 - r * r, signed_distance);
      double s = r * sqrt(2 - r * r), a = copysign(cos(phi), u) * s,
             b = copysign(sin(phi), v) * s;
      look(&c, x, y, d);
      assert_true(fabs(d[0] - a) < 1e-12 && fabs(d[1] - z) < 1e-12 && fabs(d[2] - b) < 1e-12);
    }
}

/* A moving one arrives where one stands that does not move. */
static void pbrt_spherical_in_motion(void **state) {
  (void)state;
  static const char *const mappings[] = {"equalarea", "equirectangular"};
  for (int i = 0; i < 2; i++) {
    char moving[400];
    char still[400];
    snprintf(moving, sizeof moving,
             FILM
             "ActiveTransform EndTime Rotate 40 1 2 3 Translate 1 2 3 ActiveTransform All "
             "Camera \"spherical\" \"string mapping\" \"%s\"\n" W,
             mappings[i]);
    snprintf(still, sizeof still,
             FILM
             "Rotate 40 1 2 3 Translate 1 2 3 "
             "Camera \"spherical\" \"string mapping\" \"%s\"\n" W,
             mappings[i]);
    Loaded l;
    vlCamera moved = camera_of(&l, moving);
    vlCamera stands = camera_of(&l, still);
    assert_true(moved.moves);
    for (int k = 0; k < 12; k++)
      assert_float_equal(moved.world_from_camera_close[k], stands.world_from_camera[k], 1e-12);
  }
}

static void kinds(void **state) {
  (void)state;
  const struct {
    const char *text;
    vlProjection projection;
  } cases[] = {
      {"\"fisheye\" \"float fov\" 180", VL_PROJECTION_EQUIDISTANT},
      {"\"fisheye\" \"string mapping\" \"equisolid\" \"float fov\" 220 "
       "\"string fovaxis\" \"diagonal\"",
       VL_PROJECTION_EQUISOLID},
      {"\"fisheye\" \"string mapping\" \"orthographic\"", VL_PROJECTION_SINE},
      {"\"fisheye\" \"string mapping\" \"stereographic\" \"float maxangle\" 80",
       VL_PROJECTION_STEREOGRAPHIC},
      {"\"equirectangular\" \"float longitude\" [-90 90] \"float latitude\" [-30 60]",
       VL_PROJECTION_EQUIRECTANGULAR},
      {"\"equalarea\"", VL_PROJECTION_EQUAL_AREA},
      {"\"cylindrical\" \"float fov\" 200 \"string fovaxis\" \"horizontal\"",
       VL_PROJECTION_CYLINDRICAL},
      {"\"cube\"", VL_PROJECTION_CUBE},
      {"\"panini\" \"float panini\" 0.8 \"float fov\" 150 \"string fovaxis\" \"horizontal\"",
       VL_PROJECTION_PANINI},
      {"\"opencv\" \"float fx\" 300 \"float coefficients\" [-0.2 0.05 0.001 0.002]",
       VL_PROJECTION_PERSPECTIVE},
      {"\"opencvfisheye\" \"float fx\" 100 \"float coefficients\" [0.01 0.005 0 0]",
       VL_PROJECTION_EQUIDISTANT},
      {"\"colmap\" \"string model\" \"FOV\" \"float parameters\" [300 300 200 100 0.8]",
       VL_PROJECTION_FOV},
      {"\"fov\" \"float omega\" 0.8", VL_PROJECTION_FOV},
      {"\"division\" \"float lambda\" -0.2", VL_PROJECTION_DIVISION},
      {"\"unified\" \"float xi\" 0.9 \"float fx\" 250 \"float coefficients\" [-0.1 0.01 0 0]",
       VL_PROJECTION_UNIFIED},
      {"\"eucm\" \"float alpha\" 0.6 \"float beta\" 1.1 \"float fov\" 170", VL_PROJECTION_EUCM},
      {"\"doublesphere\" \"float xi\" -0.2 \"float alpha\" 0.6 \"float fov\" 190",
       VL_PROJECTION_DOUBLE_SPHERE},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[400];
    Loaded l;
    snprintf(
        text, sizeof text,
        FILM
        "Camera %s \"point3 eye\" [1 2 3] \"point3 lookat\" [1 2 -9] \"float lensradius\" 0.1 "
        "\"float focusdistance\" 3\n" W,
        cases[i].text);
    vlCamera c = camera_of(&l, text);
    assert_int_equal(c.projection, cases[i].projection);
    assert_true(c.lens_radius == 0.1);
    double pixel[2], z;
    const double ahead[3] = {1.001, 2, 2};
    assert_true(vl_camera_project(&c, ahead, pixel, &z));
    if (c.projection == VL_PROJECTION_EQUIRECTANGULAR) {
      assert_true(fabs(pixel[0] - 200) < 1 && fabs(pixel[1] - 200 * 60 / 90.0) < 1e-9);
    } else if (c.projection != VL_PROJECTION_CUBE) {
      assert_true(fabs(pixel[0] - 200) < 1 && pixel[0] > 200 && fabs(pixel[1] - 100) < 1e-3);
    }
  }
}

static void stereo_and_the_cross(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, FILM
            "Camera \"pinhole\" \"string stereo\" \"off-axis\" \"float interocular\" 0.2 "
            "\"float convergence\" 4 \"string stereoeye\" \"left\"\n" W);
  const vlCameraDef *def = &vl_scene_defs(l.scene)->camera;
  assert_true(def->stereo.mode == VL_STEREO_OFF_AXIS && def->stereo_eye == VL_EYE_LEFT);
  assert_true(def->stereo.interocular == (double)0.2f || def->stereo.interocular == 0.2);
  assert_true(def->stereo.convergence == 4);
  end_load(&l);
  vlCamera c = camera_of(&l, FILM "Camera \"cube\" \"string layout\" \"cross\"\n" W);
  assert_true(c.shape[0] == 1 && fabs(c.fx - c.width / 4.0) < 1e-9 &&
              fabs(c.fy - c.height / 3.0) < 1e-9);
}

static void warnings_and_errors(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            FILM "Camera \"opencv\" \"float fx\" 100 \"float coefficients\" [-0.4 0 0 0]\n" W);
  assert_non_null(strstr(l.log, "t.pbrt:2:1"));
  assert_non_null(strstr(l.log, "folds"));
  assert_non_null(strstr(l.log, "% of it sees nothing"));
  end_load(&l);
  const struct {
    const char *text, *said;
  } wrong[] = {
      {"\"opencv\" \"float coefficients\" [1 2 3]", "3 OpenCV distortion coefficients"},
      {"\"opencv\" \"float coefficients\" [1 2 3 4 5 6 7 8 9 0 1 2 3 4 5]",
       "15 numbers; at most 14"},
      {"\"opencv\" \"float coeficients\" [1 2 3 4]", "coefficients"},
      {"\"colmap\" \"string model\" \"OPENCVV\" \"float parameters\" [1 2 3 4]",
       "the nearest is \"OPENCV\""},
      {"\"unified\"", "needs its xi"},
      {"\"fisheye\" \"string mapping\" \"equidistance\"", "equidistant"},
      {"\"fish\"", "fish"},
      {"\"cylindrical\" \"float panini\" 1", "panini"},
      {"\"opencv\" \"float fx\" 0", "\"fx\" must be a number above 0; it is 0"},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char text[400];
    snprintf(text, sizeof text, FILM "Camera %s\n" W, wrong[i].text);
    load_text(&l, text, false);
    if (l.result == VL_OK || !strstr(l.error.message, wrong[i].said) || l.error.line != 2)
      fail_msg("%s: line %u \"%s\" should speak of \"%s\"", wrong[i].text, l.error.line,
               l.error.message, wrong[i].said);
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pbrt_spherical),
      cmocka_unit_test(pbrt_spherical_in_motion),
      cmocka_unit_test(kinds),
      cmocka_unit_test(stereo_and_the_cross),
      cmocka_unit_test(warnings_and_errors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
