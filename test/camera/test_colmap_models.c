/* test/camera/test_colmap_models.c: the camera models of COLMAP that are no distortion of
 * velo's. */
#include "camera/cameras.h"

static const double pi = 3.14159265358979323846;

/* COLMAP's models without a distortion of velo's, by the formulas of sensor/models.h, at the
 * camera's point (0.4, -0.3, 0.8). */
static void colmap_models_project_by_their_formulas(void **state) {
  (void)state;
  const double point[3] = {0.4, -0.3, 0.8}, rho = 0.5 / 0.8, theta = atan2(0.5, 0.8);
  const double division = 2.0 / (1.0 + sqrt(1.0 + 4.0 * 0.1 * rho * rho)) / 0.8;
  const double eucm = 1.0 / (0.6 * sqrt(1.2 * 0.25 + 0.64) + 0.4 * 0.8);
  const double across = hypot(0.4, 0.8);
  const struct {
    const char *name;
    double parameters[6];
    uint32_t count;
    double x, y;
  } models[] = {
      {"SIMPLE_DIVISION",
       {300, 320, 240, -0.1},
       4,
       300 * 0.4 * division,
       -300 * 0.3 * division},
      {"DIVISION", {300, 310, 320, 240, -0.1}, 5, 300 * 0.4 * division, -310 * 0.3 * division},
      {"SIMPLE_FISHEYE", {300, 320, 240}, 3, 300 * theta * 0.8, -300 * theta * 0.6},
      {"FISHEYE", {300, 310, 320, 240}, 4, 300 * theta * 0.8, -310 * theta * 0.6},
      {"EUCM", {300, 310, 320, 240, 0.6, 1.2}, 6, 300 * 0.4 * eucm, -310 * 0.3 * eucm},
      {"EQUIRECTANGULAR",
       {640, 480},
       2,
       640 * atan2(0.4, 0.8) / (2 * pi),
       480 * atan2(-0.3, across) / pi}};
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
    vlCameraDef d = vl_default_camera_def(640, 480);
    vlCamera c;
    double pixel[2], depth;
    set3(d.lookat, 0, 0, 1);
    set3(d.up, 0, -1, 0);
    assert_int_equal(
        vl_camera_def_colmap(&d, models[i].name, models[i].parameters, models[i].count, NULL),
        VL_OK);
    assert_int_equal(vl_camera_make(&d, &c, NULL, NULL), VL_OK);
    assert_true(vl_camera_project(&c, point, pixel, &depth));
    assert_true(fabs(pixel[0] - 320 - models[i].x) < 1e-9);
    assert_true(fabs(pixel[1] - 240 - models[i].y) < 1e-9);
  }
  vlCameraDef d = vl_default_camera_def(640, 480);
  vlError error;
  const double aria[16] = {240, 240, 320, 240};
  assert_int_equal(vl_camera_def_colmap(&d, "RAD_TAN_THIN_PRISM_FISHEYE", aria, 16, &error),
                   VL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "Fisheye624"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(colmap_models_project_by_their_formulas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
