/* test/camera/test_colmap_models.c: the newer camera models of COLMAP. */
#include "camera/cameras.h"

static const double pi = 3.14159265358979323846;

/* RAD_TAN_THIN_PRISM_FISHEYE's k0 to k5, p0 p1, s0 to s3, which are Project Aria's Fisheye624
 * ("Camera Intrinsic Models" of its documentation). The point's direction from the axis is
 * (0.8, -0.6), its angle theta. */
static const double aria[12] = {.4,   -.5,   .35,  -.15, .03,   -.002,
                                .003, -.004, .002, .001, -.003, .002};
static void aria_at(double theta, double at[2]) {
  double r = theta;
  for (int i = 0; i < 6; i++)
    r += aria[i] * pow(theta, 2 * i + 3);
  double u = 0.8 * r, v = -0.6 * r;
  at[0] = u + aria[6] * (2 * u * u + r * r) + 2 * aria[7] * u * v + aria[8] * r * r +
          aria[9] * pow(r, 4);
  at[1] = v + aria[7] * (2 * v * v + r * r) + 2 * aria[6] * u * v + aria[10] * r * r +
          aria[11] * pow(r, 4);
}

/* The models by the formulas of sensor/models.h, at the camera's point (0.4, -0.3, 0.8). */
static void colmap_models_project_by_their_formulas(void **state) {
  (void)state;
  const double point[3] = {0.4, -0.3, 0.8}, rho = 0.5 / 0.8, theta = atan2(0.5, 0.8);
  const double division = 2.0 / (1.0 + sqrt(1.0 + 4.0 * 0.1 * rho * rho)) / 0.8;
  const double eucm = 1.0 / (0.6 * sqrt(1.2 * 0.25 + 0.64) + 0.4 * 0.8);
  const double across = hypot(0.4, 0.8);
  double bent[2];
  aria_at(theta, bent);
  const struct {
    const char *name;
    double parameters[16];
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
       480 * atan2(-0.3, across) / pi},
      {"RAD_TAN_THIN_PRISM_FISHEYE",
       {300, 310, 320, 240, aria[0], aria[1], aria[2], aria[3], aria[4], aria[5], aria[6],
        aria[7], aria[8], aria[9], aria[10], aria[11]},
       16,
       300 * bent[0],
       310 * bent[1]}};
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
    double origin[3], direction[3];
    assert_true(vl_camera_unproject(&c, pixel[0], pixel[1], origin, direction));
    for (int k = 0; k < 3; k++)
      assert_true(fabs(direction[k] - point[k] / sqrt(0.89)) < 1e-12);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(colmap_models_project_by_their_formulas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
