/* camera/camera.c: a camera from its def; a camera at another resolution; the input of the
 * batches (vlCameraCompiled) from a camera. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "camera/optics.h"
#include "camera/own.h"
#include "camera/parts.h"
#include "camera/rays.h"
#include "math/approx_double.h"
#include "math/elementary.h"
#include "math/transform.h"
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
  VL_EACH_PARAMETER(p, rows) {
    char name[80];
    char message[VL_GIVEN_MESSAGE];
    double wrong;
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (d->projection == VL_PROJECTION_OWN && p->offset == offsetof(vlCameraDef, projection))
      continue;
    if (vl_parameter_fits(p, d, &wrong))
      continue;
    snprintf(name, sizeof name, "camera: %s", vl_setting_keyword(p));
    vl_parameter_complain(p, name, wrong, message);
    return vl_fail_argument(error, "%s", message);
  }
  return VL_OK;
}

/* Checks what each number may be, and those that no other function compares. */
static vlResult check_rest(const vlCameraDef *d, vlError *error) {
  VL_TRY(check_rows(d, error));
  if (d->shutter_close < d->shutter_open)
    return vl_fail_argument(error, "camera: the shutter opens at %g and closes at %g",
                            d->shutter_open, d->shutter_close);
  if (!(d->far_plane > d->near_plane))
    return vl_fail_argument(error,
                            "camera: near plane %g and far plane %g; needed is 0 <= near < far",
                            d->near_plane, d->far_plane);
  return VL_OK;
}

/* Checks the numbers of the projection and puts in their defaults. */
static vlResult shape_numbers(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlProjectionRow *row = vl_projection_row(def->projection);
  const char *name = row->name;
  const vlShapeNumber *n = row->numbers;
  int count = (int)row->count;
  camera->shape[0] = camera->shape[1] = 0.0;
  for (int i = 0; i < 2; i++) {
    double value = def->shape[i];
    if (i >= count) {
      if (!vl_is_unset(value))
        return vl_fail_argument(error,
                                "camera: the %s projection takes %d numbers; shape[%d] is %g",
                                name, count, i, value);
      continue;
    }
    if (vl_is_unset(value))
      value = n[i].standard;
    if (vl_is_unset(value))
      return vl_fail_argument(error, "camera: the %s projection needs its %s", name, n[i].name);
    if (!(value >= n[i].min && value <= n[i].max))
      return vl_fail_argument(error,
                              "camera: %s of the %s projection is %g; it must be %g to %g",
                              n[i].name, name, value, n[i].min, n[i].max);
    if (def->projection == VL_PROJECTION_CUBE && value != 0.0 && value != 1.0)
      return vl_fail_argument(
          error, "camera: layout of the cube is %g; it must be 0 (a row) or 1 (a cross)",
          value);
    camera->shape[i] = value;
  }
  return VL_OK;
}

vlResult vl_camera_make(const vlCameraDef *def, vlCamera *camera, const char **warning,
                        vlError *error) {
  vl_error_clear(error);
  if (warning)
    *warning = NULL;
  if (!def || !camera)
    return vl_fail_argument(error, "camera: def or camera is null");
  if (def->cookie != VL_COOKIE_CAMERA)
    return vl_fail_argument(error, "camera: " VL_BAD_COOKIE);
  if (def->projection == VL_PROJECTION_OWN && !def->own)
    return vl_fail_argument(error, "camera: the projection OWN needs own");
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
      .limit = INFINITY,
  };
  VL_TRY(check_rest(def, error));
  VL_TRY(shape_numbers(def, &made, error));
  VL_TRY(vl_camera_distortion(def, &made.distortion, error));
  VL_TRY(vl_camera_intrinsics(def, &made, error));
  VL_TRY(vl_camera_pose(def, &made, warning, error));
  VL_TRY(vl_camera_time_part(def, &made, warning, error));
  VL_TRY(vl_camera_lens(def, &made, error));
  VL_TRY(vl_camera_own(def, &made, error));
  VL_TRY(vl_camera_domain(def, &made, warning, error));
  VL_TRY(vl_camera_eye(&made, &def->stereo, def->stereo_eye, &made, error));
  if (!vl_camera_rays_are_finite(&made))
    return vl_fail_argument(
        error,
        "camera: its rays are not finite: fx %g, fy %g, cx %g, cy %g, position (%g, "
        "%g, %g)",
        made.fx, made.fy, made.cx, made.cy, made.world_from_camera[3],
        made.world_from_camera[7], made.world_from_camera[11]);
  *camera = made;
  return VL_OK;
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

/* ---- the input of the batches ------------------------------------------------------------ */

/* Number of pixels by which a plane that wraps around extends beyond its edges. No filter is
 * wider. */
static const double overhang = 16.0;

/* Returns the angle (radians) that the central pixel subtends. */
static double central_spread(const vlCameraCompiled *c) {
  double size = sqrt(c->inv_fx * c->inv_fy);
  const vlProjectionRow *row = vl_projection_row(c->projection);
  return row->spread ? row->spread(c->shape) * size : size;
}

/* The factor by which a pose scales lengths: its mean over all directions. */
static double scale_of(const double pose[16]) {
  const vlMat4 m = vl_mat4_load(pose);
  return vl_mat4_scale_of(&m);
}

static void compile_lens(const vlCamera *camera, vlCameraCompiled *c) {
  const vlLens *l = &camera->lens;
  c->ahead = vl_camera_sees_ahead(camera->projection);
  c->vignetting = l->vignetting;
  c->optics = l->optics;
  if (c->optics) {
    double width = camera->width, height = camera->height;
    c->pitch = 2.0 * c->optics->half / sqrt(width * width + height * height);
    if (c->near_plane < c->optics->front)
      c->near_plane = c->optics->front;
  }
  if (c->optics || !c->has_lens)
    return;
  c->focus[0] = l->tilt[0] * c->inv_focus + l->hinge[0];
  c->focus[1] = l->tilt[1] * c->inv_focus + l->hinge[1];
  c->focus[2] = c->inv_focus;
  c->inv_ratio = 1.0 / l->ratio;
  c->aperture = l->aperture;
  c->lens_turn[0] = vl_precise_cos(l->rotation);
  c->lens_turn[1] = vl_precise_sin(l->rotation);
  if (l->blades)
    vl_blades_make(l->blades, l->rotation, &c->blades);
  c->shaped =
      l->blades || l->aperture || l->ratio != 1.0 || c->focus[0] != 0.0 || c->focus[1] != 0.0;
}

/* How wide a pixel is: spread, per unit of distance; width, in the world. */
static void measure_pixels(const vlCamera *camera, vlCameraCompiled *c) {
  /* a pixel's side at z = 1, or its width in camera units */
  const double size = 1.0 / sqrt(camera->fx * camera->fy);
  if (camera->projection == VL_PROJECTION_PERSPECTIVE) {
    c->pixel_spread = (float)size;
  } else if (camera->projection == VL_PROJECTION_ORTHOGRAPHIC) {
    c->pixel_width = (float)(size * scale_of(camera->world_from_camera));
  } else if (c->own) {
    c->pixel_spread = (float)(size * camera->own_pixel[0]);
    c->pixel_width = (float)(size * camera->own_pixel[1] * scale_of(camera->world_from_camera));
  } else {
    c->pixel_spread = (float)central_spread(c);
  }
}

void vl_camera_compile(const vlCamera *camera, vlCameraCompiled *c) {
  const double *m = camera->world_from_camera;
  *c = (vlCameraCompiled){
      .projection = camera->projection,
      .has_lens = camera->lens_radius > 0.0,
      .cx = camera->cx,
      .cy = camera->cy,
      .skew_ratio = camera->skew / camera->fy,
      .aspect = camera->fx / camera->fy,
      .focal = camera->fx,
      .inv_fx = 1.0 / camera->fx,
      .inv_fy = 1.0 / camera->fy,
      /* + 0.0 turns -0 into 0 */
      .rotation = {m[0] + 0.0, m[1] + 0.0, m[2] + 0.0, m[4] + 0.0, m[5] + 0.0, m[6] + 0.0,
                   m[8] + 0.0, m[9] + 0.0, m[10] + 0.0},
      .position = {m[3] + 0.0, m[7] + 0.0, m[11] + 0.0},
      .lens_radius = camera->lens_radius,
      .inv_focus = 1.0 / camera->focus_distance,
      .shutter_open = camera->shutter_open,
      .shutter_time = camera->shutter_close - camera->shutter_open,
      .near_plane = camera->near_plane,
      .far_plane = camera->far_plane,
  };
  bool perspective = camera->projection == VL_PROJECTION_PERSPECTIVE;
  bool orthographic = camera->projection == VL_PROJECTION_ORTHOGRAPHIC;
  c->plain = orthographic || (perspective && camera->distortion.steps == 0);
  c->inclined = perspective;
  c->fx = camera->fx;
  c->fy = camera->fy;
  c->skew = camera->skew;
  c->shape[0] = camera->shape[0];
  c->shape[1] = camera->shape[1];
  if (camera->projection == VL_PROJECTION_FOV) {
    vlSinCosDouble half = vl_sincos_double(0.5 * camera->shape[0]);
    c->shape[1] = 2.0 * half.sin / half.cos;
  }
  c->over_x = overhang * c->inv_fx;
  c->over_y = overhang * c->inv_fy;
  if (camera->projection == VL_PROJECTION_EQUAL_AREA)
    c->over_x = c->over_x > c->over_y ? c->over_x : c->over_y;
  c->limit2 = camera->limit * camera->limit;
  c->distortion = camera->distortion;
  c->eye_circle = camera->eye_circle;
  c->own = camera->own;
  for (int i = 0; i < 2; i++)
    c->own_size[i] = (uint32_t)camera->own_size[i];
  c->own_from = 0.0;
  c->own_clock = 1.0;
  compile_lens(camera, c);
  vl_camera_compile_time(camera, &c->when);
  memcpy(c->camera_from_world, camera->camera_from_world, sizeof c->camera_from_world);
  measure_pixels(camera, c);
}
