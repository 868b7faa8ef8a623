/* camera/project.c: the public functions for film points to rays and points to film points,
 * single and in arrays, of cameras at rest and in motion. */
#include <math.h>
#include <string.h>

#include "camera/moments.h"
#include "camera/optics.h"
#include "camera/own.h"
#include "camera/points.h"
#include "camera/pose.h"
#include "math/double3.h"
#include "projection/orthographic.h"
#include "projection/perspective.h"

static vlCameraLocal local_ray(const vlCameraCompiled *c, double x, double y, double *valid) {
  *valid = 1.0;
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return vl_orthographic_unproject(c, x, y);
  if (c->plain)
    return vl_perspective_unproject(c, x, y);
  if (c->optics) {
    vlCameraLocal r = {0.0, 0.0, 0.0, 0.0, 1.0};
    *valid = vl_optics_unproject(c->optics, c->pitch * x, c->pitch * y, &r) ? 1.0 : 0.0;
    return r;
  }
  vlDirection d = vl_camera_direction(c, x, y);
  *valid = d.valid;
  return (vlCameraLocal){0.0, 0.0, d.x, d.y, d.z};
}

static bool is_finite_ray(const vlCameraCompiled *c, double x, double y) {
  double valid;
  vlCameraLocal r = local_ray(c, x - c->cx, y - c->cy, &valid);
  if (valid == 0.0)
    return true;
  vlWorldRay w = vl_camera_to_world(c, r);
  float sum = (float)w.ox + (float)w.oy + (float)w.oz;
  return isfinite(sum) && isfinite(w.length) && isfinite(w.inv_length);
}

bool vl_camera_rays_are_finite(const vlCamera *camera) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  if (c.own)
    return true;
  bool finite = is_finite_ray(&c, 0.5 * camera->width, 0.5 * camera->height);
  for (int i = 0; i < 4; i++)
    finite =
        finite && is_finite_ray(&c, i & 1 ? camera->width : 0.0, i & 2 ? camera->height : 0.0);
  return finite;
}

/* The ray of a camera at rest. */
static bool unproject_one(const vlCameraCompiled *c, double x, double y, double origin[3],
                          double direction[3]) {
  vlWorldRay w;
  if (!isfinite(x) || !isfinite(y))
    return false;
  if (c->own) {
    vlOwnRows rows;
    vl_own_chief_rays(c, 1, &x, &y, &rows);
    if (!vl_own_ray_at(c, &rows, 0, &w))
      return false;
  } else {
    double valid;
    vlCameraLocal r = local_ray(c, x - c->cx, y - c->cy, &valid);
    if (valid == 0.0)
      return false;
    w = vl_camera_to_world(c, r);
    if (c->eye_circle != 0.0)
      w = vl_camera_offset_eye(c, vl_eye_offset(c->eye_circle, r.dx, r.dz), w);
  }
  origin[0] = w.ox;
  origin[1] = w.oy;
  origin[2] = w.oz;
  direction[0] = w.dx * w.inv_length;
  direction[1] = w.dy * w.inv_length;
  direction[2] = w.dz * w.inv_length;
  return isfinite(direction[0]) && isfinite(direction[1]) && isfinite(direction[2]);
}

bool vl_camera_unproject(const vlCamera *camera, double x, double y, double origin[3],
                         double direction[3]) {
  if (!camera)
    return false;
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  if (c.when.moves)
    vl_camera_hold(&c, vl_camera_film_time(&c, x, y));
  return unproject_one(&c, x, y, origin, direction);
}

/* The film point of a camera at rest. */
static bool project_one(const vlCameraCompiled *c, const double point[3], double pixel[2],
                        double *z) {
  double at[3];
  vl_map_point(c->camera_from_world, point, at);
  vlPlanePoint f = vl_camera_film_point(c, at[0], at[1], at[2]);
  if (!(f.valid > 0.0))
    return false;
  pixel[0] = f.x;
  pixel[1] = f.y;
  if (z)
    *z = at[2];
  return true;
}

bool vl_camera_project(const vlCamera *camera, const double point[3], double pixel[2],
                       double *z) {
  if (!camera)
    return false;
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  if (c.when.moves && !vl_camera_hold_at_point(&c, point))
    return false;
  return project_one(&c, point, pixel, z);
}

const vlCameraKernels *vl_camera_best_kernels(void) {
  vlIsa isa;
  return vl_camera_kernels(vl_isa_choose(VL_ISA_AUTO, &isa) == VL_OK ? isa : VL_ISA_BASE);
}

/* Compiles a camera, and holds a moving one whose points have one time. Whether points have
 * times of their own. */
static bool has_times(const vlCamera *camera, vlCameraCompiled *c) {
  vl_camera_compile(camera, c);
  if (c->when.moves && vl_camera_has_one_time(c))
    vl_camera_hold(c, vl_camera_film_time(c, 0.0, 0.0));
  return c->when.moves;
}

static void unproject_rows(const vlCameraCompiled *c, size_t count, const double *pixels,
                           double *origins, double *directions, uint8_t *valid) {
  for (size_t i = 0; i < count; i++) {
    const double *p = pixels + 2 * i;
    double o[3] = {0.0, 0.0, 0.0}, d[3] = {0.0, 0.0, 0.0};
    vlCameraCompiled held = *c;
    vl_camera_hold(&held, vl_camera_film_time(c, p[0], p[1]));
    bool good = unproject_one(&held, p[0], p[1], o, d);
    for (size_t k = 0; k < 3; k++) {
      directions[3 * i + k] = good ? d[k] : 0.0;
      if (origins)
        origins[3 * i + k] = good ? o[k] : 0.0;
    }
    if (valid)
      valid[i] = good;
  }
}

static void project_rows(const vlCameraCompiled *c, size_t count, const double *points,
                         double *pixels, double *z, uint8_t *valid) {
  for (size_t i = 0; i < count; i++) {
    const double *p = points + 3 * i;
    double film[2] = {0.0, 0.0}, depth = 0.0;
    vlCameraCompiled held = *c;
    bool good = vl_camera_hold_at_point(&held, p) && project_one(&held, p, film, &depth);
    memcpy(pixels + 2 * i, film, sizeof film);
    if (z)
      z[i] = depth;
    if (valid)
      valid[i] = good;
  }
}

/* Loads a chunk of `count` points from the one at `first` on, of `size` numbers each, into
 * rows. The last one fills the padding. Returns the number of points. */
static uint32_t load_chunk(size_t count, size_t first, size_t size, const double *points,
                           double *const rows[]) {
  const uint32_t n =
      count - first < VL_CAMERA_CHUNK ? (uint32_t)(count - first) : VL_CAMERA_CHUNK;
  for (uint32_t i = 0; i < VL_PAD(n); i++)
    for (size_t k = 0; k < size; k++)
      rows[k][i] = points[size * (first + (i < n ? i : n - 1)) + k];
  return n;
}

void vl_camera_film_times(const vlCamera *camera, size_t count, const double *pixels,
                          double *times) {
  if (!camera || !pixels || !times)
    return;
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  for (size_t i = 0; i < count; i++)
    times[i] = vl_camera_film_time(&c, pixels[2 * i], pixels[2 * i + 1]);
}

void vl_camera_unproject_batch(const vlCamera *camera, size_t count, const double *pixels,
                               double *origins, double *directions, uint8_t *valid) {
  if (!camera)
    return;
  vlCameraCompiled c;
  vlCameraPixels in;
  vlCameraPoints out;
  if (has_times(camera, &c)) {
    unproject_rows(&c, count, pixels, origins, directions, valid);
    return;
  }
  const vlCameraKernels *k = vl_camera_best_kernels();
  for (size_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = load_chunk(count, first, 2, pixels, (double *const[]){in.x, in.y});
    k->unproject(&c, n, &in, &out);
    for (uint32_t i = 0; i < n; i++) {
      double *d = directions + 3 * (first + i);
      d[0] = out.x[i];
      d[1] = out.y[i];
      d[2] = out.z[i];
      if (origins) {
        double *o = origins + 3 * (first + i);
        o[0] = out.ox[i];
        o[1] = out.oy[i];
        o[2] = out.oz[i];
      }
      if (valid)
        valid[first + i] = out.valid[i] > 0.0;
    }
  }
}

void vl_camera_project_batch(const vlCamera *camera, size_t count, const double *points,
                             double *pixels, double *z, uint8_t *valid) {
  if (!camera)
    return;
  vlCameraCompiled c;
  vlCameraPoints in;
  vlCameraPixels out;
  if (has_times(camera, &c)) {
    project_rows(&c, count, points, pixels, z, valid);
    return;
  }
  const vlCameraKernels *k = vl_camera_best_kernels();
  for (size_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = load_chunk(count, first, 3, points, (double *const[]){in.x, in.y, in.z});
    k->project(&c, n, &in, &out);
    for (uint32_t i = 0; i < n; i++) {
      pixels[2 * (first + i)] = out.x[i];
      pixels[2 * (first + i) + 1] = out.y[i];
      if (z)
        z[first + i] = out.z[i];
      if (valid)
        valid[first + i] = out.valid[i] > 0.0;
    }
  }
}
