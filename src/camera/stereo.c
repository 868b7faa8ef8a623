/* camera/stereo.c: makes the cameras of both eyes from one camera, and copies of a camera at
 * several positions. An eye is an ordinary camera with another pose and principal point, except
 * for omnidirectional stereo (eyes.h). */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "camera/parts.h"
#include "math/transform.h"
#include "projection/projection.row.h"
#include "velo/projection.h"

static vlResult check_stereo(const vlCamera *c, const vlStereo *s, vlError *error) {
  if ((uint32_t)s->mode > VL_STEREO_OMNIDIRECTIONAL)
    return vl_fail_argument(error, "camera: unknown stereo mode %d", (int)s->mode);
  if (s->mode == VL_STEREO_NONE)
    return VL_OK;
  if (!(s->interocular > 0.0) || isinf(s->interocular))
    return vl_fail_argument(
        error, "camera: the interocular distance is %g; it must be above zero", s->interocular);
  bool given = !vl_is_unset(s->convergence),
       meets = s->mode == VL_STEREO_OFF_AXIS || s->mode == VL_STEREO_TOE_IN;
  if (given && !(s->convergence > 0.0))
    return vl_fail_argument(error,
                            "camera: the convergence is %g; it must be a distance above zero",
                            s->convergence);
  if (given && !meets && !isinf(s->convergence))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: convergence %g has no meaning for %s stereo, whose eyes look the same way",
        s->convergence, vl_camera_stereo_modes[s->mode]);
  if (!given && meets)
    return vl_fail_argument(error,
                            "camera: %s stereo needs the distance where the eyes converge",
                            vl_camera_stereo_modes[s->mode]);
  if (s->mode == VL_STEREO_OFF_AXIS &&
      (c->projection != VL_PROJECTION_PERSPECTIVE || c->distortion.steps > 0))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: off-axis stereo needs a flat view plane: the perspective projection "
        "without distortion");
  bool round =
      c->projection >= VL_PROJECTION_EQUIRECTANGULAR && c->projection <= VL_PROJECTION_CUBE;
  if (s->mode == VL_STEREO_OMNIDIRECTIONAL && !round)
    return vl_fail_argument(
        error,
        "camera: omnidirectional stereo goes all round: with the equirectangular, "
        "cylindrical, equal-area and cube projections, not with the %s one",
        vl_projection_name(c->projection));
  return VL_OK;
}

/* Returns the pose of an eye in camera space: a translation to the right by x and a rotation to
 * the right by the angle whose tangent is `turn`. */
static vlMat4 eye_pose(double x, double turn) {
  vlMat4 m = vl_mat4_identity();
  double k = 1.0 / sqrt(1.0 + turn * turn);
  m.m[0] = k;
  m.m[2] = turn * k;
  m.m[3] = x;
  m.m[8] = 0.0 - turn * k;
  m.m[10] = k;
  return m;
}

vlResult vl_camera_eye(const vlCamera *camera, const vlStereo *stereo, vlEye eye,
                       vlCamera *result, vlError *error) {
  vl_error_clear(error);
  if (!camera || !stereo || !result)
    return vl_fail_argument(error, "camera: camera, stereo or result is null");
  VL_TRY(check_stereo(camera, stereo, error));
  if ((uint32_t)eye > VL_EYE_RIGHT)
    return vl_fail_argument(error, "camera: unknown eye %d", (int)eye);
  vlCamera made = *camera;
  if (eye == VL_EYE_BOTH || stereo->mode == VL_STEREO_NONE) {
    *result = made;
    return VL_OK;
  }
  double x = (eye == VL_EYE_LEFT ? -0.5 : 0.5) * stereo->interocular,
         meet = x / stereo->convergence;
  if (stereo->mode == VL_STEREO_OMNIDIRECTIONAL) {
    made.eye_circle = x;
  } else {
    vlMat4 from_between = eye_pose(x, stereo->mode == VL_STEREO_TOE_IN ? -meet : 0.0);
    vlMat4 pose = vl_mat4_multiply(vl_mat4_load(camera->world_from_camera), from_between);
    VL_TRY(vl_camera_pose_matrix(pose.m, &made, error));
    vlMat4 there =
        vl_mat4_multiply(vl_mat4_load(camera->world_from_camera_close), from_between);
    memcpy(made.world_from_camera_close, there.m, sizeof there.m);
    /* the axis of the camera between the eyes meets the plane z = convergence at the same pixel
     * of both */
    if (stereo->mode == VL_STEREO_OFF_AXIS)
      made.cx += made.fx * meet;
  }
  *result = made;
  return VL_OK;
}

vlResult vl_camera_stereo(const vlCameraDef *def, vlCamera *left, vlCamera *right,
                          const char **warning, vlError *error) {
  vl_error_clear(error);
  if (!def || !left || !right)
    return vl_fail_argument(error, "camera: def, left or right is null");
  if (def->stereo.mode == VL_STEREO_NONE)
    return vl_fail_argument(error, "camera: the def has no stereo mode");
  vlCameraDef between = *def;
  vlCamera camera, eyes[2];
  between.stereo_eye = VL_EYE_BOTH;
  VL_TRY(vl_camera_make(&between, &camera, warning, error));
  VL_TRY(vl_camera_eye(&camera, &def->stereo, VL_EYE_LEFT, &eyes[0], error));
  VL_TRY(vl_camera_eye(&camera, &def->stereo, VL_EYE_RIGHT, &eyes[1], error));
  *left = eyes[0];
  *right = eyes[1];
  return VL_OK;
}

vlResult vl_camera_move(const vlCamera *camera, const double world_from_camera[16],
                        vlCamera *result, vlError *error) {
  vl_error_clear(error);
  if (!camera || !world_from_camera || !result)
    return vl_fail_argument(error, "camera: camera, world_from_camera or result is null");
  vlCamera moved = *camera;
  VL_TRY(vl_camera_pose_matrix(world_from_camera, &moved, error));
  memcpy(moved.world_from_camera_close, moved.world_from_camera,
         sizeof moved.world_from_camera);
  moved.moves = false;
  *result = moved;
  return VL_OK;
}
