/* conformance/ray_derivatives.h: the law of rays' derivatives: those of a ray by its film point
 * are those of differences, also where each row of the film has a pose of its own. */
#ifndef TEST_CONFORMANCE_RAY_DERIVATIVES_H
#define TEST_CONFORMANCE_RAY_DERIVATIVES_H

#include "cameras.h"
#include "conformance.h"
#include "unit.h"
#include "velo/jacobian.h"

/* Central differences of fourth order of origin and direction, along one axis of the film.
 * False: a point has no ray, or rays jump there. */
static bool ray_difference(const vlCamera *camera, const double pixel[2], int axis,
                           double by[6]) {
  static const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  static const double at[4] = {-2, -1, 1, 2};
  const double h = 0.01;
  double first[6];
  memset(by, 0, 6 * sizeof *by);
  for (int i = 0; i < 4; i++) {
    double p[2] = {pixel[0], pixel[1]};
    double ray[6];
    p[axis] += at[i] * h;
    if (!vl_camera_unproject(camera, p[0], p[1], ray, ray + 3))
      return false;
    if (i == 0)
      memcpy(first, ray, sizeof first);
    for (int k = 0; k < 6; k++) {
      if (fabs(ray[k] - first[k]) > 0.02)
        return false;
      by[k] += weight[i] * ray[k] / h;
    }
  }
  return true;
}

static void check_ray_derivatives(const char *name, const vlCamera *camera, const char *which) {
  enum { EACH = 17, NUMBERS = 6 };
  static double pixels[2 * FILM_POINTS];
  static double rows[NUMBERS * VL_JACOBIAN_COLUMNS];
  uint32_t compared = 0;
  uint32_t wrong = 0;
  film_points(pixels);
  for (int i = 0; i < FILM_POINTS; i += EACH) {
    uint8_t valid;
    vlError error = {0};
    const double pixel[2] = {pixels[2 * i] + 0.05, pixels[2 * i + 1] + 0.05};
    assert_int_equal(vl_camera_unproject_jacobian(camera, 1, pixel, rows, &valid, &error),
                     VL_OK);
    for (int axis = 0; valid && axis < 2; axis++) {
      double by[NUMBERS];
      if (!ray_difference(camera, pixel, axis, by))
        continue;
      compared++;
      bool same = true;
      for (int k = 0; k < NUMBERS; k++)
        same = same &&
               fabs(rows[k * VL_JACOBIAN_COLUMNS + axis] - by[k]) < 1e-6 + 1e-3 * fabs(by[k]);
      wrong += !same;
    }
  }
  if (compared < 10 || wrong)
    broken("projections", name, "%s: %u of %u derivatives of rays are not differences", which,
           wrong, compared);
}

/* The camera turns and moves while the rows are read. */
static void turn_while_read(vlCameraDef *def, vlReadout direction) {
  const double turn = 0.1;
  double *close = def->world_from_camera_close;
  def->has_matrix_close = true;
  memcpy(close, def->world_from_camera, sizeof def->world_from_camera_close);
  close[0] = close[5] = cos(turn);
  close[1] = -sin(turn);
  close[4] = sin(turn);
  close[3] = 0.2;
  close[7] = -0.1;
  def->shutter_close = def->shutter_open + 0.01;
  def->readout = 1;
  def->readout_direction = direction;
}

static void derivatives_of_rays(void **state) {
  (void)state;
  for (int p = 0; p < PROJECTIONS; p++) {
    const char *name = vl_projection_name((vlProjection)p);
    vlCameraDef def = def_of_projection((vlProjection)p);
    vlCamera camera;
    if (projection_cases[p]->optics || !make_camera("projections", name, &def, &camera))
      continue;
    check_ray_derivatives(name, &camera, "still");
    turn_while_read(&def, VL_READOUT_DOWN);
    if (make_camera("projections", name, &def, &camera))
      check_ray_derivatives(name, &camera, "read downwards");
    def.readout_direction = VL_READOUT_LEFT;
    if (make_camera("projections", name, &def, &camera))
      check_ray_derivatives(name, &camera, "read to the left");
  }
  expect_no_failures();
}

#endif
