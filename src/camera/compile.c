/* camera/compile.c: converts a vlCamera (public value) to a vlCameraCompiled (input of the
 * batches). */
#include <math.h>
#include <string.h>

#include "camera/optics.h"
#include "camera/parts.h"
#include "camera/rays.h"
#include "math/approx_double.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "projection/properties.row.h"
#include "velo/projection.h"

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
  double size =
      1.0 /
      sqrt(camera->fx * camera->fy); /* a pixel's side at z = 1, or its width in camera units */
  if (perspective) {
    c->pixel_spread = (float)size;
  } else if (orthographic) {
    c->pixel_width = (float)(size * scale_of(m));
  } else if (c->own) {
    c->pixel_spread = (float)(size * camera->own_pixel[0]);
    c->pixel_width = (float)(size * camera->own_pixel[1] * scale_of(m));
  } else {
    c->pixel_spread = (float)central_spread(c);
  }
}
