/* camera/camera.c: the public functions: a camera from its def; a camera at another
 * resolution. */
#include <math.h>
#include <stdio.h>

#include "base/cookie.h"
#include "base/error.h"
#include "camera/own.h"
#include "camera/parts.h"
#include "projection/properties.row.h"
#include "schema/schema.h"
#include "velo/projection.h"

vlCameraDef vl_default_camera_def(uint32_t width, uint32_t height) {
  return (vlCameraDef){
      .cookie = VL_COOKIE_CAMERA,
      .projection = VL_PROJECTION_PERSPECTIVE,
      .width = width,
      .height = height,
      .fov = VL_UNSET,
      .fov_axis = VL_FOV_SMALLER,
      .view_distance = VL_UNSET,
      .zoom = VL_UNSET,
      .pixel_size = VL_UNSET,
      .focal_mm = VL_UNSET,
      .sensor_width_mm = VL_UNSET,
      .fx = VL_UNSET,
      .fy = VL_UNSET,
      .skew = VL_UNSET,
      .cx = VL_UNSET,
      .cy = VL_UNSET,
      .screen_min_x = VL_UNSET,
      .screen_max_x = VL_UNSET,
      .screen_min_y = VL_UNSET,
      .screen_max_y = VL_UNSET,
      .lookat = {0.0, 0.0, -1.0},
      .up = {0.0, 1.0, 0.0},
      .world_from_camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
      .focus_distance = VL_UNSET,
      .lens = {.f_number = VL_UNSET,
               .unit_mm = 1000.0,
               .focus_point = {VL_UNSET, VL_UNSET, VL_UNSET},
               .focus_pixel = {VL_UNSET, VL_UNSET},
               .ratio = 1.0,
               .iso = VL_UNSET,
               .seconds = VL_UNSET},
      .shutter_close = 1.0,
      .eye_close = {VL_UNSET, VL_UNSET, VL_UNSET},
      .lookat_close = {VL_UNSET, VL_UNSET, VL_UNSET},
      .up_close = {VL_UNSET, VL_UNSET, VL_UNSET},
      .roll_close = VL_UNSET,
      .world_from_camera_close = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
      .pose_times = {VL_UNSET, VL_UNSET},
      .exposure_time = 1.0,
      .far_plane = INFINITY,
      .shape = {VL_UNSET, VL_UNSET},
      .max_angle = VL_UNSET,
      .stereo = {VL_STEREO_NONE, 0.065, VL_UNSET},
      .stereo_eye = VL_EYE_BOTH,
  };
}

/* Checks each member by the row of its setting. */
static vlResult check_rows(const vlCameraDef *d, vlError *error) {
  const vlKindRow *rows = vl_settings(VL_SETTING_CAMERA);
  for (uint32_t i = 0; i < rows->parameter_count; i++) {
    const vlParameter *p = &rows->parameters[i];
    char name[80];
    char message[VL_GIVEN_MESSAGE];
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (d->projection == VL_PROJECTION_OWN && p->offset == offsetof(vlCameraDef, projection))
      continue;
    snprintf(name, sizeof name, "camera: %s", vl_setting_keyword(p));
    if (!vl_parameter_check(p, d, name, message))
      return vl_fail(error, VL_ERROR_ARGUMENT, "%s", message);
  }
  return VL_OK;
}

/* Checks what each number may be, and those that no other function compares. */
static vlResult check_rest(const vlCameraDef *d, vlError *error) {
  vlResult result = check_rows(d, error);
  if (result != VL_OK)
    return result;
  if (d->shutter_close < d->shutter_open)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: the shutter opens at %g and closes at %g",
                   d->shutter_open, d->shutter_close);
  if (!(d->far_plane > d->near_plane))
    return vl_fail(error, VL_ERROR_ARGUMENT,
                   "camera: near plane %g and far plane %g; needed is 0 <= near < far",
                   d->near_plane, d->far_plane);
  return VL_OK;
}

vlResult vl_camera_make(const vlCameraDef *def, vlCamera *camera, const char **warning,
                        vlError *error) {
  vl_error_clear(error);
  if (warning)
    *warning = NULL;
  if (!def || !camera)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: def or camera is null");
  if (def->cookie != VL_COOKIE_CAMERA)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: " VL_BAD_COOKIE);
  if (def->projection == VL_PROJECTION_OWN && !def->own)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: the projection OWN needs own");
  vlCameraDef own;
  if (def->own) {
    own = vl_camera_own_def(def);
    def = &own;
  }
  vlCamera made = {
      .projection = def->projection,
      .width = def->width,
      .height = def->height,
      .lens_radius = def->lens_radius,
      .focus_distance = vl_is_unset(def->focus_distance) ? INFINITY : def->focus_distance,
      .shutter_open = def->shutter_open,
      .shutter_close = def->shutter_close,
      .exposure_time = def->exposure_time,
      .near_plane = def->near_plane,
      .far_plane = def->far_plane,
  };
  vlResult result = check_rest(def, error);
  if (result == VL_OK)
    result = vl_camera_model(def, &made, error);
  if (result == VL_OK)
    result = vl_camera_intrinsics(def, &made, error);
  if (result == VL_OK)
    result = vl_camera_pose(def, &made, warning, error);
  if (result == VL_OK)
    result = vl_camera_time_part(def, &made, warning, error);
  if (result == VL_OK)
    result = vl_camera_lens(def, &made, error);
  if (result == VL_OK)
    result = vl_camera_own(def, &made, error);
  if (result == VL_OK)
    result = vl_camera_domain(def, &made, warning, error);
  if (result == VL_OK)
    result = vl_camera_eye(&made, &def->stereo, def->stereo_eye, &made, error);
  if (result == VL_OK && !vl_camera_rays_are_finite(&made))
    result =
        vl_fail(error, VL_ERROR_ARGUMENT,
                "camera: its rays are not finite: fx %g, fy %g, cx %g, cy %g, position (%g, "
                "%g, %g)",
                made.fx, made.fy, made.cx, made.cy, made.world_from_camera[3],
                made.world_from_camera[7], made.world_from_camera[11]);
  if (result == VL_OK)
    *camera = made;
  return result;
}

vlResult vl_camera_resize(const vlCamera *camera, uint32_t width, uint32_t height,
                          vlCamera *result) {
  if (!camera || !result || width == 0 || height == 0 || width > 1u << 24 || height > 1u << 24)
    return VL_ERROR_ARGUMENT;
  double before = camera->width < camera->height ? camera->width : camera->height;
  double scale = (width < height ? width : height) / before;
  if (camera->projection == VL_PROJECTION_OPTICS) { /* the film's diagonal is kept */
    double w = width, h = height, w0 = camera->width, h0 = camera->height;
    scale = sqrt((w * w + h * h) / (w0 * w0 + h0 * h0));
  }
  /* projections of the whole sphere, or to a cube, are stretched: width and height keep their
   * angular ranges */
  bool stretched = vl_projection_row(camera->projection)->traits & VL_PROJECTION_STRETCHED;
  double scale_x = stretched ? (double)width / camera->width : scale;
  double scale_y = stretched ? (double)height / camera->height : scale;
  vlCamera resized = *camera;
  resized.width = width;
  resized.height = height;
  resized.fx *= scale_x;
  resized.fy *= scale_y;
  resized.skew *= scale_x;
  /* the principal point keeps its position relative to the centre */
  resized.cx = 0.5 * width + (camera->cx - 0.5 * camera->width) * scale_x;
  resized.cy = 0.5 * height + (camera->cy - 0.5 * camera->height) * scale_y;
  for (int i = 0; i < 2; i++) /* unset values stay unset */
    resized.lens.focus_pixel[i] =
        (i ? resized.cy : resized.cx) +
        (camera->lens.focus_pixel[i] - (i ? camera->cy : camera->cx)) * (i ? scale_y : scale_x);
  vl_camera_measure(&resized);
  *result = resized;
  return VL_OK;
}

vlResult vl_camera_coarse(const vlCamera *camera, uint32_t factor, vlCamera *result) {
  if (!camera || !result || factor == 0 || factor > VL_MAX_COARSE)
    return VL_ERROR_ARGUMENT;
  vlCamera coarse = *camera;
  double scale = 1.0 / factor;
  coarse.fx *= scale;
  coarse.fy *= scale;
  coarse.skew *= scale;
  coarse.cx *= scale;
  coarse.cy *= scale;
  for (int i = 0; i < 2; i++)
    coarse.lens.focus_pixel[i] *= scale; /* unset values stay unset */
  coarse.width = (camera->width + factor - 1) / factor;
  coarse.height = (camera->height + factor - 1) / factor;
  bool down = camera->readout_direction == VL_READOUT_DOWN ||
              camera->readout_direction == VL_READOUT_UP;
  double rows = down ? camera->height : camera->width,
         coarse_rows = down ? coarse.height : coarse.width;
  coarse.readout *= coarse_rows * factor / rows; /* rows are read at the same speed */
  vl_camera_measure(&coarse);
  *result = coarse;
  return VL_OK;
}
