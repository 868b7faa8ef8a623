/* conformance/camera_ways.h: laws of projections and distortions over their whole domain: each
 * direction that has a film point is found again from it, also close to where the camera's view
 * ends; it ends where the model says; the derivatives are those of differences; the width of
 * rays is that of the central pixel's solid angle. */
#ifndef TEST_CONFORMANCE_CAMERA_WAYS_H
#define TEST_CONFORMANCE_CAMERA_WAYS_H

#include "camera/parts.h"
#include "camera/rays.h"
#include "conformance.h"
#include "unit.h"
#include "velo/camera.h"
#include "velo/jacobian.h"
#include "velo/projection.h"

enum { WAYS = 4096, AZIMUTHS = 16, NEARNESSES = 7 };

/* ---- there and back ---------------------------------------------------------------------- */

/* Farther out than this, in focal lengths, cancellation leaves few digits. */
#define FARTHEST 1e3

/* How many directions were tried, and what became of them. other: found from their film point
 * is another direction. */
typedef struct Ways {
  uint32_t seen, lost, other;
  double worst; /* pixels, between film points, per pixel of their distance from the centre */
} Ways;

static double angle_between(const double a[3], const double b[3]) {
  const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                           a[0] * b[1] - a[1] * b[0]};
  return atan2(sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]),
               a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* A direction that has a film point is found from it; false: it has none. */
static bool go_and_return(const vlCamera *camera, const double direction[3], Ways *ways) {
  double film[2];
  double again[2] = {0, 0};
  double o[3];
  double d[3];
  if (!vl_camera_project(camera, direction, film, NULL))
    return false;
  ways->seen++;
  if (!vl_camera_unproject(camera, film[0], film[1], o, d) ||
      !vl_camera_project(camera, d, again, NULL)) {
    ways->lost++;
    return true;
  }
  ways->other += angle_between(direction, d) > 1e-4;
  double size = camera->fx + fabs(film[0]) + fabs(film[1]);
  for (int k = 0; k < 2 && size < FARTHEST * camera->fx; k++)
    ways->worst = fmax(ways->worst, fabs(again[k] - film[k]) / size);
  return true;
}

static void direction_at(double theta, double azimuth, double d[3]) {
  d[0] = sin(theta) * cos(azimuth);
  d[1] = sin(theta) * sin(azimuth);
  d[2] = cos(theta);
}

/* The angle from the axis, radians, up to which all directions of an azimuth have film points:
 * pi where all have. */
static double end_of_view(const vlCamera *camera, double azimuth) {
  enum { STEPS = 2000, HALVINGS = 50 };
  double d[3];
  double film[2];
  double low = 0;
  double high = 0;
  for (int i = 0; i < STEPS; i++) {
    high = PI * (i + 0.5) / STEPS;
    direction_at(high, azimuth, d);
    if (!vl_camera_project(camera, d, film, NULL))
      break;
    low = high;
  }
  if (low == high)
    return PI;
  for (int i = 0; i < HALVINGS; i++) {
    double middle = 0.5 * (low + high);
    direction_at(middle, azimuth, d);
    bool seen = vl_camera_project(camera, d, film, NULL);
    low = seen ? middle : low;
    high = seen ? high : middle;
  }
  return low;
}

/* Directions on the film: around the centre, then along the axes and the diagonals, where
 * numbers are equal or opposite. */
enum { OUTWARDS = AZIMUTHS + 8 };
static void outwards(int i, double way[2]) {
  static const double straight[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                        {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  const double azimuth = 2 * PI * (i + 0.3) / AZIMUTHS;
  way[0] = i < AZIMUTHS ? cos(azimuth) : straight[i - AZIMUTHS][0];
  way[1] = i < AZIMUTHS ? sin(azimuth) : straight[i - AZIMUTHS][1];
}

/* The direction of each film point has a film point, as far out as the film may reach: this
 * one, or of panoramas another one of the same direction. */
static void check_far_film(const char *family, const char *kind, const vlCamera *camera) {
  enum { RADII = 60 };
  /* faces of a cube meet on the diagonals, others than in space */
  const int ways = camera->projection == VL_PROJECTION_CUBE ? AZIMUTHS : OUTWARDS;
  uint32_t seen = 0;
  uint32_t lost = 0;
  double first = 0;
  for (int i = 0; i < RADII * ways; i++) {
    double o[3];
    double d[3];
    double again[3];
    double film[2];
    double way[2];
    const double radius = camera->fx * pow(10, -1 + 3.0 * (i / ways) / RADII);
    outwards(i % ways, way);
    const double x = camera->cx + radius * way[0];
    const double y = camera->cy + radius * way[1];
    if (!vl_camera_unproject(camera, x, y, o, d))
      continue;
    const bool found = vl_camera_project(camera, d, film, NULL) &&
                       vl_camera_unproject(camera, film[0], film[1], o, again) &&
                       angle_between(d, again) < 1e-6;
    first = !found && !lost ? radius / camera->fx : first;
    seen++;
    lost += !found;
  }
  if (lost)
    broken(family, kind,
           "%u of %u film points, the first %.2f focal lengths out, are not found "
           "from their directions",
           lost, seen, first);
}

static void report_ways(const char *family, const char *kind, const Ways *ways) {
  if (ways->lost)
    broken(family, kind, "%u of %u directions with a film point have no way back", ways->lost,
           ways->seen);
  if (ways->other)
    broken(family, kind, "%u of %u directions have the film point of another one", ways->other,
           ways->seen);
  if (!(ways->worst < 1e-9))
    broken(family, kind, "a direction comes back %g off", ways->worst);
}

/* Directions close to where the view ends. */
static void go_to_end(const vlCamera *camera, Ways *ways) {
  for (int a = 0; a < AZIMUTHS; a++) {
    double azimuth = 2 * PI * (a + 0.3) / AZIMUTHS;
    double end = end_of_view(camera, azimuth);
    for (int k = 1; k < NEARNESSES; k++) {
      double d[3];
      direction_at(end * (1 - pow(10, -k)), azimuth, d);
      go_and_return(camera, d, ways);
    }
  }
}

static void check_ways(const char *family, const char *kind, const vlCamera *camera) {
  Ways ways = {0};
  double d[3];
  for (uint32_t i = 0; i < WAYS; i++) {
    even_direction(i, WAYS, 0.2, d);
    go_and_return(camera, d, &ways);
  }
  go_to_end(camera, &ways);
  check_far_film(family, kind, camera);
  report_ways(family, kind, &ways);
}

/* ---- the end of the view ----------------------------------------------------------------- */

/* An image of the whole sphere shows all directions, also those along axes and diagonals, where
 * numbers are 0 or equal. */
static void check_whole_sphere(const char *kind, const vlCamera *camera) {
  enum { CORNERS = 27, MIDDLE = 13 };
  Ways ways = {0};
  for (int i = 0; i < CORNERS; i++) {
    const double d[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    if (i != MIDDLE)
      go_and_return(camera, d, &ways);
  }
  if (ways.seen != CORNERS - 1)
    broken("projections", kind, "%u of %d directions of the sphere are not seen",
           CORNERS - 1 - ways.seen, CORNERS - 1);
  if (camera->projection != VL_PROJECTION_CUBE) /* film points of diagonals are on two faces */
    report_ways("projections", kind, &ways);
}

/* end: radians from the axis, towards +x; circles: a smaller view can be asked for. */
static void check_end(const char *kind, const vlCameraDef *def, double end, bool circles) {
  vlCameraDef narrow = *def;
  vlCamera camera;
  narrow.fov = VL_UNSET;
  narrow.fx = narrow.fy = 20;
  assert_int_equal(vl_camera_make(&narrow, &camera, NULL, NULL), VL_OK);
  double seen = end_of_view(&camera, 0);
  Ways ways = {0};
  go_to_end(&camera, &ways);
  report_ways("projections", kind, &ways);
  if (!(fabs(seen - end) < 1e-5))
    broken("projections", kind, "its view ends at %.6f radians, not %.6f", seen, end);
  if (!circles)
    return;
  narrow.max_angle = 0.7 * end;
  assert_int_equal(vl_camera_make(&narrow, &camera, NULL, NULL), VL_OK);
  for (int a = 0; a < AZIMUTHS; a++) {
    seen = end_of_view(&camera, 2 * PI * a / AZIMUTHS);
    if (fabs(seen - 0.7 * end) < 1e-9)
      continue;
    broken("projections", kind, "a view of %.6f radians ends at %.6f", 0.7 * end, seen);
    return;
  }
}

/* A distorted view ends on a circle, before the distortion folds in any direction. */
static void check_round_end(const char *kind, const vlCamera *camera) {
  double low = INFINITY;
  double high = 0;
  for (int a = 0; a < AZIMUTHS; a++) {
    const double end = end_of_view(camera, 2 * PI * a / AZIMUTHS);
    low = fmin(low, end);
    high = fmax(high, end);
  }
  if (!(high - low < 1e-6))
    broken("distortions", kind, "its view ends at %.6f radians, and at %.6f elsewhere", low,
           high);
}

/* ---- the width of rays ------------------------------------------------------------------- */

/* The angle that the central pixel subtends, which rays have as their width. The pixel is not
 * quite straight ahead: there the equal-area panorama has an edge. */
static void check_ray_width(const char *kind, const vlCamera *camera) {
  static const double ahead[3] = {0.02, 0.013, 1};
  double film[2];
  vlCameraCompiled compiled;
  vl_camera_compile(camera, &compiled);
  if (!vl_camera_project(camera, ahead, film, NULL)) {
    broken("projections", kind, "does not see ahead");
    return;
  }
  double side = sqrt(vl_camera_solid_angle(camera, film[0], film[1]));
  double width = (double)compiled.pixel_spread;
  if (!(fabs(width - side) < 3e-3 * side))
    broken("projections", kind, "rays widen by %.6f; the central pixel's side is %.6f", width,
           side);
}

/* ---- derivatives ------------------------------------------------------------------------- */

/* The film point with one number moved by h; column: of the Jacobian. */
static bool film_of_moved(const vlCamera *camera, const double point[3], int column, double h,
                          double film[2]) {
  vlCamera c = *camera;
  double p[3] = {point[0], point[1], point[2]};
  double *const intrinsics[5] = {&c.fx, &c.fy, &c.skew, &c.cx, &c.cy};
  vlDistortionMap *m = &c.distortion;
  int bent = column - VL_JACOBIAN_DISTORTION;
  if (column < VL_JACOBIAN_POSE)
    p[column] += h;
  else if (column < VL_JACOBIAN_SHAPE)
    *intrinsics[column - VL_JACOBIAN_INTRINSICS] += h;
  else if (column < VL_JACOBIAN_DISTORTION)
    c.shape[column - VL_JACOBIAN_SHAPE] += h;
  else if (bent < 6)
    m->numerator[bent] += h;
  else if (bent < 9)
    m->denominator[bent - 6] += h;
  else if (bent < 11)
    m->tangential[bent - 9] += h;
  else
    m->prism[bent - 11] += h;
  return vl_camera_project(&c, p, film, NULL);
}

/* Central differences of fourth order. False: a number leaves the domain, or the film is cut
 * there. */
static bool film_difference(const vlCamera *camera, const double point[3], int column,
                            double by[2]) {
  static const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  static const double at[4] = {-2, -1, 1, 2};
  double h = column < VL_JACOBIAN_POSE ? 1e-3 : 1e-4;
  double here[2];
  double film[2];
  by[0] = by[1] = 0;
  if (!vl_camera_project(camera, point, here, NULL))
    return false;
  for (int i = 0; i < 4; i++) {
    if (!film_of_moved(camera, point, column, at[i] * h, film))
      return false;
    for (int k = 0; k < 2; k++) {
      if (fabs(film[k] - here[k]) > 1)
        return false;
      by[k] += weight[i] * film[k] / h;
    }
  }
  return true;
}

/* The last two columns are angles of the sensor's tilt, which the compiled camera has not. */
static bool moves(const vlCamera *camera, int column) {
  bool shape = column >= VL_JACOBIAN_SHAPE && column < VL_JACOBIAN_DISTORTION;
  if (column >= VL_JACOBIAN_POSE && column < VL_JACOBIAN_INTRINSICS)
    return false;
  if (shape)
    return camera->projection != VL_PROJECTION_CUBE;
  return column < VL_JACOBIAN_DISTORTION ||
         (camera->distortion.steps > 0 && column < VL_JACOBIAN_COLUMNS - 2);
}

/* points: 3 numbers each. */
static void check_derivatives(const char *family, const char *kind, const vlCamera *camera,
                              const double *points, uint32_t count) {
  static double rows[2 * VL_JACOBIAN_COLUMNS];
  uint32_t compared = 0;
  uint32_t wrong = 0;
  int column_of_wrong = 0;
  for (uint32_t i = 0; i < count; i++) {
    const double *point = points + 3 * i;
    uint8_t valid;
    vlError error = {0};
    assert_int_equal(vl_camera_project_jacobian(camera, 1, point, rows, &valid, &error), VL_OK);
    for (int column = 0; valid && column < VL_JACOBIAN_COLUMNS; column++) {
      double by[2];
      if (!moves(camera, column) || !film_difference(camera, point, column, by))
        continue;
      compared++;
      for (int k = 0; k < 2; k++) {
        double given = rows[k * VL_JACOBIAN_COLUMNS + column];
        bool same = fabs(given - by[k]) <= 1e-5 * (camera->fx + fabs(by[k]));
        wrong += !same;
        column_of_wrong = same ? column_of_wrong : column;
      }
    }
  }
  if (compared < count)
    broken(family, kind, "%u derivatives for %u points", compared, count);
  if (wrong)
    broken(family, kind, "%u of %u derivatives are not differences, the last by number %d",
           wrong, compared, column_of_wrong);
}

#endif
