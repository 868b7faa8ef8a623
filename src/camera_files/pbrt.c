/* camera_files/pbrt.c: pbrt-v4's Transform, Camera and Film statements. pbrt's camera space is
 * x right, y up, z forward; its matrix is camera from world, written column by column. */
#include <math.h>

#include "camera_files/files.h"
#include "math/transform.h"
#include "velo/projection.h"

/* The axes of velo's maps of the sphere in pbrt's camera, as the reader of scenes has them
 * (import/pbrt/camera.c): rows are pbrt's axes x, down and z. */
static const double equal_area_axes[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
static const double equirectangular_axes[9] = {0, 0, -1, 0, 1, 0, -1, 0, 0};

static void put_transform(vlCameraText *text, const double camera_from_world[16],
                          const double *axes) {
  vlMat4 m = vl_mat4_load(camera_from_world);
  if (axes) {
    vlMat4 turn = vl_mat4_identity();
    for (int i = 0; i < 9; i++)
      turn.m[4 * (i / 3) + i % 3] = axes[i];
    m = vl_mat4_multiply(turn, m);
  }
  vl_camera_put(text, "Transform [");
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 4; row++) {
      double v = m.m[4 * row + column];
      vl_camera_put(text, "%s%.17g", row + column ? " " : "", (row == 1 ? 0.0 - v : v) + 0.0);
    }
  vl_camera_put(text, "]\n");
}

static vlResult put_poses(vlCameraText *text, const vlCamera *c, const double *axes) {
  if (c->moves)
    vl_camera_put(text, "TransformTimes %.17g %.17g\nActiveTransform StartTime\n",
                  c->pose_times[0], c->pose_times[1]);
  put_transform(text, c->camera_from_world, axes);
  if (!c->moves)
    return VL_OK;
  vlCamera close;
  VL_TRY(vl_camera_at(c, c->pose_times[1], &close));
  vl_camera_put(text, "ActiveTransform EndTime\n");
  put_transform(text, close.camera_from_world, axes);
  vl_camera_put(text, "ActiveTransform All\n");
  return VL_OK;
}

static void put_plain(vlCameraText *text, const vlCamera *c, bool flat) {
  vl_camera_put(text, "Camera \"%s\"", flat ? "orthographic" : "perspective");
  /* the screen window is on the plane at distance 1: fov 90 degrees does not scale it */
  if (!flat)
    vl_camera_put(text, " \"float fov\" [90]");
  vl_camera_put(text, "\n  \"float screenwindow\" [%.17g %.17g %.17g %.17g]", -c->cx / c->fx,
                (c->width - c->cx) / c->fx, (c->cy - c->height) / c->fy, c->cy / c->fy);
  if (c->lens_radius > 0.0)
    vl_camera_put(text, "\n  \"float lensradius\" [%.17g]", c->lens_radius);
  if (!isinf(c->focus_distance))
    vl_camera_put(text, " \"float focaldistance\" [%.17g]", c->focus_distance);
}

static vlResult write_pbrt(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const bool round = c->projection == VL_PROJECTION_EQUIRECTANGULAR;
  if (fit->sphere) /* pbrt's has no lens */
    VL_TRY(vl_camera_refuse(fit->file, "lens_radius", c->lens_radius > 0.0));
  vl_camera_put(text,
                "# pixels count from the image's upper left corner; camera axes x right, y up, "
                "z forward\n");
  const double *axes = !fit->sphere ? NULL : round ? equirectangular_axes : equal_area_axes;
  VL_TRY(put_poses(text, c, axes));
  if (fit->sphere)
    vl_camera_put(text, "Camera \"spherical\" \"string mapping\" \"%s\"",
                  round ? "equirectangular" : "equalarea");
  else
    put_plain(text, c, c->projection == VL_PROJECTION_ORTHOGRAPHIC);
  if (c->shutter_open != 0.0 || c->shutter_close != 1.0)
    vl_camera_put(text, "\n  \"float shutteropen\" [%.17g] \"float shutterclose\" [%.17g]",
                  c->shutter_open, c->shutter_close);
  vl_camera_put(text,
                "\nFilm \"rgb\" \"integer xresolution\" [%u] \"integer yresolution\" [%u]\n",
                c->width, c->height);
  vl_camera_put(
      text,
      "WorldBegin # an empty world makes this a whole scene; leave the line out of what "
      "you include\n");
  return VL_OK;
}

const vlCameraFormat vl_format_pbrt = {
    .name = "pbrt",
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_LENS | VL_HOLDS_TIME | VL_HOLDS_MOTION,
    .plain = true,
    .spheres = true,
    .write = write_pbrt};
const vlCameraFormat vl_format_exr = {
    .name = "exr", .not_written = "an image's header is written with its image"};
