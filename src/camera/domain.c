/* camera/domain.c: the domain of a camera: the disc of the plane within which its distortion
 * does not fold and its projection is defined; the number of Newton steps that invert the
 * distortion there; and the share of the image that lies outside. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "camera/optics.h"
#include "camera/own.h"
#include "camera/parts.h"
#include "camera/points.h"
#include "math/elementary.h"
#include "projection/properties.row.h"

enum { RADIAL_TERMS = 6, DEGREE = 10, MAX_STEPS = 48, DIRECTIONS = 64, RINGS = 40, GRID = 48 };

/* ---- where a radial distortion folds: the first root of a polynomial --------------------- */

static double value_at(const double *p, int degree, double s) {
  double value = 0.0;
  for (int i = degree; i >= 0; i--)
    value = value * s + p[i];
  return value;
}

/* All roots of p in (0, top], ascending. Between two roots of the derivative there is at most
 * one root, so that only pairs closer than rounding are missed. Returns their number. */
static int positive_roots(const double *p, int degree, double top, double roots[DEGREE]) {
  if (degree < 1)
    return 0;
  double derivative[DEGREE], turns[DEGREE];
  for (int i = 0; i < degree; i++)
    derivative[i] = (i + 1) * p[i + 1];
  int turn_count = positive_roots(derivative, degree - 1, top, turns), count = 0;
  double low = 0.0;
  for (int k = 0; k <= turn_count; k++) {
    double high = k < turn_count ? turns[k] : top;
    double at_low = value_at(p, degree, low), at_high = value_at(p, degree, high);
    if ((at_low > 0.0) != (at_high > 0.0)) {
      double a = low, b = high;
      for (int i = 0; i < 200 && a < b; i++) {
        double middle = 0.5 * (a + b);
        if (middle == a || middle == b)
          break;
        if ((value_at(p, degree, middle) > 0.0) == (at_low > 0.0))
          a = middle;
        else
          b = middle;
      }
      roots[count++] = a;
    }
    low = high;
  }
  return count;
}

/* With s = r^2 and q = N/D, r q(s) increases while (N + 2 s N') D - 2 s N D' > 0 and D > 0. */
static double radial_fold(const vlDistortionMap *m) {
  double n[1 + RADIAL_TERMS] = {1.0};
  memcpy(n + 1, m->numerator, sizeof m->numerator);
  const double d[4] = {1.0, m->denominator[0], m->denominator[1], m->denominator[2]};
  double growth[DEGREE] = {0}, roots[DEGREE];
  for (int i = 0; i <= RADIAL_TERMS; i++)
    for (int j = 0; j < 4; j++)
      growth[i + j] += n[i] * d[j] * (1.0 + 2.0 * i - 2.0 * j);
  const double top = 1e12;
  double first = INFINITY;
  if (positive_roots(growth, RADIAL_TERMS + 3, top, roots) > 0)
    first = roots[0];
  if (positive_roots(d, 3, top, roots) > 0 && roots[0] < first)
    first = roots[0];
  return sqrt(first);
}

/* ---- the general case: along 64 directions, the first point with a determinant <= 0 ------ */

/* Lower bound of the tilt's w. There the sensor is seen edge-on, and a point lies 1e6 focal
 * lengths away. */
static const double edge_on = 1e-6;

static bool unfolded(const vlDistortionMap *m, double x, double y) {
  vlDistorted d = vl_distort(m, x, y);
  double s = x * x + y * y, below = 1.0 + s * (m->denominator[0] +
                                               s * (m->denominator[1] + s * m->denominator[2]));
  double w = m->tilt[6] * d.u + m->tilt[7] * d.v + m->tilt[8];
  return below > 0.0 && w > edge_on && d.ux * d.vy - d.uy * d.vx > 0.0;
}

static double fold_along(const vlDistortionMap *m, double cosine, double sine, double max) {
  double before = 0.0;
  for (double r = 1e-3; before < max; r *= 1.03) {
    double here = r < max ? r : max;
    if (!unfolded(m, here * cosine, here * sine)) {
      double a = before, b = here;
      for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (a + b);
        if (unfolded(m, middle * cosine, middle * sine))
          a = middle;
        else
          b = middle;
      }
      return a;
    }
    before = here;
  }
  return max;
}

static double fold_radius(const vlDistortionMap *m, double max) {
  bool radial = m->tangential[0] == 0.0 && m->tangential[1] == 0.0 && m->tilt[6] == 0.0 &&
                m->tilt[7] == 0.0;
  for (int i = 0; i < 4; i++)
    radial = radial && m->prism[i] == 0.0;
  double radius = fmin(radial_fold(m), max);
  if (radial)
    return radius;
  /* tangential terms of the undistorted point move the fold inwards or outwards, so the search
   * continues beyond the radial fold */
  if (!m->radial_first)
    radius = max;
  max = radius;
  for (int i = 0; i < DIRECTIONS; i++) {
    double angle = 2.0 * M_PI * i / DIRECTIONS;
    radius = fmin(radius, fold_along(m, vl_precise_cos(angle), vl_precise_sin(angle), radius));
  }
  return radius < max ? 0.998 * radius : radius; /* margin for folds between the directions */
}

/* ---- number of Newton steps -------------------------------------------------------------- */

/* Returns the number of Newton steps that invert the distortion of (x, y), or MAX_STEPS + 1 if
 * they fail. */
static uint32_t steps_for(const vlDistortionMap *m, double x, double y) {
  vlDistorted d = vl_distort(m, x, y);
  vlPlanePoint p = vl_distortion_start(m, d.u, d.v);
  uint32_t step = 0;
  while (step <= MAX_STEPS &&
         vl_distortion_check(m->radial_first, m, p.x, p.y, d.u, d.v) == 0.0) {
    p = vl_distortion_step(m->radial_first, m, p.x, p.y, d.u, d.v);
    step++;
  }
  return step;
}

/* Returns an upper bound of the plane radius that the image needs: the first radius whose
 * distorted radius is 1.5 times that of the farthest corner. */
static double needed_radius(const vlCamera *c) {
  const vlDistortionMap *m = &c->distortion;
  double corner = 0.0;
  for (int i = 0; i < 4; i++) {
    double y = ((i & 1 ? c->height : 0.0) - c->cy) / c->fy;
    double x = ((i & 2 ? c->width : 0.0) - c->cx) / c->fx - c->skew / c->fx * y;
    vlPlanePoint p = vl_tilt(m->untilt, x, y);
    if (p.valid > 0.0)
      corner = fmax(corner, vl_length_2d(p.x, p.y));
  }
  double cosine[8], sine[8];
  for (int i = 0; i < 8; i++) {
    cosine[i] = vl_precise_cos(0.25 * M_PI * i);
    sine[i] = vl_precise_sin(0.25 * M_PI * i);
  }
  for (double r = 1e-3; r < m->radius && r < 1e6; r *= 1.05) {
    double min = INFINITY;
    for (int i = 0; i < 8; i++) {
      vlDistorted d = vl_distort(m, r * cosine[i], r * sine[i]);
      min = fmin(min, vl_length_2d(d.u, d.v));
    }
    if (min > 1.5 * corner)
      return r;
  }
  return fmin(m->radius, 1e6);
}

static uint32_t steps_everywhere(const vlCamera *c) {
  const vlDistortionMap *m = &c->distortion;
  double max = needed_radius(c);
  uint32_t steps = 1;
  double radius[RINGS];
  for (int k = 0; k < RINGS; k++) {
    /* the points get denser towards the edge, because Newton's method is slow near a fold */
    double share = k < 32 ? (k + 1) / 33.0 : 1.0 - vl_precise_pow(10.0, 29.5 - k);
    radius[k] = max * share;
  }
  for (int i = 0; i < 24; i++) {
    double angle = 2.0 * M_PI * (i + 0.3) / 24;
    double cosine = vl_precise_cos(angle), sine = vl_precise_sin(angle);
    for (int k = 0; k < RINGS; k++) {
      uint32_t here = steps_for(m, radius[k] * cosine, radius[k] * sine);
      if (here <= MAX_STEPS && here > steps)
        steps = here;
    }
  }
  return steps + 1;
}

/* ---- the image --------------------------------------------------------------------------- */

/* Returns, for a lens of many elements, the fraction of the image in film rings that no light
 * reaches. */
static double dark_share(const vlCamera *camera, const vlCameraCompiled *c) {
  uint32_t dark = 0;
  for (int i = 0; i < GRID * GRID; i++) {
    double x = camera->width * (i % GRID + 0.5) / GRID - c->cx,
           y = camera->height * (i / GRID + 0.5) / GRID - c->cy;
    double ring = c->pitch * sqrt(x * x + y * y) / c->optics->half * VL_PUPILS;
    dark += c->optics->pupils[ring < VL_PUPILS ? (int)ring : VL_PUPILS - 1].area == 0.0;
  }
  return dark / (double)(GRID * GRID);
}

/* Returns how many points of row `row` of the grid have no direction. */
static uint32_t outside_in_row(const vlCamera *camera, const vlCameraCompiled *c, int row) {
  static_assert((int)GRID <= (int)VL_CAMERA_CHUNK, "a row is one batch");
  vlCameraPixels pixels = {0};
  vlCameraPoints points;
  for (int i = 0; i < GRID; i++) {
    pixels.x[i] = camera->width * (i + 0.5) / GRID;
    pixels.y[i] = camera->height * (row + 0.5) / GRID;
  }
  vl_camera_best_kernels()->unproject(c, GRID, &pixels, &points);
  uint32_t outside = 0;
  for (int i = 0; i < GRID; i++)
    outside += points.valid[i] == 0.0;
  return outside;
}

static double share_outside(const vlCamera *camera) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  if (c.plain)
    return 0.0;
  if (c.optics)
    return dark_share(camera, &c);
  if (c.own)
    return vl_own_outside(camera);
  uint32_t outside = 0;
  for (int row = 0; row < GRID; row++)
    outside += outside_in_row(camera, &c, row);
  if (outside > 0)
    return outside / (double)(GRID * GRID);
  /* the corner pixels, which the grid may miss */
  for (int i = 0; i < 4; i++) {
    double x = i & 1 ? camera->width - 0.5 : 0.5, y = i & 2 ? camera->height - 0.5 : 0.5;
    outside += vl_camera_direction(&c, x - c.cx, y - c.cy).valid == 0.0;
  }
  return outside / ((double)camera->width * camera->height);
}

void vl_camera_measure(vlCamera *camera) {
  if (camera->distortion.steps > 0)
    camera->distortion.steps = steps_everywhere(camera);
  camera->outside = share_outside(camera);
}

vlResult vl_camera_domain(const vlCameraDef *def, vlCamera *camera, const char **warning,
                          vlError *error) {
  vlProjection kind = def->projection;
  const vlProjectionRow *row = vl_projection_row(kind);
  bool fisheye = row->traits & VL_PROJECTION_FISHEYE;
  double angle = def->max_angle, limit = row->limit > 0.0 ? row->limit : INFINITY;
  if (!vl_is_unset(angle)) {
    if (!(row->traits & VL_PROJECTION_CIRCLE) ||
        (kind == VL_PROJECTION_PERSPECTIVE && camera->distortion.steps == 0))
      return vl_fail_argument(error, "camera: max_angle has no meaning for the %s projection",
                              vl_projection_name(kind));
  }
  bool given = !vl_is_unset(def->fx) || !vl_is_unset(def->fy) ||
               !vl_is_unset(def->view_distance) || !vl_is_unset(def->focal_mm) ||
               !vl_is_unset(def->screen_min_x);
  if (vl_is_unset(angle) && fisheye && !vl_is_unset(def->fov))
    angle = 0.5 * def->fov;
  if (vl_is_unset(angle) && fisheye && !given)
    angle = 0.5 * M_PI;
  double radius;
  if (!vl_is_unset(angle)) {
    /* the direction straight back is singular; a nearby one replaces it */
    bool seen = vl_camera_plane_radius(camera, angle < M_PI ? angle : M_PI * (1.0 - 1e-9),
                                       false, &radius);
    if (seen)
      /* a margin for rounding, so that the angle itself is inside */
      limit = fmin(limit, radius * (1.0 + 1e-12));
    else if (!vl_is_unset(def->max_angle) && kind != VL_PROJECTION_PERSPECTIVE)
      return vl_fail_argument(
          error, "camera: the %s projection does not see as far as max_angle, %g degrees",
          vl_projection_name(kind), angle * 180.0 / M_PI);
  }
  camera->limit = limit;
  vlDistortionMap *m = &camera->distortion;
  if (m->steps > 0)
    m->radius = fold_radius(m, fmin(limit, 1e4));
  vl_camera_measure(camera);
  bool calibrated = m->steps > 0 || row->traits & VL_PROJECTION_CALIBRATED;
  if (calibrated && vl_is_unset(def->max_angle) && camera->outside > 0.0 && warning &&
      !*warning)
    *warning =
        "camera: the lens folds or its model ends inside the image; what lies beyond sees "
        "nothing (alpha 0)";
  return VL_OK;
}
