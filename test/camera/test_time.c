/* test/camera/test_time.c: time in cameras: exact sampling of the shutter curve (chi-square),
 * read-out times of rows, rays of a moving camera against the camera held at their time,
 * rejected values. */
#include "camera/cameras.h"

#include "camera/rays.h"
#include "statistics.h"
#include "velo/projection.h"

enum { N = 1024 };
static float film[2][N], lens[2][N], when[N], out[10][N];
static int32_t pixel[2][N];

static void run(vlIsa isa, const vlCamera *camera) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  vlCameraSamples s = {film[0], film[1], pixel[0], pixel[1], lens[0], lens[1], when};
  vlCameraRays r = {.ox = out[0],
                    .oy = out[1],
                    .oz = out[2],
                    .dx = out[3],
                    .dy = out[4],
                    .dz = out[5],
                    .t_min = out[6],
                    .t_max = out[7],
                    .time = out[8],
                    .valid = out[9]};
  vl_camera_kernels(isa)->rays(&c, N, &s, &r);
}

static void draw(const vlCamera *camera, uint64_t seed) {
  for (int i = 0; i < N; i++) {
    pixel[0][i] = (int32_t)(next_unit(&seed) * camera->width);
    pixel[1][i] = (int32_t)(next_unit(&seed) * camera->height);
    for (int k = 0; k < 2; k++) {
      film[k][i] = 0.5f;
      lens[k][i] = (float)next_unit(&seed) * 0.999f;
    }
    when[i] = (float)next_unit(&seed) * 0.99999994f;
  }
}

static double curve_at(const vlCameraDef *d, double x) {
  for (uint32_t i = 1; i < d->shutter_points; i++) {
    double a = d->shutter_at[i - 1], b = d->shutter_at[i];
    if (x < a || x > b || a == b)
      continue;
    return d->shutter_value[i - 1] +
           (d->shutter_value[i] - d->shutter_value[i - 1]) * (x - a) / (b - a);
  }
  return 0;
}

static void set_curve(vlCameraDef *d, uint32_t n, const double *at_value) {
  d->shutter_points = n;
  for (uint32_t i = 0; i < n; i++) {
    d->shutter_at[i] = at_value[2 * i];
    d->shutter_value[i] = at_value[2 * i + 1];
  }
}

static const double triangle[] = {0, 0, 0.5, 1, 1, 0},
                    trapezoid[] = {0, 0, 0.2, 3, 0.7, 3, 1, 0},
                    jumps[] = {0.1, 0, 0.1, 2, 0.3, 2, 0.3, 0, 0.5, 0, 0.5, 1, 0.9, 5},
                    flash[] = {0, 1, 0.49, 1, 0.49, 80, 0.51, 80, 0.51, 1, 1, 1};
static const struct {
  uint32_t n;
  const double *points;
} curves[] = {{3, triangle}, {4, trapezoid}, {7, jumps}, {6, flash}};

static void curves_are_sampled_exactly(void **state) {
  (void)state;
  enum { CELLS = 50 };
  for (size_t k = 0; k < sizeof curves / sizeof *curves; k++) {
    vlCameraDef def = vl_default_camera_def(64, 48);
    def.shutter_open = 3;
    def.shutter_close = 5;
    set_curve(&def, curves[k].n, curves[k].points);
    vlCamera camera = make_or_fail(&def);
    double seen[CELLS] = {0}, expected[CELLS], area = 0;
    for (int i = 0; i < CELLS; i++) {
      expected[i] = 0;
      for (int j = 0; j < 1000; j++)
        expected[i] += curve_at(&def, (i + (j + 0.5) / 1000) / CELLS);
      area += expected[i];
    }
    int total = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
      draw(&camera, 100 * k + seed);
      run(VL_ISA_BASE, &camera);
      for (int i = 0; i < N; i++) {
        double share = ((double)out[8][i] - 3) / 2;
        assert_true(share >= 0 && share <= 1);
        int cell = (int)(share * CELLS);
        seen[cell < CELLS ? cell : CELLS - 1]++;
        total++;
      }
    }
    double chi2 = 0;
    int degrees = -1;
    for (int i = 0; i < CELLS; i++) {
      double want = expected[i] / area * total;
      if (want < 5) {
        assert_true(seen[i] < 25);
        continue;
      }
      chi2 += (seen[i] - want) * (seen[i] - want) / want;
      degrees++;
    }
    double p = stat_gamma_q(0.5 * degrees, 0.5 * chi2);
    if (p < 1e-4)
      fail_msg("curve %zu: chi-square %g with %d degrees of freedom, p = %g", k, chi2, degrees,
               p);
    /* and back: the share of light before a time is what was drawn */
    for (int i = 0; i < 100; i++) {
      double u = (i + 0.5) / 100, t = (vl_camera_time(&camera, 0, 0, u) - 3) / 2, light = 0;
      for (int j = 0; j < 20000; j++)
        light += t * curve_at(&def, t * (j + 0.5) / 20000) / 20000;
      assert_true(fabs(light / (area / 1000 / CELLS) - u) < 1e-3);
    }
  }
}

static void rows_are_read_in_turn(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    vlCameraDef def = vl_default_camera_def(64, 48);
    def.shutter_open = 10;
    def.shutter_close = 10.25;
    def.readout = 4;
    def.readout_direction = (vlReadout)k;
    vlCamera camera = make_or_fail(&def);
    draw(&camera, (uint64_t)k);
    run(VL_ISA_V3 <= vl_isa_best() ? VL_ISA_V3 : VL_ISA_BASE, &camera);
    for (int i = 0; i < N; i++) {
      int x = pixel[0][i], y = pixel[1][i];
      double late = k == 0   ? y / 48.0
                    : k == 1 ? (47 - y) / 48.0
                    : k == 2 ? x / 64.0
                             : (63 - x) / 64.0;
      double want = 10 + 4 * late + 0.25 * (double)when[i];
      assert_true(fabs((double)out[8][i] - want) < 2e-6);
      assert_true(fabs(vl_camera_time(&camera, x + 0.3, y + 0.7, (double)when[i]) - want) <
                  1e-12);
    }
  }
}

/* The second pose is a matrix, or a second eye; a second eye beside a first matrix is refused.
 */
static void second_poses(void **state) {
  (void)state;
  vlCameraDef eyes = vl_default_camera_def(64, 48), mixed = eyes, wrong = eyes;
  vlCamera a, b, there;
  vlError error;
  set3(eyes.eye, 1, 2, 3);
  set3(eyes.lookat, 0, 0.5, -4);
  eyes.roll = 0.3;
  mixed = eyes;
  set3(eyes.eye_close, 1.5, 1, 3.2);
  vlCameraDef at_end = eyes;
  memcpy(at_end.eye, eyes.eye_close, sizeof at_end.eye);
  set3(at_end.eye_close, VL_UNSET, VL_UNSET, VL_UNSET);
  assert_int_equal(vl_camera_make(&at_end, &there, NULL, &error), VL_OK);
  mixed.has_matrix_close = true;
  memcpy(mixed.world_from_camera_close, there.world_from_camera,
         sizeof mixed.world_from_camera_close);
  assert_int_equal(vl_camera_make(&eyes, &a, NULL, &error), VL_OK);
  assert_int_equal(vl_camera_make(&mixed, &b, NULL, &error), VL_OK);
  assert_true(a.moves && b.moves);
  for (int i = 0; i < 16; i++)
    assert_true(fabs(a.world_from_camera_close[i] - b.world_from_camera_close[i]) < 1e-15);
  wrong.has_matrix = true;
  memcpy(wrong.world_from_camera, there.world_from_camera, sizeof wrong.world_from_camera);
  set3(wrong.eye_close, 1, 1, 1);
  assert_int_equal(vl_camera_make(&wrong, &a, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "give world_from_camera_close"));
}

static vlCameraDef moving_def(int k) {
  vlCameraDef def = vl_default_camera_def(640, 480);
  set3(def.eye, 1, 2, 3);
  set3(def.lookat, 0, 0.5, -4);
  set3(def.eye_close, 1.5, 1, 3.2);
  set3(def.lookat_close, 3, 0.1, -4);
  def.roll_close = 0.4;
  def.shutter_open = 2;
  def.shutter_close = 2.5;
  def.readout = k == 1 ? 0.5 : 0;
  def.fov = 0.8;
  def.near_plane = 0.5;
  def.far_plane = 30;
  if (k == 2) {
    def.projection = VL_PROJECTION_EQUIDISTANT;
    def.fov = 3;
  }
  if (k == 3) {
    def.projection = VL_PROJECTION_ORTHOGRAPHIC;
    def.fov = VL_UNSET;
  }
  if (k == 4)
    set_curve(&def, 4, trapezoid);
  if (k == 5) {
    def.pose_times[0] = 2.2;
    def.pose_times[1] = 2.3;
  } /* rests before and after */
  return def;
}

/* Each ray is that of the camera held at its time; the same bits on every instruction set. */
static void rays_are_those_of_held_cameras(void **state) {
  (void)state;
  for (int k = 0; k < 6; k++) {
    vlCameraDef def = moving_def(k);
    vlCamera camera = make_or_fail(&def), held;
    assert_true(camera.moves);
    draw(&camera, 77 + (uint64_t)k);
    run(VL_ISA_BASE, &camera);
    for (int i = 0; i < N; i++) {
      double o[3], d[3], t = vl_camera_time(&camera, pixel[0][i], pixel[1][i], (double)when[i]);
      assert_int_equal(vl_camera_at(&camera, t, &held), VL_OK);
      assert_false(held.moves);
      bool seen = vl_camera_unproject(&held, pixel[0][i] + 0.5, pixel[1][i] + 0.5, o, d);
      assert_int_equal(seen, out[9][i] > 0);
      if (!seen)
        continue;
      for (int c = 0; c < 3; c++) {
        assert_true(fabs(o[c] - (double)out[c][i]) < 4e-7);
        assert_true(fabs(d[c] - (double)out[3 + c][i]) < 1.3e-7);
      }
      double near_point[3], film_point[2], z;
      for (int c = 0; c < 3; c++)
        near_point[c] = o[c] + (double)out[6][i] * d[c];
      assert_true(vl_camera_project(&held, near_point, film_point, &z));
      if (k != 2)
        assert_true(fabs(z - 0.5) < 1e-6);
    }
    static float first[10][N];
    memcpy(first, out, sizeof out);
    for (int set = 1; set < 3 && (vlIsa)(VL_ISA_V2 + set) <= vl_isa_best(); set++) {
      run((vlIsa)(VL_ISA_V2 + set), &camera);
      assert_memory_equal(first, out, sizeof out);
    }
  }
}

static void matrices_travel_too(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(32, 32);
  vlCamera still = make_or_fail(&def), moving, held, moved;
  const double a[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
               b[16] = {0, -1, 0, 4, 1, 0, 0, 2, 0, 0, 1, 0, 0, 0, 0, 1}, times[2] = {1, 3};
  vlError error;
  assert_int_equal(vl_camera_travel(&still, a, b, times, &moving, &error), VL_OK);
  assert_int_equal(vl_camera_at(&moving, 2, &held), VL_OK);
  const double half = sqrt(0.5), *m = held.world_from_camera;
  assert_true(fabs(m[0] - half) < 1e-14 && fabs(m[1] + half) < 1e-14 && fabs(m[3] - 2) < 1e-14);
  assert_int_equal(vl_camera_at(&moving, 99, &held), VL_OK);
  assert_memory_equal(held.world_from_camera, b, sizeof b);
  assert_int_equal(vl_camera_move(&moving, a, &moved, &error), VL_OK);
  assert_false(moved.moves);
  vlStereo stereo = {VL_STEREO_PARALLEL, 0.2, VL_UNSET};
  assert_int_equal(vl_camera_eye(&moving, &stereo, VL_EYE_RIGHT, &moved, &error), VL_OK);
  /* its right is the world's y there */
  assert_true(fabs(moved.world_from_camera_close[7] - 2.1) < 1e-14);
  assert_int_equal(vl_camera_at(&moving, NAN, &held), VL_ERROR_ARGUMENT);
}

static void nonsense_is_refused(void **state) {
  (void)state;
  for (int k = 0; k < 9; k++) {
    vlCameraDef def = vl_default_camera_def(32, 32);
    if (k == 0)
      def.readout = -1;
    if (k == 1)
      def.readout = NAN;
    if (k == 2)
      def.readout_direction = (vlReadout)7;
    if (k == 3)
      set_curve(&def, 3, (double[]){0, 1, 0.6, 1, 0.5, 1});
    if (k == 4)
      set_curve(&def, 2, (double[]){0, 0, 1, 0});
    if (k == 5)
      set_curve(&def, 2, (double[]){0, -1, 1, 1});
    if (k == 6)
      def.shutter_points = 17;
    if (k == 7)
      set3(def.eye_close, 0, 0, -1); /* where it looks */
    if (k == 8) {
      def.has_matrix = def.has_matrix_close = true;
      def.world_from_camera_close[0] = -1;
    }
    vlCamera camera;
    vlError error;
    assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "camera: "));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_are_sampled_exactly),
      cmocka_unit_test(rows_are_read_in_turn),
      cmocka_unit_test(rays_are_those_of_held_cameras),
      cmocka_unit_test(matrices_travel_too),
      cmocka_unit_test(second_poses),
      cmocka_unit_test(nonsense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
