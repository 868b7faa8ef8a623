/* conformance/camera_rays.h: laws of the rays that cameras give in batches: those of a camera
 * that hardly moves are those of a still one, and those through a focused point meet there. */
#ifndef TEST_CONFORMANCE_CAMERA_RAYS_H
#define TEST_CONFORMANCE_CAMERA_RAYS_H

#include "camera/rays.h"
#include "camera_ways.h"
#include "conformance.h"
#include "unit.h"
#include "velo/camera.h"
#include "velo/projection.h"

/* ---- motion ------------------------------------------------------------------------------ */

typedef struct CameraRays {
  float o[3][WAYS], d[3][WAYS], t_min[WAYS], t_max[WAYS], time[WAYS], valid[WAYS];
} CameraRays;

/* c: the camera, compiled. film: the point that all rays leave; null: they leave many. */
static void rays_of_compiled(const vlCamera *camera, const vlCameraCompiled *c,
                             const double *film, CameraRays *r) {
  static float x[WAYS], y[WAYS], u[WAYS], v[WAYS], time[WAYS];
  static int32_t column[WAYS], row[WAYS];
  for (uint32_t i = 0; i < WAYS; i++) {
    column[i] = film ? (int32_t)floor(film[0]) : (int32_t)(i * 7 % camera->width);
    row[i] = film ? (int32_t)floor(film[1]) : (int32_t)(i * 11 % camera->height);
    x[i] = film ? (float)(film[0] - floor(film[0])) : (float)(i % 5) / 5;
    y[i] = film ? (float)(film[1] - floor(film[1])) : (float)(i % 3) / 3;
    u[i] = (float)(i % 13) / 13;
    v[i] = (float)(i % 17) / 17;
    time[i] = (float)(i % 19) / 19;
  }
  const vlCameraSamples samples = {x, y, column, row, u, v, time};
  const vlCameraRays rays = {r->o[0],  r->o[1],  r->o[2], r->d[0],  r->d[1], r->d[2],
                             r->t_min, r->t_max, r->time, r->valid, NULL};
  vl_camera_kernels(VL_ISA_AUTO)->rays(c, WAYS, &samples, &rays);
}
static void rays_of_film(const vlCamera *camera, const double *film, CameraRays *r) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  rays_of_compiled(camera, &c, film, r);
}

/* Below 0: the lens stops the ray. */
static bool same_length(float a, float b) {
  return a == b || (a < 0 && b < 0) || fabsf(a - b) <= 1e-4f * fabsf(a);
}

/* A camera that hardly moves has the rays of the one that is still, in a frame that is turned
 * and stretched, too, through its lens and between its near and far planes. */
static void check_moving(const char *kind, const vlCameraDef *def) {
  static CameraRays still, moving;
  static const double map[16] = {1.2, 0, 1.6, 3, 0, 2, 0, -2, -1.6, 0, 1.2, 5, 0, 0, 0, 1};
  vlCameraDef changed = *def;
  vlCamera camera;
  uint32_t differ = 0;
  if (def->projection != VL_PROJECTION_OPTICS) {
    changed.lens_radius = 0.05;
    changed.focus_distance = 2;
  }
  changed.near_plane = 0.5;
  changed.far_plane = 3;
  changed.has_matrix = true;
  memcpy(changed.world_from_camera, map, sizeof map);
  assert_int_equal(vl_camera_make(&changed, &camera, NULL, NULL), VL_OK);
  rays_of_film(&camera, NULL, &still);
  changed.has_matrix_close = true;
  memcpy(changed.world_from_camera_close, map, sizeof map);
  changed.world_from_camera_close[3] += 1e-9;
  assert_int_equal(vl_camera_make(&changed, &camera, NULL, NULL), VL_OK);
  assert_true(camera.moves);
  rays_of_film(&camera, NULL, &moving);
  for (uint32_t i = 0; i < WAYS; i++) {
    bool same = still.valid[i] == moving.valid[i] &&
                same_length(still.t_min[i], moving.t_min[i]) &&
                same_length(still.t_max[i], moving.t_max[i]);
    for (int k = 0; k < 3; k++)
      same = same && fabsf(still.o[k][i] - moving.o[k][i]) < 1e-5f &&
             fabsf(still.d[k][i] - moving.d[k][i]) < 1e-5f;
    differ += !same && still.valid[i] > 0;
  }
  if (differ)
    broken("projections", kind, "%u of %u rays are others where the camera moves", differ,
           WAYS);
}

/* Another clock changes the times of rays and nothing else, of a camera that moves while its
 * rows are read, with poses whose times are not the shutter's. */
static void check_clock(const char *kind, const vlCameraDef *def) {
  static CameraRays first, second;
  const double origin = 0.3;
  const double scale = 4;
  vlCameraDef changed = *def;
  vlCamera camera;
  vlCameraCompiled c;
  uint32_t differ = 0;
  changed.has_matrix_close = true;
  memcpy(changed.world_from_camera_close, changed.world_from_camera,
         sizeof changed.world_from_camera);
  changed.world_from_camera_close[3] += 0.5;
  changed.shutter_open = 0.2;
  changed.shutter_close = 0.7;
  changed.readout = 0.25;
  changed.pose_times[0] = 0.1;
  changed.pose_times[1] = 1.1;
  assert_int_equal(vl_camera_make(&changed, &camera, NULL, NULL), VL_OK);
  vl_camera_compile(&camera, &c);
  rays_of_compiled(&camera, &c, NULL, &first);
  vl_camera_retime(&c, origin, scale);
  rays_of_compiled(&camera, &c, NULL, &second);
  for (uint32_t i = 0; i < WAYS; i++) {
    const double time = ((double)first.time[i] - origin) * scale;
    bool same = first.valid[i] == second.valid[i] && fabs((double)second.time[i] - time) < 1e-5;
    for (int k = 0; k < 3; k++)
      same = same && fabsf(first.o[k][i] - second.o[k][i]) < 1e-5f &&
             fabsf(first.d[k][i] - second.d[k][i]) < 1e-5f;
    differ += !same && first.valid[i] > 0;
  }
  if (differ)
    broken("projections", kind, "%u of %u rays are others by another clock", differ, WAYS);
}

/* ---- focus ------------------------------------------------------------------------------- */

/* The largest distance of a point from the rays through the lens that leave its film point. */
static double blur_of_point(const vlCamera *camera, const double point[3]) {
  static CameraRays r;
  double film[2];
  double worst = 0;
  if (!vl_camera_project(camera, point, film, NULL))
    return INFINITY;
  rays_of_film(camera, film, &r);
  for (uint32_t i = 0; i < WAYS; i++) {
    double to[3];
    double along = 0;
    double far2 = 0;
    for (int k = 0; k < 3; k++) {
      to[k] = point[k] - (double)r.o[k][i];
      along += to[k] * (double)r.d[k][i];
    }
    for (int k = 0; k < 3; k++)
      far2 += pow(to[k] - along * (double)r.d[k][i], 2);
    worst = fmax(worst, sqrt(far2));
  }
  return worst;
}

/* The rays of one film point start all over a round opening of this radius: their origins
 * scatter by a quarter of its square along both axes of its plane. */
static void check_opening(const char *kind, const vlCamera *camera, const double point[3],
                          double radius) {
  static CameraRays r;
  double film[2];
  double mean[3] = {0};
  double scatter[3][3] = {{0}};
  double sum = 0;
  double squares = 0;
  if (!vl_camera_project(camera, point, film, NULL))
    return;
  rays_of_film(camera, film, &r);
  for (int k = 0; k < 3; k++)
    for (uint32_t i = 0; i < WAYS; i++)
      mean[k] += (double)r.o[k][i] / WAYS;
  for (uint32_t i = 0; i < WAYS; i++)
    for (int k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++)
        scatter[k][j] += ((double)r.o[k][i] - mean[k]) * ((double)r.o[j][i] - mean[j]) / WAYS;
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++) {
      sum += k == j ? scatter[k][j] : 0;
      squares += scatter[k][j] * scatter[k][j];
    }
  const double along_axis = radius * radius / 4;
  if (!(fabs(sum / (2 * along_axis) - 1) < 0.15) ||
      !(fabs(squares / (2 * along_axis * along_axis) - 1) < 0.3))
    broken("projections", kind, "its rays fill %.2f of a round opening, unevenly by %.2f",
           sum / (2 * along_axis), squares / (2 * along_axis * along_axis));
}

/* The point on which a camera is focused is sharp, beside the axis and with a lens or a plane
 * of focus that is tilted, too. */
static void check_focus_point(const char *kind, const vlCameraDef *def) {
  static const double tilts[4][4] = {
      {0, 0, 0, 0}, {0.2, -0.3, 0, 0}, {0, 0, 0.04, -0.03}, {0, 0, 0, 0.05}};
  static const double point[3] = {0.3, 0.4, 2};
  for (int i = 0; i < 4; i++) {
    vlError error = {0};
    vlCameraDef focused = *def;
    vlCamera camera;
    focused.lens_radius = 0.1;
    focused.focus_distance = VL_UNSET;
    memcpy(focused.lens.focus_point, point, sizeof point);
    focused.lens.tilt_x = tilts[i][0];
    focused.lens.tilt_y = tilts[i][1];
    focused.lens.lens_tilt_x = tilts[i][2];
    focused.lens.lens_tilt_y = tilts[i][3];
    focused.focal_mm = i > 1 ? 50 : focused.focal_mm;
    if (vl_camera_make(&focused, &camera, NULL, &error) != VL_OK) {
      if (i == 0 || def->projection == VL_PROJECTION_PERSPECTIVE) /* others have no tilts */
        broken("projections", kind, "focused on a point: %s", error.message);
      continue;
    }
    if (i == 0)
      check_opening(kind, &camera, point, focused.lens_radius);
    const double blur = blur_of_point(&camera, point);
    if (!(blur < 1e-4))
      broken("projections", kind, "tilt %d: the point in focus is blurred by %.5f", i, blur);
  }
}

#endif
