/* test/camera/test_vanishing.c: long parallel lines converge to their vanishing points; random
 * cameras are recovered from their vanishing points; the horizon; impossible points are
 * rejected. */
#include "camera/cameras.h"

#include "velo/distortion.h"
#include "velo/projection.h"
#include "velo/vanishing.h"

static vlCameraDef random_def(uint64_t *seed) {
  vlCameraDef d = vl_default_camera_def(640, 480);
  set3(d.eye, next_between(seed, -9, 9), next_between(seed, -9, 9), next_between(seed, -9, 9));
  set3(d.lookat, next_between(seed, -9, 9), next_between(seed, -9, 9),
       next_between(seed, -9, 9));
  d.roll = next_between(seed, -3, 3);
  d.fx = d.fy = next_between(seed, 200, 2000);
  d.cx = next_between(seed, 0, 640);
  d.cy = next_between(seed, 0, 480);
  return d;
}

static const double up[3] = {0, 1, 0};

/* A point far along a line of that direction, through any place, is drawn where the line
 * vanishes. */
static void test_lines_meet(void **state) {
  (void)state;
  uint64_t seed = 3;
  static const vlProjection kinds[] = {VL_PROJECTION_PERSPECTIVE, VL_PROJECTION_EQUIDISTANT,
                                       VL_PROJECTION_STEREOGRAPHIC,
                                       VL_PROJECTION_EQUIRECTANGULAR, VL_PROJECTION_PANINI};
  int met = 0;
  for (int n = 0; n < 1000; n++) {
    vlCameraDef d = random_def(&seed);
    d.projection = kinds[n % 5];
    if (d.projection != VL_PROJECTION_PERSPECTIVE)
      d.fx = d.fy = next_between(&seed, 50, 200);
    if (n % 10 == 0) { /* a lens that bends, too */
      static const double k[4] = {-0.1, 0.01, 1e-3, -1e-3};
      d.distortion = VL_DISTORTION_OPENCV;
      d.distortion_count = 4;
      memcpy(d.distortion_coefficients, k, sizeof k);
      d.skew = 3.0;
    }
    vlCamera c;
    assert_int_equal(vl_camera_make(&d, &c, NULL, NULL), VL_OK);
    double direction[3], point[3], p[2], z;
    for (int i = 0; i < 3; i++)
      direction[i] = next_between(&seed, -1, 1);
    vlVanishingPoint v;
    assert_true(vl_camera_vanishing_point(&c, direction, &v));
    if (v.kind != VL_VANISHING_FINITE)
      continue;
    for (int i = 0; i < 3; i++)
      point[i] = next_between(&seed, -1, 1) + (v.behind ? -1e9 : 1e9) * direction[i];
    if (!vl_camera_project(&c, point, p, &z))
      continue;
    met++;
    assert_float_equal(p[0], v.pixel[0], 1e-5 * (1 + fabs(v.pixel[0])));
    assert_float_equal(p[1], v.pixel[1], 1e-5 * (1 + fabs(v.pixel[1])));
  }
  assert_true(met > 700);
}

/* One-, two-, three-point perspective as the lecture draws them. */
static void test_kinds(void **state) {
  (void)state;
  vlCameraDef d = vl_default_camera_def(400, 400);
  vlVanishingPoints v;
  set3(d.eye, 0, 0, 10);
  set3(d.lookat, 0, 0, 0);
  d.view_distance = 400;
  vlCamera c = make_or_fail(&d);
  assert_true(vl_camera_vanishing_points(&c, up, &v));
  assert_int_equal(v.finite, 1);
  assert_int_equal(v.axes[0].kind, VL_VANISHING_INFINITE);
  assert_true(v.axes[0].direction[0] == 1.0 && v.axes[0].direction[1] == 0.0);
  assert_true(v.axes[1].direction[0] == 0.0 && v.axes[1].direction[1] == -1.0);
  assert_true(v.axes[2].pixel[0] == 200.0 && v.axes[2].pixel[1] == 200.0 && v.axes[2].behind);
  assert_true(v.has_horizon && v.horizon[0] == 0.0 && v.horizon[1] == -1.0 &&
              v.horizon[2] == 200.0);
  set3(d.eye, 7, 0, 10); /* level: two points, on the horizon */
  c = make_or_fail(&d);
  assert_true(vl_camera_vanishing_points(&c, up, &v));
  assert_int_equal(v.finite, 2);
  assert_int_equal(v.axes[1].kind, VL_VANISHING_INFINITE);
  set3(d.eye, 7, 7, 7); /* property 6: an equilateral triangle round the middle */
  c = make_or_fail(&d);
  assert_true(vl_camera_vanishing_points(&c, up, &v));
  assert_int_equal(v.finite, 3);
  for (int i = 0; i < 3; i++) {
    double x = v.axes[i].pixel[0] - 200, y = v.axes[i].pixel[1] - 200;
    assert_float_equal(sqrt(x * x + y * y), 400 * sqrt(2.0), 1e-9);
  }
  d.eye[0] = d.eye[2] = 0.0; /* straight down: no horizon */
  c = (vlCamera){0};
  assert_int_equal(vl_camera_make(&d, &c, NULL, NULL), VL_OK);
  assert_true(vl_camera_vanishing_points(&c, up, &v));
  assert_false(v.has_horizon);
  assert_int_equal(v.finite, 1);
  d.projection = VL_PROJECTION_ORTHOGRAPHIC;
  d.view_distance = VL_UNSET;
  assert_int_equal(vl_camera_make(&d, &c, NULL, NULL), VL_OK);
  assert_true(vl_camera_vanishing_points(&c, up, &v));
  assert_int_equal(v.finite, 0);
  assert_int_equal(v.axes[1].kind, VL_VANISHING_NONE);
  assert_int_equal(v.axes[0].kind, VL_VANISHING_INFINITE);
  const double zero[3] = {0, 0, 0};
  vlVanishingPoint point;
  assert_false(vl_camera_vanishing_point(&c, zero, &point));
}

/* Vanishing points of level directions lie on the horizon; the sky is on its positive side. */
static void test_horizon(void **state) {
  (void)state;
  uint64_t seed = 9;
  for (int n = 0; n < 300; n++) {
    vlCameraDef d = random_def(&seed);
    d.skew = 2.0;
    d.fy = 1.3 * d.fx;
    vlCamera c = make_or_fail(&d);
    vlVanishingPoints v;
    double tilted[3];
    for (int i = 0; i < 3; i++)
      tilted[i] = next_between(&seed, -1, 1);
    assert_true(vl_camera_vanishing_points(&c, tilted, &v));
    if (!v.has_horizon)
      continue;
    double across[3] = {tilted[1], -tilted[0], 0}, o[3], r[3];
    vlVanishingPoint p;
    assert_true(vl_camera_vanishing_point(&c, across, &p));
    if (p.kind != VL_VANISHING_FINITE)
      continue;
    double at = v.horizon[0] * p.pixel[0] + v.horizon[1] * p.pixel[1] + v.horizon[2];
    assert_float_equal(at, 0.0, 1e-9 * (1000 + fabs(p.pixel[0]) + fabs(p.pixel[1])));
    double x = next_between(&seed, 0, 640), y = next_between(&seed, 0, 480);
    assert_true(vl_camera_unproject(&c, x, y, o, r));
    bool sky = r[0] * tilted[0] + r[1] * tilted[1] + r[2] * tilted[2] > 0.0;
    assert_int_equal(v.horizon[0] * x + v.horizon[1] * y + v.horizon[2] > 0.0, sky);
  }
}

static void same_camera(const vlCameraDef *before, const vlCameraDef *after) {
  vlCamera a = make_or_fail(before), b = make_or_fail(after);
  assert_float_equal(b.fx, a.fx, 1e-9 * a.fx);
  assert_float_equal(b.fy, a.fy, 1e-9 * a.fx);
  assert_float_equal(b.cx, a.cx, 1e-9 * a.fx);
  assert_float_equal(b.cy, a.cy, 1e-9 * a.fx);
  for (int i = 0; i < 12; i++)
    if (i % 4 != 3)
      assert_float_equal(b.world_from_camera[i], a.world_from_camera[i], 1e-9);
}

/* Any two or three of the axes, in any order. */
static void test_there_and_back(void **state) {
  (void)state;
  uint64_t seed = 17;
  int three = 0;
  for (int n = 0; n < 3000; n++) {
    vlCameraDef d = random_def(&seed), back;
    vlCamera c = make_or_fail(&d);
    vlVanishingPoints v;
    vlError error;
    assert_true(vl_camera_vanishing_points(&c, up, &v));
    vlVanishingDef def = vl_default_vanishing_def(640, 480);
    bool near_enough = true; /* far points carry few digits of the camera */
    for (int i = 0; i < 3; i++) {
      def.axes[i] = (uint32_t)(n % 2 ? (i + n) % 3 : (n + 3 - i) % 3);
      def.away[i] = !v.axes[def.axes[i]].behind;
      memcpy(def.points[i], v.axes[def.axes[i]].pixel, sizeof def.points[i]);
      near_enough = near_enough && v.axes[def.axes[i]].kind == VL_VANISHING_FINITE &&
                    fabs(c.camera_from_world[8 + def.axes[i]]) > 0.05;
    }
    if (!near_enough)
      continue;
    three++;
    def.count = 3;
    if (vl_camera_from_vanishing_points(&def, &back, &error) != VL_OK)
      fail_msg("%s", error.message);
    same_camera(&d, &back);
    def.count = 2;
    def.cx = d.cx;
    def.cy = d.cy;
    if (vl_camera_from_vanishing_points(&def, &back, &error) != VL_OK)
      fail_msg("%s", error.message);
    same_camera(&d, &back);
  }
  assert_true(three > 1500);
}

static void wrong(const vlVanishingDef *def, const char *words) {
  vlCameraDef d;
  vlError error;
  assert_int_equal(vl_camera_from_vanishing_points(def, &d, &error), VL_ERROR_ARGUMENT);
  if (!strstr(error.message, words))
    fail_msg("%s", error.message);
  assert_null(strchr(error.message, '\n'));
}

static void test_wrong(void **state) {
  (void)state;
  vlVanishingDef def = vl_default_vanishing_def(640, 480);
  def.points[0][0] = 900;
  def.points[0][1] = 240;
  def.points[1][0] = 700;
  def.points[1][1] = 240;
  wrong(&def, "less than 90 degrees apart"); /* both right of the centre */
  def.points[1][0] = 320;
  wrong(&def, "less than 90 degrees apart");
  def.count = 3;
  def.points[1][0] = -500;
  def.points[2][0] = 0;
  def.points[2][1] = 240;
  wrong(&def, "on one line");
  def.points[2][0] = 900;
  wrong(&def, "on one line"); /* the same twice */
  def.points[2][0] = 890;
  def.points[2][1] = 250;
  wrong(&def, "less than 90 degrees"); /* an obtuse triangle */
  def.points[2][0] = 300;
  def.points[2][1] = NAN;
  wrong(&def, "number 3 is not finite");
  def.points[2][1] = 2000;
  def.cx = 320;
  def.cy = 20;
  wrong(&def, "is given");
  def.cy = VL_UNSET;
  wrong(&def, "principal point");
  def.cx = VL_UNSET;
  def.axes[2] = def.axes[0];
  wrong(&def, "same axis");
  def.count = 1;
  wrong(&def, "needs 2 or 3");
  def.cookie = 0;
  wrong(&def, "def.cookie");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lines_meet), cmocka_unit_test(test_kinds),
      cmocka_unit_test(test_horizon), cmocka_unit_test(test_there_and_back),
      cmocka_unit_test(test_wrong)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
