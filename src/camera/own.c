/* camera/own.c: see own.h. */
#include "camera/own.h"

#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "math/double3.h"
#include "velo/distortion.h"
#include "velo/projection.h"

void vl_own_rays(const vlCameraCompiled *c, uint32_t n, vlOwnRows *r) {
  const size_t size = VL_PAD(n) * sizeof(double);
  double *const zero[] = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz};
  for (size_t i = 0; i < VL_LENGTH(zero); i++)
    memset(zero[i], 0, size);
  for (uint32_t i = 0; i < VL_PAD(n); i++)
    r->weight[i] = 1.0;
  const vlOwnFilmPoints points = {n,    c->own_size[0], c->own_size[1], r->x,
                                  r->y, r->lens_u,      r->lens_v,      r->time};
  const vlOwnRays rays = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz, r->weight};
  c->own->rays(c->own->user, &points, &rays);
}

void vl_own_chief_rays(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                       vlOwnRows *r) {
  double time = c->own_from + c->own_clock * c->shutter_open;
  for (uint32_t i = 0; i < n; i++) {
    r->x[i] = (x[i] - c->cx) * c->inv_fx;
    r->y[i] = (y[i] - c->cy) * c->inv_fy;
    r->lens_u[i] = r->lens_v[i] = 0.5;
    r->time[i] = time;
  }
  vl_own_rays(c, n, r);
}

void vl_own_pixels(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                   const double *z, double *film_x, double *film_y) {
  for (uint32_t i = 0; i < n; i++)
    film_x[i] = film_y[i] = (double)NAN;
  if (!c->own->pixels)
    return;
  const vlOwnSpacePoints points = {n, c->own_size[0], c->own_size[1], x, y, z, film_x, film_y};
  c->own->pixels(c->own->user, &points);
  for (uint32_t i = 0; i < n; i++) {
    film_x[i] = c->fx * film_x[i] + c->cx;
    film_y[i] = c->fy * film_y[i] + c->cy;
    if (!isfinite(film_x[i] + film_y[i]))
      film_x[i] = film_y[i] = (double)NAN;
  }
}

bool vl_own_ray_at(const vlCameraCompiled *c, const vlOwnRows *r, uint32_t i, vlWorldRay *ray) {
  *ray = vl_own_to_world(c, r->ox[i], r->oy[i], r->oz[i], r->dx[i], r->dy[i], r->dz[i]);
  double sum =
      ray->dx * ray->inv_length + ray->dy * ray->inv_length + ray->dz * ray->inv_length;
  return ray->length > 0.0 && isfinite(sum) && isfinite(ray->ox + ray->oy + ray->oz);
}

void vl_own_world_rays(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                       vlOwnRay *rays) {
  vlOwnRows rows;
  vl_own_chief_rays(c, n, x, y, &rows);
  for (uint32_t i = 0; i < n; i++) {
    vlWorldRay w;
    vlOwnRay *r = &rays[i];
    r->good = vl_own_ray_at(c, &rows, i, &w);
    if (!r->good)
      continue;
    const double o[3] = {w.ox, w.oy, w.oz},
                 d[3] = {w.dx * w.inv_length, w.dy * w.inv_length, w.dz * w.inv_length};
    memcpy(r->o, o, sizeof o);
    memcpy(r->d, d, sizeof d);
    r->stretch = w.length / vl_length_3d(rows.dx[i], rows.dy[i], rows.dz[i]);
    r->weight = rows.weight[i];
  }
}

/* ---- making ------------------------------------------------------------------------------ */

static bool is_name(const char *name) {
  size_t size = name ? strlen(name) : 0;
  if (size == 0 || size >= VL_OWN_NAME || !vl_is_utf8(name))
    return false;
  for (size_t i = 0; i < size; i++)
    if ((unsigned char)name[i] < ' ' || name[i] == 127)
      return false;
  return true;
}

vlResult vl_own_check(const char *what, const char *name, bool has_function, vlError *error) {
  if (!is_name(name))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "own %s: its name \"%s\" is not UTF-8 of 1 to %d bytes without control characters",
        what, vl_short_text(name).text, VL_OWN_NAME - 1);
  if (!has_function)
    return vl_fail_argument(error, "own %s \"%s\": its function is null", what, name);
  return VL_OK;
}

/* The side of the central pixel, by differences: rays at 1/256 of a pixel around it. */
static void measure_pixel(const vlCamera *camera, vlOwnRows *rows, double pixel[2]) {
  const double h = 1.0 / 256, x = 0.5 * camera->width, y = 0.5 * camera->height;
  const double film_x[4] = {x - h, x + h, x, x}, film_y[4] = {y, y, y - h, y + h};
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  vl_own_chief_rays(&c, 4, film_x, film_y, rows);
  double d[4][3], o[4][3];
  for (int i = 0; i < 4; i++) {
    double inv = 1.0 / vl_length_3d(rows->dx[i], rows->dy[i], rows->dz[i]);
    d[i][0] = rows->dx[i] * inv;
    d[i][1] = rows->dy[i] * inv;
    d[i][2] = rows->dz[i] * inv;
    o[i][0] = rows->ox[i];
    o[i][1] = rows->oy[i];
    o[i][2] = rows->oz[i];
  }
  for (int k = 0; k < 2; k++) {
    double a[3], b[3], n[3];
    for (int i = 0; i < 3; i++) {
      a[i] = k ? o[1][i] - o[0][i] : d[1][i] - d[0][i];
      b[i] = k ? o[3][i] - o[2][i] : d[3][i] - d[2][i];
    }
    vl_cross3(a, b, n);
    double area = vl_norm3(n);
    double side = sqrt(area) / (2.0 * h);
    pixel[k] = isfinite(side) ? side : 0.0;
  }
}

vlCameraDef vl_camera_own_def(const vlCameraDef *def) {
  const vlCameraDef standard = vl_default_camera_def(def->width, def->height);
  vlCameraDef own = *def;
  own.projection = VL_PROJECTION_OWN;
  own.fov = own.view_distance = own.zoom = own.pixel_size = own.focal_mm = own.sensor_width_mm =
      VL_UNSET;
  own.fx = own.fy = own.skew = own.cx = own.cy = VL_UNSET;
  own.screen_min_x = own.screen_max_x = own.screen_min_y = own.screen_max_y = VL_UNSET;
  own.shape[0] = own.shape[1] = own.max_angle = own.focus_distance = VL_UNSET;
  own.lens_radius = 0.0;
  own.lens = standard.lens;
  own.distortion = VL_DISTORTION_NONE;
  own.distortion_count = 0;
  return own;
}

vlResult vl_camera_own(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  if (def->projection != VL_PROJECTION_OWN)
    return VL_OK;
  VL_TRY(vl_own_check("camera", def->own->name, def->own->rays != NULL, error));
  vlOwnRows rows;
  camera->own = def->own;
  camera->own_size[0] = def->width;
  camera->own_size[1] = def->height;
  measure_pixel(camera, &rows, camera->own_pixel);
  return VL_OK;
}

double vl_own_outside(const vlCamera *camera) {
  enum { SIDE = 32 };
  _Static_assert(SIDE * SIDE <= (int)VL_OWN_BATCH, "one call");
  double x[SIDE * SIDE], y[SIDE * SIDE];
  vlOwnRows rows;
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  for (int i = 0; i < SIDE * SIDE; i++) {
    x[i] = camera->width * (i % SIDE + 0.5) / SIDE;
    y[i] = camera->height * (i / SIDE + 0.5) / SIDE;
  }
  vl_own_chief_rays(&c, SIDE * SIDE, x, y, &rows);
  uint32_t outside = 0;
  for (uint32_t i = 0; i < SIDE * SIDE; i++) {
    vlWorldRay ray;
    outside += !vl_own_ray_at(&c, &rows, i, &ray);
  }
  return outside / (double)(SIDE * SIDE);
}
