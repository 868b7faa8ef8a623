/* camera/points.c: film points to directions and points in camera space to film points, one at
 * a time, and the solid angles of pixels. */
#include <math.h>

#include "camera/optics.h"
#include "camera/own.h"
#include "camera/points.h"
#include "camera/pose.h"
#include "math/double3.h"

vlDirection vl_camera_direction(const vlCameraCompiled *c, double x, double y) {
  if (c->own) {
    vlOwnRows rows;
    vlWorldRay w;
    double film_x = x + c->cx, film_y = y + c->cy;
    vl_own_chief_rays(c, 1, &film_x, &film_y, &rows);
    double valid = vl_own_ray_at(c, &rows, 0, &w) ? 1.0 : 0.0;
    return (vlDirection){rows.dx[0], rows.dy[0], rows.dz[0], valid};
  }
  if (c->optics) {
    vlCameraLocal r = {0.0, 0.0, 0.0, 0.0, 1.0};
    bool valid = vl_optics_unproject(c->optics, c->pitch * x, c->pitch * y, &r);
    return (vlDirection){r.dx, r.dy, r.dz, valid ? 1.0 : 0.0};
  }
  vlPlanePoint p = vl_pixel_to_plane(c, x, y);
  double face = vl_cube_cell(p.x, p.y);
  const vlDistortionMap *m = &c->distortion;
  double valid = 1.0;
  if (m->steps > 0) {
    vlPlanePoint flat = vl_tilt(m->untilt, p.x, p.y);
    p = vl_distortion_start(m, flat.x, flat.y);
    for (uint32_t step = 0; step < m->steps; step++)
      p = vl_distortion_step(m->radial_first, m, p.x, p.y, flat.x, flat.y);
    valid = flat.valid * vl_distortion_check(m->radial_first, m, p.x, p.y, flat.x, flat.y);
    if (flat.valid > 0.0 && !(valid > 0.0)) {
      p = vl_distortion_invert(m, flat.x, flat.y);
      valid = p.valid;
    }
  }
  vlDirection d = vl_plane_unproject(c->projection, c, face, p.x, p.y);
  return vl_direction_finish(c->inclined, d, valid);
}

vlPlanePoint vl_camera_film_point(const vlCameraCompiled *c, double x, double y, double z) {
  if (c->own) {
    vlPlanePoint film;
    vl_own_pixels(c, 1, &x, &y, &z, &film.x, &film.y);
    film.valid = film.x == film.x ? 1.0 : 0.0;
    return film;
  }
  if (c->optics) {
    double film[2] = {0.0, 0.0};
    bool valid = vl_optics_project(c->optics, x, y, z, film);
    return (vlPlanePoint){valid ? film[0] / c->pitch + c->cx : 0.0,
                          valid ? film[1] / c->pitch + c->cy : 0.0, valid ? 1.0 : 0.0};
  }
  vlDirection d = {x, y, z, 1.0};
  if (c->eye_circle != 0.0)
    d = vl_eye_direction(c->eye_circle, x, y, z);
  vlPlanePoint p = vl_plane_project(c->projection, c, d.x, d.y, d.z);
  p.valid *= d.valid;
  if (c->distortion.steps > 0) {
    vlPlanePoint bent =
        vl_distortion_apply(c->distortion.radial_first, &c->distortion, p.x, p.y);
    bent.valid *= p.valid;
    p = bent;
  }
  return vl_plane_to_pixel(c, p);
}

/* Derivatives of the direction by fourth-order central differences. The steps balance
 * truncation (1e-10 for usual lenses) against rounding. */
static bool slope(const vlCameraCompiled *c, double x, double y, double hx, double hy,
                  double d[3]) {
  static const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12},
                      at[4] = {-2, -1, 1, 2};
  d[0] = d[1] = d[2] = 0.0;
  for (int i = 0; i < 4; i++) {
    vlDirection r = vl_camera_direction(c, x + at[i] * hx, y + at[i] * hy);
    double k = weight[i] / (vl_length_3d(r.x, r.y, r.z) * (hx + hy));
    if (r.valid == 0.0)
      return false;
    d[0] += k * r.x;
    d[1] += k * r.y;
    d[2] += k * r.z;
  }
  return true;
}

double vl_camera_solid_angle(const vlCamera *camera, double x, double y) {
  if (!camera || camera->projection == VL_PROJECTION_ORTHOGRAPHIC || !isfinite(x) ||
      !isfinite(y))
    return 0.0;
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  double px = x - c.cx, py = y - c.cy, a[3], b[3];
  vlDirection d = vl_camera_direction(&c, px, py);
  if (d.valid == 0.0)
    return 0.0;
  /* plane units: 1/10000 of a focal length, smaller near the border of the domain. Truncation
   * h^4 and rounding 1e-16 / h are both about 1e-12 to 1e-16; below 1e-7 rounding exceeds
   * 1e-9. */
  for (double h = 1e-4; h > 1e-7; h *= 0.1) {
    if (!slope(&c, px, py, h * c.fx, 0.0, a) || !slope(&c, px, py, 0.0, h * c.fy, b))
      continue;
    double length = vl_length_3d(d.x, d.y, d.z);
    return fabs(vl_triple3((const double[3]){d.x, d.y, d.z}, a, b)) / length;
  }
  return 0.0;
}
