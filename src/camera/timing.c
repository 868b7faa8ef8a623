/* camera/timing.c: the part of vl_camera_make for time: shutter, shutter curve, readout and the
 * second pose. It also makes the copy of a moving camera that is frozen at one time. */
#include "camera/time.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "camera/parts.h"
#include "camera/rays.h"
#include "math/double3.h"

static vlResult check_curve(const vlCameraDef *d, vlError *error) {
  if (d->shutter_points == 0)
    return VL_OK;
  if (d->shutter_points < 2 || d->shutter_points > VL_SHUTTER_POINTS)
    return vl_fail_argument(error,
                            "camera: the shutter's curve has %u points; it takes 2 to %d",
                            d->shutter_points, (int)VL_SHUTTER_POINTS);
  double area = 0.0;
  for (uint32_t i = 0; i < d->shutter_points; i++) {
    double at = d->shutter_at[i], value = d->shutter_value[i];
    if (!(at >= 0.0 && at <= 1.0) || (i && at < d->shutter_at[i - 1]))
      return vl_fail(
          error, VL_ERROR_ARGUMENT,
          "camera: point %u of the shutter's curve is at %g; from 0 to 1 they ascend", i, at);
    if (!(value >= 0.0) || value > 1e30)
      return vl_fail_argument(
          error, "camera: the shutter's curve is %g at point %u; it must not be negative",
          value, i);
    if (i)
      area += 0.5 * (at - d->shutter_at[i - 1]) * (value + d->shutter_value[i - 1]);
  }
  if (!(area > 0.0))
    return vl_fail_argument(error, "camera: the shutter's curve lets no light through");
  return VL_OK;
}

/* Fills the members of the second pose that are not given from the first pose. */
static bool second_pose(const vlCameraDef *def, vlCameraDef *close) {
  *close = *def;
  bool given = !vl_is_unset(def->roll_close);
  if (given)
    close->roll = def->roll_close;
  if (def->has_matrix_close) {
    if (!given && !def->has_matrix)
      close->roll = 0.0; /* it is that of eye and lookat */
    close->has_matrix = true;
    memcpy(close->world_from_camera, def->world_from_camera_close, 16 * sizeof(double));
    return true;
  }
  if (def->has_matrix)
    return given;
  const double *from[3] = {def->eye_close, def->lookat_close, def->up_close};
  double *to[3] = {close->eye, close->lookat, close->up};
  for (int k = 0; k < 3; k++) {
    if (vl_is_unset(from[k][0]) && vl_is_unset(from[k][1]) && vl_is_unset(from[k][2]))
      continue;
    memcpy(to[k], from[k], 3 * sizeof(double));
    given = true;
  }
  return given;
}

/* A matrix and a second eye have no common up and roll: not to move would be wrong without a
 * word. */
static vlResult check_second_pose(const vlCameraDef *def, vlError *error) {
  const double *given[3] = {def->eye_close, def->lookat_close, def->up_close};
  for (int k = 0; k < 3 && def->has_matrix && !def->has_matrix_close; k++)
    for (int i = 0; i < 3; i++)
      if (!vl_is_unset(given[k][i]))
        return vl_fail_argument(
            error,
            "camera: eye_close, lookat_close and up_close go with eye and lookat; "
            "with world_from_camera give world_from_camera_close");
  return VL_OK;
}

/* Sets the camera's motion from its pose to the pose `close`. */
static vlResult go_to(const double close[16], vlCamera *camera, vlError *error) {
  const double *t = camera->pose_times;
  vlMotion motion;
  if (!isfinite(t[0]) || !isfinite(t[1]) || !(t[0] <= t[1]))
    return vl_fail_argument(error, "camera: it cannot move from %g to %g seconds", t[0], t[1]);
  if (!vl_motion_make(camera->world_from_camera, close, &motion))
    return vl_fail_argument(
        error, "camera: no motion leads from its first pose to its second: one mirrors");
  memcpy(camera->world_from_camera_close, close, sizeof camera->world_from_camera_close);
  camera->moves =
      memcmp(camera->world_from_camera, close, sizeof camera->world_from_camera) != 0;
  return VL_OK;
}

vlResult vl_camera_travel(const vlCamera *camera, const double open[16], const double close[16],
                          const double times[2], vlCamera *result, vlError *error) {
  vl_error_clear(error);
  if (!camera || !open || !close || !times || !result)
    return vl_fail_argument(error, "camera: camera, open, close, times or result is null");
  vlCamera there = *camera, made = *camera;
  VL_TRY(vl_camera_pose_matrix(open, &made, error));
  VL_TRY(vl_camera_pose_matrix(close, &there, error));
  made.pose_times[0] = times[0];
  made.pose_times[1] = times[1];
  VL_TRY(go_to(there.world_from_camera, &made, error));
  *result = made;
  return VL_OK;
}

static vlResult make_motion(const vlCameraDef *def, vlCamera *camera, const char **warning,
                            vlError *error) {
  vlCameraDef close;
  memcpy(camera->world_from_camera_close, camera->world_from_camera,
         sizeof camera->world_from_camera);
  double end = def->shutter_close + def->readout;
  camera->pose_times[0] =
      vl_is_unset(def->pose_times[0]) ? def->shutter_open : def->pose_times[0];
  camera->pose_times[1] = vl_is_unset(def->pose_times[1]) ? end : def->pose_times[1];
  VL_TRY(check_second_pose(def, error));
  if (!second_pose(def, &close))
    return VL_OK;
  vlCamera there = *camera;
  VL_TRY(vl_camera_pose(&close, &there, warning, error));
  return go_to(there.world_from_camera, camera, error);
}

vlResult vl_camera_time_part(const vlCameraDef *def, vlCamera *camera, const char **warning,
                             vlError *error) {
  VL_TRY(check_curve(def, error));
  camera->readout = def->readout;
  camera->readout_direction = def->readout_direction;
  camera->shutter_points = def->shutter_points;
  memcpy(camera->shutter_at, def->shutter_at, sizeof camera->shutter_at);
  memcpy(camera->shutter_value, def->shutter_value, sizeof camera->shutter_value);
  return make_motion(def, camera, warning, error);
}

void vl_camera_compile_time(const vlCamera *camera, vlCameraTime *t) {
  memset(t, 0, sizeof *t);
  double rows = camera->readout / camera->height, columns = camera->readout / camera->width;
  switch (camera->readout_direction) {
    case VL_READOUT_DOWN:
      t->per_row = rows;
      break;
    case VL_READOUT_UP:
      t->per_row = -rows;
      break;
    case VL_READOUT_RIGHT:
      t->per_column = columns;
      break;
    case VL_READOUT_LEFT:
      t->per_column = -columns;
      break;
  }
  /* times are relative to the pixel that is read first; its exposure begins when the shutter
   * opens */
  t->columns = camera->width;
  t->rows = camera->height;
  t->first_column = t->per_column < 0.0 ? camera->width - 1.0 : 0.0;
  t->first_row = t->per_row < 0.0 ? camera->height - 1.0 : 0.0;
  t->moves = camera->moves && vl_motion_make(camera->world_from_camera,
                                             camera->world_from_camera_close, &t->motion);
  t->pose_open = camera->pose_times[0];
  double span = camera->pose_times[1] - camera->pose_times[0];
  t->pose_rate = span > 0.0 ? 1.0 / span : 0.0;
  t->points = camera->shutter_points;
  for (uint32_t i = 0; i < t->points; i++) {
    t->at[i] = camera->shutter_at[i];
    t->value[i] = camera->shutter_value[i];
    if (i)
      t->area += 0.5 * (t->at[i] - t->at[i - 1]) * (t->value[i] + t->value[i - 1]);
    t->share[i] = t->area;
  }
  for (uint32_t i = 0; i < t->points; i++)
    t->share[i] /= t->area;
  t->timed = t->moves || t->points > 0 || camera->readout > 0.0;
}

double vl_camera_time(const vlCamera *camera, double x, double y, double u) {
  if (!camera)
    return 0.0;
  vlCameraTime t;
  vl_camera_compile_time(camera, &t);
  return camera->shutter_open + (floor(x) - t.first_column) * t.per_column +
         (floor(y) - t.first_row) * t.per_row +
         (camera->shutter_close - camera->shutter_open) * vl_shutter_share(&t, u);
}

vlResult vl_camera_at(const vlCamera *camera, double time, vlCamera *result) {
  if (!camera || !result || !isfinite(time))
    return VL_ERROR_ARGUMENT;
  vlCamera still = *camera;
  double span = camera->pose_times[1] - camera->pose_times[0];
  double f = span > 0.0 ? (time - camera->pose_times[0]) / span : 0.0, m[16];
  if (camera->moves) {
    if (!vl_motion_at(camera->world_from_camera, camera->world_from_camera_close, f, m))
      return VL_ERROR_ARGUMENT;
    VL_TRY(vl_camera_pose_matrix(m, &still, NULL));
  }
  memcpy(still.world_from_camera_close, still.world_from_camera,
         sizeof still.world_from_camera);
  still.moves = false;
  still.shutter_open = still.shutter_close = still.pose_times[0] = still.pose_times[1] = time;
  still.shutter_points = 0;
  still.readout = 0.0;
  *result = still;
  return VL_OK;
}

/* The inverse of an affine map: the rows of the 3 x 3 part's inverse are cross products of its
 * columns, over the determinant. */
static void invert(const vlAffine *a, double inverse[12]) {
  const double *m = a->m;
  double determinant = vl_mat3_determinant(m);
  for (size_t i = 0; i < 3; i++) {
    size_t j = (i + 1) % 3, k = (i + 2) % 3;
    double *row = inverse + 4 * i;
    row[0] = (m[3 + j] * m[6 + k] - m[3 + k] * m[6 + j]) / determinant;
    row[1] = (m[6 + j] * m[k] - m[6 + k] * m[j]) / determinant;
    row[2] = (m[j] * m[3 + k] - m[k] * m[3 + j]) / determinant;
    row[3] = -vl_dot3(row, a->p);
  }
}

void vl_camera_pose_at(const vlCameraCompiled *c, double seconds, double world_from_camera[12],
                       double camera_from_world[12]) {
  const vlCameraTime *t = &c->when;
  vlAffine a;
  memcpy(a.m, c->rotation, sizeof a.m);
  memcpy(a.p, c->position, sizeof a.p);
  memcpy(camera_from_world, c->camera_from_world, sizeof c->camera_from_world);
  if (t->moves) {
    double f = (seconds - t->pose_open) * t->pose_rate;
    a = vl_motion_between(&t->motion, fmin(fmax(f, 0.0), 1.0));
    invert(&a, camera_from_world);
  }
  for (size_t i = 0; i < 3; i++) {
    memcpy(world_from_camera + 4 * i, a.m + 3 * i, 3 * sizeof(double));
    world_from_camera[4 * i + 3] = a.p[i];
  }
}

vlAffine vl_camera_rate_at(const vlCameraCompiled *c, double seconds) {
  const vlCameraTime *t = &c->when;
  double f = (seconds - t->pose_open) * t->pose_rate;
  vlAffine rate = {0};
  if (!t->moves || !(f > 0.0 && f < 1.0))
    return rate;
  rate = vl_motion_rate(&t->motion, f);
  for (int i = 0; i < 9; i++)
    rate.m[i] *= t->pose_rate;
  for (int i = 0; i < 3; i++)
    rate.p[i] *= t->pose_rate;
  return rate;
}

void vl_camera_retime(vlCameraCompiled *c, double origin, double scale) {
  vlCameraTime *t = &c->when;
  c->shutter_open = (c->shutter_open - origin) * scale;
  c->shutter_time *= scale;
  t->per_column *= scale;
  t->per_row *= scale;
  t->pose_open = (t->pose_open - origin) * scale;
  t->pose_rate /= scale;
  c->own_from += c->own_clock * origin;
  c->own_clock /= scale;
}
