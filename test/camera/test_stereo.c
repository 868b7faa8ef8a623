/* test/camera/test_stereo.c: projections of points in both eyes against formulas written here;
 * omnidirectional stereo in both directions against the published formula, and in the
 * renderer's batches. */
#include <math.h>
#include <string.h>

#include "camera/rays.h"
#include "unit.h"
#include "velo/camera.h"
#include "velo/distortion.h"
#include "velo/projection.h"

static const double pi = 3.14159265358979323846;

static vlCameraDef stereo_def(vlStereoMode mode) {
  vlCameraDef def = vl_default_camera_def(640, 480);
  def.fx = 500;
  def.fy = 510;
  def.cx = 310;
  def.cy = 250;
  def.eye[0] = 0.3;
  def.eye[1] = -0.2;
  def.eye[2] = 1;
  def.lookat[0] = 1;
  def.lookat[1] = 0.5;
  def.lookat[2] = -3;
  def.roll = 0.4;
  def.stereo = (vlStereo){mode, 0.2, mode == VL_STEREO_PARALLEL ? VL_UNSET : 2.5};
  return def;
}

static void to_world(const vlCamera *c, const double local[3], double world[3]) {
  for (int i = 0; i < 3; i++) {
    const double *m = c->world_from_camera + 4 * i;
    world[i] = m[0] * local[0] + m[1] * local[1] + m[2] * local[2] + m[3];
  }
}

static void make_three(const vlCameraDef *def, vlCamera *between, vlCamera eyes[2]) {
  vlError error = {0};
  if (vl_camera_make(def, between, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  if (vl_camera_stereo(def, &eyes[0], &eyes[1], NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static const double points[][3] = {
    {0, 0, 2.5}, {0.7, -0.4, 2.5}, {-0.3, 0.6, 1.2}, {0.2, 0.9, 7}, {-1, -1, 40}};
enum { POINTS = sizeof points / sizeof *points };

static void disparities_are_exact(void **state) {
  (void)state;
  for (int mode = VL_STEREO_PARALLEL; mode <= VL_STEREO_TOE_IN; mode++) {
    vlCameraDef def = stereo_def((vlStereoMode)mode);
    vlCamera between, eyes[2];
    make_three(&def, &between, eyes);
    double b = def.stereo.interocular, meet = def.stereo.convergence;
    for (int i = 0; i < POINTS; i++) {
      const double *p = points[i];
      double world[3], middle[2], pixel[2][2], depth, z[2];
      to_world(&between, p, world);
      assert_true(vl_camera_project(&between, world, middle, &depth));
      for (int e = 0; e < 2; e++)
        assert_true(vl_camera_project(&eyes[e], world, pixel[e], &z[e]));
      double disparity = pixel[0][0] - pixel[1][0], rise = pixel[0][1] - pixel[1][1];
      if (mode != VL_STEREO_TOE_IN) {
        /* d = f b / z; off-axis less by what it is at the screen */
        double expected =
            def.fx * b / p[2] - (mode == VL_STEREO_OFF_AXIS ? def.fx * b / meet : 0.0);
        assert_true(fabs(disparity - expected) < 1e-9);
        assert_true(fabs(rise) < 1e-9); /* no keystone */
        assert_true(fabs(0.5 * (pixel[0][0] + pixel[1][0]) - middle[0]) < 1e-9);
        continue;
      }
      for (int e = 0; e < 2; e++) {
        double side = e ? 0.5 * b : -0.5 * b, angle = atan(0.5 * b / meet) * (e ? -1 : 1);
        double x = (p[0] - side) * cos(angle) - p[2] * sin(angle);
        double away = (p[0] - side) * sin(angle) + p[2] * cos(angle);
        assert_true(fabs(pixel[e][0] - (def.cx + def.fx * x / away)) < 1e-9);
        assert_true(fabs(pixel[e][1] - (def.cy + def.fy * p[1] / away)) < 1e-9);
      }
      if (i == 0)
        assert_true(fabs(disparity) < 1e-9 && fabs(rise) < 1e-9); /* where the axes cross */
      /* the keystone: a corner of the screen is nearer to the eye on its side, and higher
       * there */
      if (i == 1)
        assert_true(fabs(rise) > 0.1);
    }
  }
}

/* The one eye that vl_camera_make gives, and resized; the screen's rectangle is the same for
 * both eyes. */
static void one_eye_and_other_sizes(void **state) {
  (void)state;
  vlCameraDef def = stereo_def(VL_STEREO_OFF_AXIS);
  vlCamera between, eyes[2], one, small[3], eye;
  make_three(&def, &between, eyes);
  for (int e = 0; e < 2; e++) {
    def.stereo_eye = e ? VL_EYE_RIGHT : VL_EYE_LEFT;
    assert_int_equal(vl_camera_make(&def, &one, NULL, NULL), VL_OK);
    assert_memory_equal(&one, &eyes[e], sizeof one);
    assert_int_equal(vl_camera_resize(&eyes[e], 320, 240, &small[e]), VL_OK);
    assert_int_equal(vl_camera_resize(&between, 320, 240, &small[2]), VL_OK);
    assert_int_equal(vl_camera_eye(&small[2], &def.stereo, def.stereo_eye, &eye, NULL), VL_OK);
    assert_true(fabs(eye.cx - small[e].cx) < 1e-12 && fabs(eye.fx - small[e].fx) < 1e-12);
  }
  def.stereo_eye = VL_EYE_BOTH;
  assert_int_equal(vl_camera_eye(&between, &def.stereo, VL_EYE_BOTH, &eye, NULL), VL_OK);
  assert_memory_equal(&eye, &between, sizeof eye);
}

static vlCameraDef panorama(vlProjection kind) {
  bool square = kind == VL_PROJECTION_EQUAL_AREA, cube = kind == VL_PROJECTION_CUBE;
  vlCameraDef def = vl_default_camera_def(square ? 300 : 600, cube ? 100 : 300);
  def.projection = kind;
  def.stereo = (vlStereo){VL_STEREO_OMNIDIRECTIONAL, 0.13, VL_UNSET};
  return def;
}

/* Google, "Rendering Omni-directional Stereo Content" (2015): theta = 2 pi x - pi, phi = pi/2 -
 * pi y; the eye at (cos theta, 0, sin theta) ipd/2, to the right or left; the ray (sin theta
 * cos phi, sin phi, -cos theta cos phi). y up, z back: the default camera's world. */
static void omnidirectional_is_the_published_formula(void **state) {
  (void)state;
  vlCameraDef def = panorama(VL_PROJECTION_EQUIRECTANGULAR);
  vlCamera between, eyes[2];
  make_three(&def, &between, eyes);
  for (int e = 0; e < 2; e++)
    for (int i = 0; i < 500; i++) {
      double u = fmod(0.137 + i * 0.6180339887498949, 1.0), v = 0.01 + 0.98 * (i + 0.5) / 500,
             o[3], d[3];
      double theta = 2 * pi * u - pi, phi = pi / 2 - pi * v, r = e ? 0.065 : -0.065;
      assert_true(vl_camera_unproject(&eyes[e], 600 * u, 300 * v, o, d));
      const double eye[3] = {r * cos(theta), 0, r * sin(theta)},
                   ray[3] = {sin(theta) * cos(phi), sin(phi), -cos(theta) * cos(phi)};
      for (int k = 0; k < 3; k++)
        assert_true(fabs(o[k] - eye[k]) < 1e-14 && fabs(d[k] - ray[k]) < 1e-14);
    }
}

static void omnidirectional_goes_both_ways(void **state) {
  (void)state;
  const vlProjection kinds[] = {VL_PROJECTION_EQUIRECTANGULAR, VL_PROJECTION_CYLINDRICAL,
                                VL_PROJECTION_EQUAL_AREA, VL_PROJECTION_CUBE};
  for (int k = 0; k < 4; k++) {
    vlCameraDef def = panorama(kinds[k]);
    def.eye[0] = 4;
    def.eye[1] = -2;
    def.eye[2] = 0.5;
    def.roll = 0.2;
    vlCamera between, eyes[2];
    make_three(&def, &between, eyes);
    enum { N = 700 };
    static double pixels[2 * N], origins[3 * N], directions[3 * N], places[3 * N], back[2 * N],
        z[N];
    static uint8_t valid[N];
    for (int e = 0; e < 2; e++) {
      const vlCamera *c = &eyes[e];
      for (int i = 0; i < N; i++) {
        pixels[2 * i] = c->width * fmod(0.51 + i * 0.7548776662466927, 1.0);
        pixels[2 * i + 1] = c->height * fmod(0.5 + i * 0.5698402909980532, 1.0);
      }
      vl_camera_unproject_batch(c, N, pixels, origins, directions, valid);
      for (int i = 0; i < N; i++) {
        double o[3], d[3], t = 0.2 + 0.05 * i;
        assert_true(valid[i] && vl_camera_unproject(c, pixels[2 * i], pixels[2 * i + 1], o, d));
        assert_memory_equal(o, origins + 3 * i, sizeof o);
        assert_memory_equal(d, directions + 3 * i, sizeof d);
        /* the eye is on the circle, beside the direction */
        double out[3] = {o[0] - c->world_from_camera[3], o[1] - c->world_from_camera[7],
                         o[2] - c->world_from_camera[11]};
        assert_true(fabs(sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]) - 0.065) <
                    1e-12);
        assert_true(fabs(out[0] * d[0] + out[1] * d[1] + out[2] * d[2]) < 1e-12);
        for (int a = 0; a < 3; a++)
          places[3 * i + a] = o[a] + t * d[a];
      }
      vl_camera_project_batch(c, N, places, back, z, valid);
      for (int i = 0; i < N; i++) {
        double pixel[2], depth;
        assert_true(valid[i] && vl_camera_project(c, places + 3 * i, pixel, &depth));
        assert_memory_equal(pixel, back + 2 * i, sizeof pixel);
        double limit = kinds[k] == VL_PROJECTION_EQUAL_AREA
                           ? 1e-7
                           : 1e-9; /* its corners' derivative has no bound */
        assert_true(fabs(pixel[0] - pixels[2 * i]) < limit &&
                    fabs(pixel[1] - pixels[2 * i + 1]) < limit);
      }
    }
  }
  /* inside the circle there is no eye that sees a point */
  vlCameraDef def = panorama(VL_PROJECTION_EQUIRECTANGULAR);
  vlCamera between, eyes[2];
  make_three(&def, &between, eyes);
  double pixel[2], z;
  const double near[3] = {0.03, 0.5, 0.02}, far[3] = {0.07, 0.5, 0.02};
  assert_false(vl_camera_project(&eyes[0], near, pixel, &z));
  assert_true(vl_camera_project(&eyes[0], far, pixel, &z));
}

/* The floats that images are made with: those of the double functions, on every instruction
 * set. */
static void batches_agree(void **state) {
  (void)state;
  const vlIsa sets[] = {VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4};
  for (int round = 0; round < 4; round++) {
    vlCameraDef def =
        panorama(round & 1 ? VL_PROJECTION_CYLINDRICAL : VL_PROJECTION_EQUIRECTANGULAR);
    if (round & 2) {
      def.lens_radius = 0.01;
      def.focus_distance = 2;
    }
    vlCamera between, eyes[2];
    make_three(&def, &between, eyes);
    enum { N = 320 };
    static float half[N], film[2][N], out[3][10][N];
    static int32_t px[N], py[N];
    for (int i = 0; i < N; i++) {
      half[i] = 0.5f;
      film[0][i] = (float)i / N;
      film[1][i] = 0.25f;
      px[i] = (int32_t)((unsigned)i * 7919u % between.width);
      py[i] = (int32_t)((unsigned)i * 104729u % between.height);
    }
    vlCameraCompiled c;
    vl_camera_compile(&eyes[1], &c);
    for (int k = 0; k < 3; k++) {
      vlIsa got;
      if (vl_isa_choose(sets[k], &got) != VL_OK)
        continue;
      vlCameraSamples samples = {film[0], film[1], px, py, half, half, half};
      vlCameraRays rays = {out[k][0], out[k][1], out[k][2], out[k][3], out[k][4], out[k][5],
                           out[k][6], out[k][7], out[k][8], out[k][9], NULL};
      vl_camera_kernels(sets[k])->rays(&c, N, &samples, &rays);
      assert_memory_equal(out[0], out[k], sizeof out[0]);
    }
    for (int i = 0; i < N; i++) {
      double o[3], d[3]; /* the lens's middle, for its sample is (0.5, 0.5) */
      assert_true(vl_camera_unproject(&eyes[1], px[i] + (double)film[0][i],
                                      py[i] + (double)film[1][i], o, d));
      for (int a = 0; a < 3; a++)
        assert_true(out[0][a][i] == (float)o[a] && out[0][3 + a][i] == (float)d[a]);
    }
  }
}

static void wrong_stereo_is_named(void **state) {
  (void)state;
  vlCamera camera, other;
  vlError error;
#define EXPECT(change, part)                                                          \
  do {                                                                                \
    vlCameraDef def = stereo_def(VL_STEREO_OFF_AXIS);                                 \
    change;                                                                           \
    assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_ERROR_ARGUMENT); \
    assert_non_null(strstr(error.message, part));                                     \
  } while (0)
  EXPECT(def.stereo.convergence = VL_UNSET, "needs the distance where the eyes converge");
  EXPECT(def.stereo.mode = VL_STEREO_PARALLEL, "has no meaning for parallel stereo");
  EXPECT((def.distortion = VL_DISTORTION_RADIAL, def.distortion_count = 1,
          def.distortion_coefficients[0] = 0.1),
         "needs a flat view plane");
  EXPECT((def.stereo.mode = VL_STEREO_OMNIDIRECTIONAL, def.stereo.convergence = VL_UNSET),
         "not with the perspective");
  vlCameraDef def = vl_default_camera_def(8, 8);
  assert_int_equal(vl_camera_stereo(&def, &camera, &other, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "no stereo mode"));
}

static void moving_is_making_elsewhere(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(640, 480);
  def.fx = def.fy = 500;
  def.distortion = VL_DISTORTION_OPENCV;
  def.distortion_count = 4;
  def.distortion_coefficients[0] = -0.2;
  vlCamera here, there, made;
  assert_int_equal(vl_camera_make(&def, &here, NULL, NULL), VL_OK);
  const double pose[16] = {0, 0, 1, 3, 1, 0, 0, -2, 0, 1, 0, 7, 0, 0, 0, 1};
  assert_int_equal(vl_camera_move(&here, pose, &there, NULL), VL_OK);
  def.has_matrix = true;
  memcpy(def.world_from_camera, pose, sizeof pose);
  assert_int_equal(vl_camera_make(&def, &made, NULL, NULL), VL_OK);
  assert_memory_equal(&there, &made, sizeof made);
  vlError error;
  double bad[16];
  memcpy(bad, pose, sizeof bad);
  bad[2] = NAN;
  assert_int_equal(vl_camera_move(&here, bad, &there, &error), VL_ERROR_ARGUMENT);
  assert_memory_equal(&there, &made, sizeof made);
  memset(bad, 0, sizeof bad);
  assert_int_equal(vl_camera_move(&here, bad, &there, &error), VL_ERROR_ARGUMENT);
}

static void the_cross_of_a_cube(void **state) {
  (void)state;
  /* right left up down front back, in cells of 100 pixels; the default camera looks along -z, y
   * up */
  const double axis[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                             {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
  const int cell[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  vlCameraDef def = vl_default_camera_def(400, 300);
  def.projection = VL_PROJECTION_CUBE;
  def.shape[0] = 1;
  vlCamera c, row;
  assert_int_equal(vl_camera_make(&def, &c, NULL, NULL), VL_OK);
  assert_true(fabs(c.outside - 0.5) < 0.02); /* six of twelve cells */
  def = vl_default_camera_def(600, 100);
  def.projection = VL_PROJECTION_CUBE;
  assert_int_equal(vl_camera_make(&def, &row, NULL, NULL), VL_OK);
  for (int face = 0; face < 6; face++) {
    double pixel[2], z, o[3], d[3], e[3];
    assert_true(vl_camera_project(&c, axis[face], pixel, &z));
    assert_true(fabs(pixel[0] - (100 * cell[face][0] + 50)) < 1e-9);
    assert_true(fabs(pixel[1] - (100 * cell[face][1] + 50)) < 1e-9);
    for (int i = 0; i < 100; i++) { /* the faces of the row, elsewhere */
      double u = 100 * fmod(0.3 + 0.7548776662466927 * i, 1.0),
             v = 100 * fmod(0.1 + 0.5698402909980532 * i, 1.0);
      double x = 100 * cell[face][0] + u, y = 100 * cell[face][1] + v;
      assert_true(vl_camera_unproject(&c, x, y, o, d));
      assert_true(vl_camera_unproject(&row, 100 * face + u, v, o, e));
      for (int k = 0; k < 3; k++)
        assert_true(fabs(d[k] - e[k]) < 1e-12);
      assert_true(vl_camera_project(&c, d, pixel, &z));
      assert_true(fabs(pixel[0] - x) < 1e-9 && fabs(pixel[1] - y) < 1e-9);
    }
  }
  /* neighbours meet without a step; the empty cells see nothing */
  double o[3], a[3], b[3];
  assert_true(vl_camera_unproject(&c, 150, 100 - 1e-9, o, a) &&
              vl_camera_unproject(&c, 150, 100 + 1e-9, o, b));
  for (int k = 0; k < 3; k++)
    assert_true(fabs(a[k] - b[k]) < 1e-9);
  const double empty[6][2] = {{50, 50},  {250, 50},  {350, 50},
                              {50, 250}, {250, 250}, {350, 250}};
  for (int i = 0; i < 6; i++)
    assert_false(vl_camera_unproject(&c, empty[i][0], empty[i][1], o, a));
  assert_false(vl_camera_unproject(&c, 450, 150, o, a));
  assert_false(vl_camera_unproject(&c, -50, 150, o, a));
  assert_false(vl_camera_unproject(&c, 950, 50, o, a));
  vlCameraDef wrong = vl_default_camera_def(400, 300);
  vlError error;
  wrong.projection = VL_PROJECTION_CUBE;
  wrong.shape[0] = 0.5;
  assert_int_equal(vl_camera_make(&wrong, &c, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "layout"));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(disparities_are_exact),
                                     cmocka_unit_test(one_eye_and_other_sizes),
                                     cmocka_unit_test(omnidirectional_is_the_published_formula),
                                     cmocka_unit_test(omnidirectional_goes_both_ways),
                                     cmocka_unit_test(batches_agree),
                                     cmocka_unit_test(wrong_stereo_is_named),
                                     cmocka_unit_test(moving_is_making_elsewhere),
                                     cmocka_unit_test(the_cross_of_a_cube)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
