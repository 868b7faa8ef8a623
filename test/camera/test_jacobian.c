/* test/camera/test_jacobian.c: derivatives of projection and unprojection against central
 * differences of eighth order of the public functions, for random cameras of every projection
 * and distortion. */
#include "camera/context.h"
#include "camera/random_cameras.h"
#include "camera/small_motion.h"

#include "distortion/compile.h"
#include "velo/jacobian.h"

vlDistortionCompile vl_distortion_compile_opencv;

enum { CAMERAS = 200, COLUMNS = VL_JACOBIAN_COLUMNS };

static void set_tilt(vlCamera *camera, double tau_x, double tau_y) {
  double k[14] = {0};
  vlDistortionMap tilted = camera->distortion;
  k[12] = tau_x;
  k[13] = tau_y;
  assert_int_equal(vl_distortion_compile_opencv(k, 14, &tilted, NULL), VL_OK);
  memcpy(camera->distortion.tilt, tilted.tilt, sizeof tilted.tilt);
  memcpy(camera->distortion.untilt, tilted.untilt, sizeof tilted.untilt);
}

/* Moves the pose: camera_from_world' = exp((t, r)^) camera_from_world for one number of (t, r).
 */
static void move_pose(vlCamera *camera, int which, double h) {
  double e[16], back[16];
  small_motion(which, h, e, back);
  double from[16], to[16];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      from[4 * i + j] = to[4 * i + j] = 0;
      for (int k = 0; k < 4; k++) {
        from[4 * i + j] += e[4 * i + k] * camera->camera_from_world[4 * k + j];
        to[4 * i + j] += camera->world_from_camera[4 * i + k] * back[4 * k + j];
      }
    }
  memcpy(camera->camera_from_world, from, sizeof from);
  memcpy(camera->world_from_camera, to, sizeof to);
}

typedef struct {
  vlCamera camera;
  double at[3];
  double tau[2];
} Place;

/* A place with one number moved by h units of the number's step. */
static Place moved(const Place *place, int column, double h) {
  Place p = *place;
  vlCamera *c = &p.camera;
  double *intrinsics[5] = {&c->fx, &c->fy, &c->skew, &c->cx, &c->cy};
  if (column < VL_JACOBIAN_POSE)
    p.at[column] += h;
  else if (column < VL_JACOBIAN_INTRINSICS)
    move_pose(c, column - VL_JACOBIAN_POSE, h);
  else if (column < VL_JACOBIAN_SHAPE)
    *intrinsics[column - VL_JACOBIAN_INTRINSICS] += h;
  else if (column < VL_JACOBIAN_DISTORTION)
    c->shape[column - VL_JACOBIAN_SHAPE] += h;
  else if (column < VL_JACOBIAN_DISTORTION + 6)
    c->distortion.numerator[column - VL_JACOBIAN_DISTORTION] += h;
  else if (column < VL_JACOBIAN_DISTORTION + 9)
    c->distortion.denominator[column - VL_JACOBIAN_DISTORTION - 6] += h;
  else if (column < VL_JACOBIAN_DISTORTION + 11)
    c->distortion.tangential[column - VL_JACOBIAN_DISTORTION - 9] += h;
  else if (column < VL_JACOBIAN_DISTORTION + 15)
    c->distortion.prism[column - VL_JACOBIAN_DISTORTION - 11] += h;
  else
    set_tilt(c, p.tau[0] + (column == COLUMNS - 2 ? h : 0),
             p.tau[1] + (column == COLUMNS - 1 ? h : 0));
  return p;
}

static bool value(const Place *p, bool forward, double out[6]) {
  if (forward)
    return vl_camera_project(&p->camera, p->at, out, NULL);
  return vl_camera_unproject(&p->camera, p->at[0], p->at[1], out, out + 3);
}

/* Eighth order: an error of h^8 and 1e-16 / h. */
static bool difference(const Place *place, bool forward, int column, double h, double out[6]) {
  static const double weight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  memset(out, 0, 6 * sizeof *out);
  for (int i = 0; i < 4; i++)
    for (int side = -1; side <= 1; side += 2) {
      double v[6] = {0};
      Place p = moved(place, column, side * (i + 1) * h);
      if (!value(&p, forward, v))
        return false;
      for (int k = 0; k < 6; k++)
        out[k] += side * weight[i] * v[k] / h;
    }
  return true;
}

/* The largest difference of a column, relative to the column's length or 1. */
static double column_error(const Place *place, bool forward, int column, const double *rows) {
  double best = INFINITY;
  bool film = column >= VL_JACOBIAN_INTRINSICS && column < VL_JACOBIAN_SHAPE;
  double unit = film || (!forward && column < 2) ? 10.0 : 1.0;
  if (column == VL_JACOBIAN_DISTORTION + 4 || column == VL_JACOBIAN_DISTORTION + 5)
    unit = 0.1; /* the highest powers of the radius */
  for (double h = 4e-3; h > 3e-4 && best > 1e-8; h *= 0.5) {
    double d[6], error = 0, size = forward ? 1.0 : 1e-2;
    if (!difference(place, forward, column, unit * h, d))
      continue;
    for (int k = 0; k < (forward ? 2 : 6); k++) {
      double mine = rows[k * COLUMNS + column];
      size = fmax(size, fabs(mine));
      error = fmax(error, fabs(mine - d[k]));
    }
    best = fmin(best, error / size);
  }
  return best;
}

static bool has_column(vlProjection kind, vlDistortion bent, int column, bool forward) {
  if (kind == VL_PROJECTION_OPTICS && column >= VL_JACOBIAN_INTRINSICS)
    return column == VL_JACOBIAN_SHAPE - 2 || column == VL_JACOBIAN_SHAPE - 1;
  int numbers = kind == VL_PROJECTION_EUCM || kind == VL_PROJECTION_DOUBLE_SPHERE ? 2 : 1;
  const ProjectionCase *c = projections[kind];
  if (!forward && column == 2)
    return false;
  if (column >= VL_JACOBIAN_SHAPE && column < VL_JACOBIAN_DISTORTION)
    return kind != VL_PROJECTION_CUBE && !isnan(c->shape[0]) &&
           column - VL_JACOBIAN_SHAPE < numbers;
  if (column >= VL_JACOBIAN_DISTORTION)
    return bent != VL_DISTORTION_NONE && (column < COLUMNS - 2 || bent == VL_DISTORTION_OPENCV);
  return true;
}

static int check_place(vlProjection kind, vlDistortion bent, const Place *place, bool forward) {
  double rows[6 * COLUMNS];
  uint8_t valid;
  vlError error;
  vlResult result =
      forward
          ? vl_camera_project_jacobian(&place->camera, 1, place->at, rows, &valid, &error)
          : vl_camera_unproject_jacobian(&place->camera, 1, place->at, rows, &valid, &error);
  assert_int_equal(result, VL_OK);
  if (!valid)
    return 0;
  for (int column = 0; column < COLUMNS; column++) {
    if (!has_column(kind, bent, column, forward))
      continue;
    double e = column_error(place, forward, column, rows);
    if (!isfinite(e)) /* the domain ends within all steps */
      return 0;
    if (e > 1e-8)
      fail_msg("%s, distortion %u, %s, column %d: off by %g", vl_projection_name(kind), bent,
               forward ? "project" : "unproject", column, e);
  }
  return 1;
}

static void check_model(vlProjection kind, vlDistortion bent) {
  uint64_t state = 7 + kind + 100 * bent;
  int seen[2] = {0, 0};
  for (int i = 0; i < CAMERAS; i++) {
    Place place;
    if (!random_camera(kind, bent, 0.2, &state, &place.camera))
      return;
    const double *tilt = place.camera.distortion.tilt;
    place.tau[0] = bent == VL_DISTORTION_OPENCV ? atan2(-tilt[7], tilt[8]) : 0.0;
    place.tau[1] = bent == VL_DISTORTION_OPENCV ? asin(tilt[6]) : 0.0;
    double pixel[3] = {next_between(&state, 0.2, 0.8) * place.camera.width,
                       next_between(&state, 0.2, 0.8) * place.camera.height, 0.0};
    double o[3], d[3];
    if (kind == VL_PROJECTION_CUBE) { /* within a face: 100 pixels */
      pixel[0] = 100 * floor(next_between(&state, 0, 6)) + next_between(&state, 10, 90);
      pixel[1] = next_between(&state, 10, 90);
    }
    if (!vl_camera_unproject(&place.camera, pixel[0], pixel[1], o, d))
      continue;
    double far = next_between(&state, 2, 5);
    for (int k = 0; k < 3; k++)
      place.at[k] = o[k] + far * d[k];
    seen[0] += check_place(kind, bent, &place, true);
    memcpy(place.at, pixel, sizeof pixel);
    seen[1] += check_place(kind, bent, &place, false);
  }
  assert_true(seen[0] > CAMERAS / 2);
  assert_true(seen[1] > CAMERAS / 2);
}

static void test_every_model(void **state) {
  (void)state;
  for (vlProjection kind = 0; kind < sizeof projections / sizeof *projections; kind++) {
    check_model(kind, VL_DISTORTION_NONE);
    for (vlDistortion bent = 1;
         bent < sizeof distortions / sizeof *distortions && has_distortion(kind); bent++)
      check_model(kind, bent);
  }
}

static void check_lens(const char *path) {
  vlOpticsDef optics_def = vl_default_optics_def();
  vlOptics *optics = NULL;
  optics_def.focus_distance = 3;
  assert_int_equal(vl_optics_load(context, path, &optics_def, &optics, NULL), VL_OK);
  uint64_t state = 11;
  int seen = 0;
  for (int i = 0; i < CAMERAS; i++) {
    vlCameraDef d = vl_default_camera_def(640, 480);
    d.projection = VL_PROJECTION_OPTICS;
    d.lens.optics = optics;
    d.roll = next_between(&state, -3, 3);
    for (int k = 0; k < 3; k++)
      d.eye[k] = next_between(&state, -2, 2);
    Place place = {.camera = make_or_fail(&d)};
    double pixel[3] = {next_between(&state, 130, 500), next_between(&state, 100, 380), 0};
    double o[3], ray[3], far = next_between(&state, 2, 5);
    assert_true(vl_camera_unproject(&place.camera, pixel[0], pixel[1], o, ray));
    for (int k = 0; k < 3; k++)
      place.at[k] = o[k] + far * ray[k];
    seen += check_place(VL_PROJECTION_OPTICS, VL_DISTORTION_NONE, &place, true);
    memcpy(place.at, pixel, sizeof pixel);
    seen += check_place(VL_PROJECTION_OPTICS, VL_DISTORTION_NONE, &place, false);
  }
  assert_int_equal(seen, 2 * CAMERAS);
  vl_optics_destroy(optics);
}

static void test_lenses(void **state) {
  (void)state;
  check_lens(VELO_SOURCE_DIR "/scenes/cameras/lenses/double_gauss_50mm.dat");
  check_lens(VELO_SOURCE_DIR "/scenes/cameras/lenses/single_50mm.dat");
}

static void test_outside(void **state) {
  (void)state;
  vlCamera c = camera_of(0);
  const double points[9] = {NAN, 0, 0, 1e9, 1e9, 1e9, 0, 0, -50};
  double rows[3 * 2 * COLUMNS];
  uint8_t valid[3];
  vlError error;
  assert_int_equal(vl_camera_project_jacobian(&c, 3, points, rows, valid, &error), VL_OK);
  assert_false(valid[0]);
  assert_false(valid[1]);
  assert_true(valid[2]);
  assert_true(rows[0] == 0.0 && rows[2 * COLUMNS] == 0.0);
  assert_int_equal(vl_camera_project_jacobian(NULL, 3, points, rows, valid, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_project_jacobian(&c, 3, NULL, rows, valid, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_project_jacobian(&c, 0, NULL, NULL, NULL, &error), VL_OK);
  c.eye_circle = 0.03;
  assert_int_equal(vl_camera_project_jacobian(&c, 3, points, rows, valid, &error),
                   VL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "omnidirectional stereo"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_model),
      cmocka_unit_test(test_lenses),
      cmocka_unit_test(test_outside),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
