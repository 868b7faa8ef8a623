/* test/camera/test_moments.c: projection of moving cameras and rolling shutters: it agrees with
 * the camera held at the row's time, and with the rays of unproject; which row is taken where
 * several or none see a point; Jacobians. */
#include "camera/cameras.h"
#include "camera/context.h"

#include "camera/parts.h"
#include "camera/small_motion.h"
#include "velo/distortion.h"
#include "velo/jacobian.h"
#include "velo/projection.h"

enum { CAMERAS = 40, POINTS = 25, COLUMNS = VL_JACOBIAN_COLUMNS };

static const vlProjection kinds[] = {VL_PROJECTION_PERSPECTIVE, VL_PROJECTION_ORTHOGRAPHIC,
                                     VL_PROJECTION_EQUIDISTANT, VL_PROJECTION_STEREOGRAPHIC,
                                     VL_PROJECTION_EQUIRECTANGULAR};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* Moves and turns, and reads in any direction. rolls: the readout in seconds; the motion takes
 * two. */
static vlCamera moving_camera(vlProjection kind, double readout, double speed,
                              uint64_t *random) {
  vlCameraDef d = vl_default_camera_def(64, 48);
  d.projection = kind;
  if (kind == VL_PROJECTION_ORTHOGRAPHIC)
    d.fx = d.fy = 8;
  else if (kind != VL_PROJECTION_EQUIRECTANGULAR)
    d.fx = d.fy = next_between(random, 30, 60);
  if (kind == VL_PROJECTION_PERSPECTIVE && next_unit(random) < 0.5) {
    d.distortion = VL_DISTORTION_OPENCV;
    d.distortion_count = 5;
    d.distortion_coefficients[0] = next_between(random, -0.1, 0.1);
    d.distortion_coefficients[2] = next_between(random, -0.01, 0.01);
  }
  d.shutter_open = next_between(random, -3, 3);
  d.shutter_close = d.shutter_open + 0.1;
  d.readout = readout;
  d.readout_direction = (vlReadout)(4 * next_unit(random));
  d.pose_times[0] = d.shutter_open - 0.5;
  d.pose_times[1] = d.shutter_open + 1.5;
  d.has_matrix = d.has_matrix_close = true;
  vlCameraDef from = d, to = d;
  from.has_matrix = to.has_matrix = false;
  from.has_matrix_close = to.has_matrix_close = false;
  for (int k = 0; k < 3; k++) {
    from.eye[k] = next_between(random, -1, 1);
    to.eye[k] = from.eye[k] + speed * next_between(random, -1, 1);
    from.lookat[k] = from.eye[k] + next_between(random, -1, 1);
    to.lookat[k] =
        to.eye[k] + from.lookat[k] - from.eye[k] + speed * next_between(random, -0.3, 0.3);
  }
  from.roll = next_between(random, -3, 3);
  to.roll = from.roll + speed * next_between(random, -0.3, 0.3);
  vlCamera a = make_or_fail(&from), b = make_or_fail(&to);
  memcpy(d.world_from_camera, a.world_from_camera, sizeof a.world_from_camera);
  memcpy(d.world_from_camera_close, b.world_from_camera, sizeof b.world_from_camera);
  return make_or_fail(&d);
}

/* Written out anew: the time of a film point, linear between the rows' centres. */
static double time_of(const vlCamera *c, double x, double y) {
  double begin = c->shutter_open + 0.5 * (c->shutter_close - c->shutter_open);
  double w = c->width, h = c->height;
  x = fmin(fmax(x, 0), w);
  y = fmin(fmax(y, 0), h);
  switch (c->readout_direction) {
    case VL_READOUT_DOWN:
      return begin + (y - 0.5) / h * c->readout;
    case VL_READOUT_UP:
      return begin + (h - 0.5 - y) / h * c->readout;
    case VL_READOUT_RIGHT:
      return begin + (x - 0.5) / w * c->readout;
    case VL_READOUT_LEFT:
      return begin + (w - 0.5 - x) / w * c->readout;
  }
  return 0;
}

static void near(double a, double b, double tolerance, const char *what) {
  if (!(fabs(a - b) <= tolerance))
    fail_msg("%s: %.17g and %.17g", what, a, b);
}

static void agrees_with_the_held_camera(void **state) {
  (void)state;
  uint64_t random = 3;
  int seen = 0, outside = 0;
  for (int k = 0; k < KINDS * CAMERAS; k++) {
    vlCamera c = moving_camera(kinds[k % KINDS], k % 3 ? 0.9 : 0, 1, &random);
    double pixels[2 * POINTS], points[3 * POINTS], films[2 * POINTS], depths[POINTS];
    double origins[3 * POINTS], rays[3 * POINTS];
    uint8_t valid[POINTS], answered[POINTS];
    for (int i = 0; i < POINTS; i++) {
      double *q = pixels + 2 * i, *p = points + 3 * i, o[3] = {0}, d[3] = {0}, ho[3], hd[3];
      double z, film[2] = {0}, held_film[2];
      bool far = kinds[k % KINDS] != VL_PROJECTION_EQUIRECTANGULAR && i % 5 == 0;
      q[0] = next_between(&random, far ? -0.3 : 0.1, far ? 1.3 : 0.9) * c.width;
      q[1] = next_between(&random, far ? -0.3 : 0.1, far ? 1.3 : 0.9) * c.height;
      bool good = vl_camera_unproject(&c, q[0], q[1], o, d);
      vlCamera held;
      assert_int_equal(vl_camera_at(&c, time_of(&c, q[0], q[1]), &held), VL_OK);
      assert_int_equal(vl_camera_unproject(&held, q[0], q[1], ho, hd), good);
      for (int a = 0; a < 3; a++) {
        p[a] = o[a] + next_between(&random, 1, 4) * d[a];
        if (good) {
          near(o[a], ho[a], 1e-13, "origin");
          near(d[a], hd[a], 1e-13, "direction");
        }
      }
      /* the point as some row sees it */
      if (!vl_camera_project(&c, p, film, &z))
        continue;
      assert_int_equal(vl_camera_at(&c, time_of(&c, film[0], film[1]), &held), VL_OK);
      assert_true(vl_camera_project(&held, p, held_film, &z));
      near(film[0], held_film[0], 1e-9, "film x");
      near(film[1], held_film[1], 1e-9, "film y");
      assert_true(vl_camera_unproject(&c, film[0], film[1], o, d));
      double along = 0, off = 0;
      for (int a = 0; a < 3; a++)
        along += (p[a] - o[a]) * d[a];
      for (int a = 0; a < 3; a++)
        off = fmax(off, fabs(o[a] + along * d[a] - p[a]));
      near(off, 0, 1e-9, "distance of the ray from the point");
      seen++;
      outside += film[0] < 0 || film[1] < 0 || film[0] > c.width || film[1] > c.height;
    }
    vl_camera_project_batch(&c, POINTS, points, films, depths, valid);
    vl_camera_unproject_batch(&c, POINTS, pixels, origins, rays, answered);
    for (int i = 0; i < POINTS; i++) { /* the same bits */
      double film[2] = {0}, z = 0, o[3] = {0}, d[3] = {0};
      assert_int_equal(vl_camera_project(&c, points + 3 * i, film, &z), valid[i]);
      assert_memory_equal(film, films + 2 * i, sizeof film);
      assert_memory_equal(&z, depths + i, sizeof z);
      assert_int_equal(vl_camera_unproject(&c, pixels[2 * i], pixels[2 * i + 1], o, d),
                       answered[i]);
      assert_memory_equal(o, origins + 3 * i, sizeof o);
      assert_memory_equal(d, rays + 3 * i, sizeof d);
    }
  }
  assert_true(seen > KINDS * CAMERAS * POINTS / 2);
  assert_true(outside > 200);
}

/* A camera that turns as fast as it reads: many rows pass a point. */
static vlCamera fast_camera(double degrees, vlReadout direction) {
  vlCameraDef d = vl_default_camera_def(64, 48);
  d.fx = d.fy = 60;
  d.shutter_open = d.shutter_close = 0;
  d.readout = 1;
  d.readout_direction = direction;
  double turn = RADIANS(degrees);
  set3(d.eye, 0, 0, 0);
  set3(d.lookat, 0, sin(turn), -cos(turn));
  set3(d.lookat_close, 0, sin(-turn), -cos(turn));
  return make_or_fail(&d);
}

/* Rows that see the point, by trying each: their number, and the film y of the first two. */
static int rows_by_trial(const vlCamera *c, const double p[3], double rows[2]) {
  enum { STEPS = 48 * 200 };
  int count = 0;
  double before = 0;
  for (int i = 0; i <= STEPS; i++) {
    double u = (double)i / STEPS, film[2], z;
    double y = (c->readout_direction == VL_READOUT_UP ? 1 - u : u) * c->height;
    vlCamera held;
    vl_camera_at(c, time_of(c, 0, y), &held);
    if (!vl_camera_project(&held, p, film, &z))
      return -1;
    double ahead = (c->readout_direction == VL_READOUT_UP ? -1 : 1) * (film[1] - y);
    if (i && (ahead > 0) != (before > 0)) {
      if (count < 2)
        rows[count] = y;
      count++;
    }
    before = ahead;
  }
  return count;
}

static void the_first_row_is_taken(void **state) {
  (void)state;
  uint64_t random = 9;
  int several = 0, one = 0;
  for (int k = 0; k < 400; k++) {
    double degrees = next_between(&random, 21.7, 22.7);
    vlCamera c =
        fast_camera(k % 2 ? degrees : -degrees, k % 2 ? VL_READOUT_UP : VL_READOUT_DOWN);
    double p[3] = {0.1, next_between(&random, -0.01, 0.01), -2}, rows[2] = {0, -9}, film[2], z;
    int count = rows_by_trial(&c, p, rows);
    bool seen = vl_camera_project(&c, p, film, &z);
    if (count > 1 && fabs(rows[0] - rows[1]) < c.height / 15.0)
      continue;
    if (count > 0) {
      assert_true(seen);
      near(film[1], rows[0], 0.006, "the row that is read first");
    }
    if (count == 0)
      assert_true(!seen || film[1] <= 0 || film[1] >= c.height);
    several += count > 1;
    one += count == 1;
  }
  assert_true(several > 20 && one > 20);
}

static void points_that_no_row_sees(void **state) {
  (void)state;
  vlCamera c = fast_camera(10, VL_READOUT_DOWN);
  const double points[5][3] = {
      {0, 0, 3}, {NAN, 0, -1}, {0, INFINITY, -1}, {0, 0, 0}, {0, 0, -1}};
  double film[10], z[5];
  uint8_t valid[5];
  vl_camera_project_batch(&c, 5, points[0], film, z, valid);
  for (int i = 0; i < 4; i++) {
    assert_false(valid[i]);
    assert_true(film[2 * i] == 0 && film[2 * i + 1] == 0 && z[i] == 0);
  }
  assert_true(valid[4]);
  double o[3], d[3];
  assert_false(vl_camera_unproject(&c, NAN, 3, o, d));
  assert_false(vl_camera_unproject(&c, 3, INFINITY, o, d));
}

/* ---- Jacobians --------------------------------------------------------------------------- */

/* camera_from_world' = exp((t, r)^) camera_from_world for one number of (t, r). */
static void move_pose(vlCamera *camera, int which, double h) {
  double e[16], back[16], to[16] = {0};
  small_motion(which, h, e, back);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 4; k++)
        to[4 * i + j] += camera->world_from_camera[4 * i + k] * back[4 * k + j];
  assert_int_equal(vl_camera_pose_matrix(to, camera, NULL), VL_OK);
}

/* The camera held at a time, one number of it moved by h. */
static vlCamera held_at(const vlCamera *c, double time, int column, double h) {
  vlCamera held;
  assert_int_equal(vl_camera_at(c, time, &held), VL_OK);
  double *numbers[5] = {&held.fx, &held.fy, &held.skew, &held.cx, &held.cy};
  if (column >= VL_JACOBIAN_POSE && column < VL_JACOBIAN_INTRINSICS)
    move_pose(&held, column - VL_JACOBIAN_POSE, h);
  if (column >= VL_JACOBIAN_INTRINSICS && column < VL_JACOBIAN_SHAPE)
    *numbers[column - VL_JACOBIAN_INTRINSICS] += h;
  return held;
}

/* The film point by fixed-point iteration of held cameras, or the ray. */
static void value(const vlCamera *c, bool forward, const double at[3], int column, double h,
                  double out[6]) {
  double p[3] = {at[0], at[1], at[2]}, z;
  if (column < VL_JACOBIAN_POSE)
    p[column] += h;
  if (!forward) {
    vlCamera held = held_at(c, time_of(c, p[0], p[1]), column, h);
    assert_true(vl_camera_unproject(&held, p[0], p[1], out, out + 3));
    return;
  }
  assert_true(vl_camera_project(c, at, out, &z));
  for (int step = 0; step < 30; step++) {
    vlCamera held = held_at(c, time_of(c, out[0], out[1]), column, h);
    assert_true(vl_camera_project(&held, p, out, &z));
  }
}

static void check_column(const vlCamera *c, bool forward, const double at[3], int column,
                         const double *rows) {
  static const double weight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  double best = INFINITY;
  for (double h = 4e-3; h > 3e-4 && best > 1e-8; h *= 0.5) {
    double sum[6] = {0}, v[6] = {0}, error = 0, size = forward ? 1 : 1e-2;
    for (int i = 0; i < 4; i++)
      for (int side = -1; side <= 1; side += 2) {
        value(c, forward, at, column, side * (i + 1) * h, v);
        for (int k = 0; k < (forward ? 2 : 6); k++)
          sum[k] += side * weight[i] * v[k] / h;
      }
    for (int k = 0; k < (forward ? 2 : 6); k++) {
      double mine = rows[k * COLUMNS + column];
      size = fmax(size, fabs(mine));
      error = fmax(error, fabs(mine - sum[k]));
    }
    best = fmin(best, error / size);
  }
  if (!(best < 1e-8))
    fail_msg("%s, %s, column %d: off by %g", vl_projection_name(c->projection),
             forward ? "project" : "unproject", column, best);
}

static void jacobians_have_the_rows_time(void **state) {
  (void)state;
  uint64_t random = 5;
  int seen = 0;
  for (int k = 0; k < KINDS * 24; k++) {
    vlCamera c = moving_camera(kinds[k % KINDS], k % 3 ? 0.8 : 0, 0.4, &random);
    double pixel[3] = {next_between(&random, 0.2, 0.8) * c.width,
                       next_between(&random, 0.2, 0.8) * c.height, 0};
    double o[3], d[3], p[3], film[2], z, rows[6 * COLUMNS];
    uint8_t valid;
    if (!vl_camera_unproject(&c, pixel[0], pixel[1], o, d))
      continue;
    for (int a = 0; a < 3; a++)
      p[a] = o[a] + 3 * d[a];
    if (!vl_camera_project(&c, p, film, &z) || fabs(film[0] - pixel[0]) > 1)
      continue;
    assert_int_equal(vl_camera_project_jacobian(&c, 1, p, rows, &valid, NULL), VL_OK);
    assert_true(valid);
    for (int column = 0; column < VL_JACOBIAN_SHAPE; column++)
      check_column(&c, true, p, column, rows);
    assert_int_equal(vl_camera_unproject_jacobian(&c, 1, pixel, rows, &valid, NULL), VL_OK);
    assert_true(valid);
    for (int column = 0; column < VL_JACOBIAN_SHAPE; column++)
      if (column != 2)
        check_column(&c, false, pixel, column, rows);
    seen++;
  }
  assert_true(seen > KINDS * 16);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_the_held_camera),
                                     cmocka_unit_test(the_first_row_is_taken),
                                     cmocka_unit_test(points_that_no_row_sees),
                                     cmocka_unit_test(jacobians_have_the_rows_time)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
