/* render/camera_view.c: see camera_view.h. */
#include "render/camera_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "camera/rays.h"
#include "math/double3.h"
#include "render/own_view.h"
#include "velo/render.h"

/* Length of the camera's axes if all have the same length and are at right angles; else 0. */
static double axes_length(const double m[16]) {
  double length2[3];
  for (int i = 0; i < 3; i++)
    length2[i] = vl_dot_columns(m, i, i);
  for (int i = 0; i < 3; i++) {
    double dot = vl_dot_columns(m, i, (i + 1) % 3);
    if (fabs(dot) > 1e-5 * length2[0] || fabs(length2[i] - length2[0]) > 1e-5 * length2[0])
      return 0;
  }
  return sqrt(length2[0]);
}

static vlVec3 axis(const double m[16], int i, double length) {
  return (vlVec3){(float)(m[i] / length), (float)(m[4 + i] / length),
                  (float)(m[8 + i] / length)};
}

void vl_camera_view(const vlCamera *camera, const vlFilmDef *film, vlCameraView *view) {
  memset(view, 0, sizeof *view);
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  const double *m = camera->world_from_camera;
  double s = axes_length(m);
  view->sees = c.projection == VL_PROJECTION_PERSPECTIVE && c.plain && !c.shaped &&
               !vl_camera_weighted(&c) && c.eye_circle == 0.0 && camera->skew == 0.0 && s > 0;
  if (c.when.moves && fabs(axes_length(camera->world_from_camera_close) - s) > 1e-5 * s)
    view->sees = false;
  view->low_x = (float)film->crop[0] - film->filter.radius_x;
  view->high_x = (float)film->crop[2] + film->filter.radius_x;
  view->low_y = (float)film->crop[1] - film->filter.radius_y;
  view->high_y = (float)film->crop[3] + film->filter.radius_y;
  vl_own_view(&c, film, view);
  if (!view->sees || view->look)
    return;
  view->position = (vlVec3){(float)m[3], (float)m[7], (float)m[11]};
  view->right = axis(m, 0, s);
  view->down = axis(m, 1, s);
  view->ahead = axis(m, 2, s);
  view->fx = (float)camera->fx;
  view->fy = (float)camera->fy;
  view->cx = (float)camera->cx;
  view->cy = (float)camera->cy;
  view->lens_radius = (float)(camera->lens_radius * s);
  view->focus = (float)(camera->focus_distance * s);
  view->near_plane = (float)(camera->near_plane * s);
  view->far_plane = (float)(camera->far_plane * s);
}

void vl_camera_view_move(vlCameraView *view, vlAffine at) {
  const double *m = at.m;
  double s = 1 / sqrt(m[0] * m[0] + m[3] * m[3] + m[6] * m[6]);
  view->position = (vlVec3){(float)at.p[0], (float)at.p[1], (float)at.p[2]};
  view->right = (vlVec3){(float)(m[0] * s), (float)(m[3] * s), (float)(m[6] * s)};
  view->down = (vlVec3){(float)(m[1] * s), (float)(m[4] * s), (float)(m[7] * s)};
  view->ahead = (vlVec3){(float)(m[2] * s), (float)(m[5] * s), (float)(m[8] * s)};
}

vlCamera vl_opening_pinhole(const vlCamera *camera) {
  vlCamera pinhole = *camera;
  pinhole.lens_radius = 0;
  pinhole.moves = false;
  return pinhole;
}

vlResult vl_first_hits(const vlWorld *world, vlIsa isa, vlGroundTruthBatch *batch,
                       vlError *error) {
  vlGroundTruthScratch *scratch =
      vl_alloc_zero(world->context, 1, vl_ground_truth_scratch_size());
  vlGroundTruthDef def = {.isa = isa};
  if (!scratch)
    return vl_fail_memory(error);
  vl_ground_truth_plan_albedo(world, VL_SPACE_SRGB, &def);
  unsigned state = vl_accel_enter();
  vl_ground_truth_kernels(isa)->trace(world, &def, scratch, batch);
  vl_accel_leave(state);
  vl_free(world->context, scratch);
  return VL_OK;
}

bool vl_pinhole_ray(const vlCamera *pinhole, int side, int i, double origin[3],
                    double direction[3]) {
  double x = (i % side + 0.5) / side * pinhole->width;
  double y = (i / side + 0.5) / side * pinhole->height;
  return vl_camera_unproject(pinhole, x, y, origin, direction);
}

vlResult vl_first_radius(const vlWorld *world, const vlCamera *camera, const vlTraceDef *trace,
                         float *radius, vlError *error) {
  enum { SIDE = 16 };
  *radius = 0;
  vlCamera pinhole = vl_opening_pinhole(camera);
  vlGroundTruthBatch *batch = vl_alloc_zero(world->context, 1, sizeof *batch);
  vlResult result = batch ? VL_OK : vl_fail_memory(error);
  if (result == VL_OK) {
    for (int i = 0; i < SIDE * SIDE; i++) {
      double o[3], d[3];
      if (!vl_pinhole_ray(&pinhole, SIDE, i, o, d))
        continue;
      for (int k = 0; k < 3; k++) {
        batch->o[k][batch->n] = o[k];
        batch->d[k][batch->n] = d[k];
      }
      batch->t_max[batch->n++] = VL_INFINITY;
    }
    result = vl_first_hits(world, trace->isa, batch, error);
  }
  if (result == VL_OK) {
    double t[SIDE * SIDE];
    uint32_t count = 0;
    for (uint32_t i = 0; i < batch->n; i++)
      if (batch->object[i] && isfinite(batch->distance[i]))
        t[count++] = batch->distance[i];
    qsort(t, count, sizeof *t, vl_by_value);
    vlCameraCompiled c;
    vl_camera_compile(camera, &c);
    if (count)
      *radius = 2.0f * (c.pixel_width + c.pixel_spread * (float)t[count / 2]);
    if (!(*radius < VL_INFINITY))
      *radius = 0;
  }
  vl_free(world->context, batch);
  return result;
}
