/* camera/vanishing.c: vanishing points of a camera, and a camera from vanishing points (Hartley
 * and Zisserman, Multiple View Geometry, 8.6 and 8.8: the viewing rays of vanishing points of
 * orthogonal directions are orthogonal). */
#include <math.h>

#include "base/cookie.h"
#include "base/error.h"
#include "camera/parts.h"
#include "camera/points.h"
#include "math/double3.h"
#include "velo/vanishing.h"

/* Vanishing points farther than this many focal lengths count as infinite: their directions are
 * within 1e-9 radians of parallel to the view plane. */
static const double infinitely_far = 1e9;
static const double agreement = 1e-6; /* in focal lengths; values written with 7 digits agree */

static bool direction_of(const vlCamera *c, const double d[3], double v[3]) {
  double length = 0.0;
  vl_map_vector(c->camera_from_world, d, v);
  for (int i = 0; i < 3; i++)
    length = fmax(length, fabs(v[i]));
  if (!(length > 0.0) || isinf(length))
    return false;
  for (int i = 0; i < 3; i++)
    v[i] /= length;
  return true;
}

bool vl_camera_vanishing_point(const vlCamera *camera, const double direction[3],
                               vlVanishingPoint *point) {
  double v[3];
  if (!camera || !direction || !point || !direction_of(camera, direction, v))
    return false;
  bool flat = camera->projection == VL_PROJECTION_ORTHOGRAPHIC;
  bool perspective = camera->projection == VL_PROJECTION_PERSPECTIVE;
  *point = (vlVanishingPoint){.kind = VL_VANISHING_NONE};
  double across = vl_length_2d(v[0], v[1]);
  if (flat || (perspective && fabs(v[2]) * infinitely_far <= across)) {
    double x = camera->fx * v[0] + camera->skew * v[1], y = camera->fy * v[1],
           length = vl_length_2d(x, y);
    if (across * infinitely_far <= fabs(v[2]))
      return true; /* orthographic, seen end on */
    point->kind = VL_VANISHING_INFINITE;
    point->direction[0] = x / length + 0.0;
    point->direction[1] = y / length + 0.0;
    return true;
  }
  point->behind = perspective && v[2] < 0.0;
  for (int i = 0; i < 3 && point->behind; i++)
    v[i] = -v[i];
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  vlPlanePoint p = vl_camera_film_point(&c, v[0], v[1], v[2]);
  if (!(p.valid > 0.0))
    return true;
  point->kind = VL_VANISHING_FINITE;
  point->pixel[0] = p.x;
  point->pixel[1] = p.y;
  return true;
}

bool vl_camera_vanishing_points(const vlCamera *camera, const double up[3],
                                vlVanishingPoints *points) {
  double n[3] = {0, 0, 0}, largest = 0.0;
  if (!camera || !up || !points)
    return false;
  *points = (vlVanishingPoints){.finite = 0};
  for (int i = 0; i < 3; i++) {
    const double axis[3] = {i == 0, i == 1, i == 2}, other[3] = {-axis[0], -axis[1], -axis[2]};
    vl_camera_vanishing_point(camera, axis, &points->axes[i]);
    if (points->axes[i].kind == VL_VANISHING_NONE &&
        camera->projection != VL_PROJECTION_ORTHOGRAPHIC &&
        vl_camera_vanishing_point(camera, other, &points->axes[i]))
      points->axes[i].behind = points->axes[i].kind == VL_VANISHING_FINITE;
    points->finite += points->axes[i].kind == VL_VANISHING_FINITE;
  }
  if (camera->projection != VL_PROJECTION_PERSPECTIVE)
    points->finite = 0;
  /* Normals transform by the transpose: in camera space n = W^T up. */
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++)
      n[i] += camera->world_from_camera[4 * k + i] * up[k];
    largest = fmax(largest, fabs(n[i]));
  }
  if (!(largest > 0.0) || isinf(largest))
    return false;
  if (camera->projection != VL_PROJECTION_PERSPECTIVE || camera->distortion.steps > 0)
    return true;
  if (vl_length_2d(n[0], n[1]) * infinitely_far <= fabs(n[2]))
    return true;
  /* n . K^-1 (x, y, 1) = 0 */
  double a = n[0] / camera->fx, b = (n[1] - a * camera->skew) / camera->fy,
         length = vl_length_2d(a, b);
  points->has_horizon = true;
  points->horizon[0] = a / length + 0.0;
  points->horizon[1] = b / length + 0.0;
  points->horizon[2] = (n[2] - a * camera->cx - b * camera->cy) / length + 0.0;
  return true;
}

/* ---- the inverse ------------------------------------------------------------------------- */

vlVanishingDef vl_default_vanishing_def(uint32_t width, uint32_t height) {
  return (vlVanishingDef){.cookie = VL_COOKIE_VANISHING,
                          .width = width,
                          .height = height,
                          .count = 2,
                          .axes = {0, 2, 1},
                          .away = {true, true, true},
                          .cx = VL_UNSET,
                          .cy = VL_UNSET};
}

static vlResult check(const vlVanishingDef *d, vlError *error) {
  if (d->cookie != VL_COOKIE_VANISHING)
    return vl_fail_argument(error, "vanishing points: " VL_BAD_COOKIE);
  if (d->count != 2 && d->count != 3)
    return vl_fail_argument(error, "vanishing points: %u are given; a camera needs 2 or 3",
                            d->count);
  for (uint32_t i = 0; i < d->count; i++) {
    if (!isfinite(d->points[i][0]) || !isfinite(d->points[i][1]) ||
        fabs(d->points[i][0]) > 1e100 || fabs(d->points[i][1]) > 1e100)
      return vl_fail_argument(error, "vanishing points: number %u is not finite", i + 1);
    for (uint32_t k = 0; k < i; k++)
      if (d->axes[i] == d->axes[k])
        return vl_fail_argument(
            error, "vanishing points: numbers %u and %u are of the same axis", k + 1, i + 1);
    if (d->axes[i] > 2)
      return vl_fail_argument(error, "vanishing points: an axis is 0, 1 or 2");
  }
  if (vl_is_unset(d->cx) != vl_is_unset(d->cy) || isinf(d->cx) || isinf(d->cy))
    return vl_fail_argument(error, "vanishing points: the principal point is (%g, %g)", d->cx,
                            d->cy);
  return VL_OK;
}

/* Orthocentre of the triangle: the principal point (Caprile and Torre 1990). Relative to the
 * first corner, so that a distant corner costs little precision. */
static vlResult orthocentre(const vlVanishingDef *d, double p[2], vlError *error) {
  const double *a = d->points[0];
  double b[2] = {d->points[1][0] - a[0], d->points[1][1] - a[1]},
         c[2] = {d->points[2][0] - a[0], d->points[2][1] - a[1]};
  double cross = b[0] * c[1] - b[1] * c[0], dot = b[0] * c[0] + b[1] * c[1];
  double size = fmax(fmax(fabs(b[0]), fabs(b[1])), fmax(fabs(c[0]), fabs(c[1])));
  if (!(fabs(cross) > 1e-12 * size * size)) /* sine of the angle between two sides, nearly */
    return vl_fail_argument(error,
                            "vanishing points: the three lie on one line; no camera has such");
  /* h . (c - b) = 0 and h . b = b . c: h is parallel to the normal of c - b */
  p[0] = a[0] + dot * (c[1] - b[1]) / cross;
  p[1] = a[1] - dot * (c[0] - b[0]) / cross;
  return VL_OK;
}

/* The focal length in pixels: seen from the principal point p, the points are at right angles
 * to each other. */
static vlResult focal_length(const vlVanishingDef *def, const double p[2], double *f,
                             vlError *error) {
  const uint32_t pairs = def->count == 3 ? 3 : 1;
  double f2 = 0.0, min = INFINITY; /* of the three equal values, the one with the smallest
                                        terms has the least rounding error */
  for (uint32_t i = 0; i < pairs; i++) {
    const double *a = def->points[i], *b = def->points[(i + 1) % def->count];
    double x = (a[0] - p[0]) * (b[0] - p[0]), y = (a[1] - p[1]) * (b[1] - p[1]);
    if (!(x + y < 0.0))
      return vl_fail(
          error, VL_ERROR_ARGUMENT,
          "vanishing points: seen from the principal point (%.9g, %.9g), numbers %u and %u "
          "are less than 90 degrees apart; directions at right angles are not",
          p[0], p[1], i + 1, (i + 1) % def->count + 1);
    if (fabs(x) + fabs(y) >= min)
      continue;
    min = fabs(x) + fabs(y);
    f2 = -(x + y);
  }
  *f = sqrt(f2);
  if (!(*f > 1e-30 && *f < 1e30))
    return vl_fail_argument(
        error, "vanishing points: a focal length of %g pixels is out of range", *f);
  return VL_OK;
}

/* The directions of the world's axes in camera space: the columns of camera from world. */
static void find_axes(const vlVanishingDef *def, const double p[2], double f,
                      double axes[3][3]) {
  for (int i = 0; i < 2; i++) {
    double *v = axes[def->axes[i]], sign = def->away[i] ? 1.0 : -1.0;
    v[0] = sign * (def->points[i][0] - p[0]);
    v[1] = sign * (def->points[i][1] - p[1]);
    v[2] = sign * f;
    vl_normalize3(v);
  }
  uint32_t first = def->axes[0], second = def->axes[1], third = 3 - first - second;
  if (second == (first + 1) % 3)
    vl_cross3(axes[first], axes[second], axes[third]);
  else
    vl_cross3(axes[second], axes[first], axes[third]);
  vl_normalize3(axes[third]);
  /* orthogonal to the last bit, despite rounding */
  vl_cross3(axes[(second + 1) % 3], axes[(second + 2) % 3], axes[second]);
  vl_normalize3(axes[second]);
}

vlResult vl_camera_from_vanishing_points(const vlVanishingDef *def, vlCameraDef *camera,
                                         vlError *error) {
  vl_error_clear(error);
  if (!def || !camera)
    return vl_fail_argument(error, "vanishing points: def or camera is null");
  double p[2] = {0.5 * def->width, 0.5 * def->height}, f = 0.0, axes[3][3];
  const bool has_centre = !vl_is_unset(def->cx);
  VL_TRY(check(def, error));
  if (def->count == 3)
    VL_TRY(orthocentre(def, p, error));
  if (def->count == 2 && has_centre) {
    p[0] = def->cx;
    p[1] = def->cy;
  }
  VL_TRY(focal_length(def, p, &f, error));
  if (has_centre && vl_length_2d(def->cx - p[0], def->cy - p[1]) > agreement * f)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "vanishing points: the three have their principal point at (%.9g, %.9g), but "
        "(%.9g, %.9g) is given",
        p[0], p[1], def->cx, def->cy);
  find_axes(def, p, f, axes);
  *camera = vl_default_camera_def(def->width, def->height);
  camera->fx = camera->fy = f;
  camera->cx = p[0];
  camera->cy = p[1];
  camera->has_matrix = true;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      camera->world_from_camera[4 * i + k] = axes[i][k] + 0.0;
  return VL_OK;
}
