/* camera/jacobian.c: derivatives of projection and unprojection (velo/jacobian.h), by the chain
 * rule: pose, projection, distortion, intrinsics. Each projection has its own derivatives
 * (projection/NAME.h). */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "camera/moments.h"
#include "camera/optics.h"
#include "camera/points.h"
#include "math/double3.h"
#include "velo/jacobian.h"

/* The derivatives of a film point: by its point in camera space, and by the camera's numbers
 * (columns from VL_JACOBIAN_INTRINSICS on). */
enum { NUMBERS = VL_JACOBIAN_COLUMNS - VL_JACOBIAN_INTRINSICS };
enum { SHAPE = VL_JACOBIAN_SHAPE - VL_JACOBIAN_INTRINSICS };
enum { DISTORTION = VL_JACOBIAN_DISTORTION - VL_JACOBIAN_INTRINSICS };
typedef struct {
  double point[2][3], numbers[2][NUMBERS];
} FilmDerivatives;

/* The numbers of a distortion: members of vlDistortionMap, and the two angles of its tilt. */
enum { RADIAL = 6, BELOW = RADIAL, TANGENTIAL = 9, PRISM = 11, TILT = 15, COEFFICIENTS = 17 };

/* The derivatives of the point before the tilt by the coefficients of the common form
 * (distortion/distortion.h). */
static void by_coefficients(const vlDistortionMap *m, double x, double y, double by[2][TILT]) {
  const double *n = m->numerator, *d = m->denominator;
  double s = x * x + y * y, below = 1.0 + s * (d[0] + s * (d[1] + s * d[2])), above = 0.0;
  for (int i = RADIAL - 1; i >= 0; i--)
    above = s * (n[i] + above);
  double q = (1.0 + above) / below, power = 1.0, by_q[2] = {x, y};
  memset(by, 0, 2 * sizeof *by);
  if (m->radial_first) {
    vlDistorted after = vl_distort_with(m, x * q, y * q, 1.0, 0.0);
    by_q[0] = after.ux * x + after.uy * y;
    by_q[1] = after.vx * x + after.vy * y;
  }
  for (int i = 0; i < RADIAL; i++) {
    power *= s;
    for (int axis = 0; axis < 2; axis++) {
      by[axis][i] = by_q[axis] * power / below;
      if (i < 3)
        by[axis][BELOW + i] = -by_q[axis] * q * power / below;
    }
  }
  if (m->radial_first) {
    x *= q;
    y *= q;
    s = x * x + y * y;
  }
  by[0][TANGENTIAL] = by[1][TANGENTIAL + 1] = 2.0 * x * y;
  by[1][TANGENTIAL] = s + 2.0 * y * y;
  by[0][TANGENTIAL + 1] = s + 2.0 * x * x;
  by[0][PRISM] = by[1][PRISM + 2] = s;
  by[0][PRISM + 1] = by[1][PRISM + 3] = s * s;
}

/* The derivatives of the tilted point, by one angle of the tilt. r: the rotation; dr: its
 * derivative. The point is (r8 q0 - r2 q2, r8 q1 - r5 q2) / q2, q = r (u, v, 1). */
static void by_angle(const double r[9], const double dr[9], double u, double v, double by[2]) {
  double q[3], dq[3];
  for (int i = 0; i < 3; i++) {
    q[i] = r[3 * i] * u + r[3 * i + 1] * v + r[3 * i + 2];
    dq[i] = dr[3 * i] * u + dr[3 * i + 1] * v + dr[3 * i + 2];
  }
  for (int i = 0; i < 2; i++) {
    double ratio = q[i] / q[2];
    by[i] = dr[8] * ratio + r[8] * (dq[i] - ratio * dq[2]) / q[2] - dr[3 * i + 2];
  }
}

/* The angles are found in the homography, whose last row is that of the rotation. */
static void by_tilt(const vlDistortionMap *m, double u, double v, double by_x[2],
                    double by_y[2]) {
  const double *h = m->tilt;
  double sy = h[6], cy = sqrt(1.0 - sy * sy), cx = h[8] / cy, sx = -h[7] / cy;
  const double r[9] = {cy, sy * sx, -sy * cx, 0.0, cx, sx, sy, -cy * sx, cy * cx};
  const double about_x[9] = {0.0, sy * cx, sy * sx, 0.0, -sx, cx, 0.0, -cy * cx, -cy * sx};
  const double about_y[9] = {-sy, cy * sx, -cy * cx, 0.0, 0.0, 0.0, cy, sy * sx, -sy * cx};
  by_angle(r, about_x, u, v, by_x);
  by_angle(r, about_y, u, v, by_y);
}

/* by: the 2 x 2 derivatives of the distorted point by the ideal one, and those by the
 * numbers of the distortion. at: the distorted point. */
static void distortion(const vlDistortionMap *m, double x, double y, double at[2],
                       double by_ideal[2][2], double by[2][COEFFICIENTS]) {
  vlDistorted d = vl_distort(m, x, y);
  vlPlanePoint p = vl_tilt(m->tilt, d.u, d.v);
  const double *h = m->tilt;
  double before[2][TILT], angle_x[2], angle_y[2], flat[2][2];
  double w = h[6] * d.u + h[7] * d.v + h[8];
  at[0] = p.x;
  at[1] = p.y;
  by_coefficients(m, x, y, before);
  by_tilt(m, d.u, d.v, angle_x, angle_y);
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++)
      flat[i][j] = (h[3 * i + j] - at[i] * h[6 + j]) / w;
    by_ideal[i][0] = flat[i][0] * d.ux + flat[i][1] * d.vx;
    by_ideal[i][1] = flat[i][0] * d.uy + flat[i][1] * d.vy;
    for (int j = 0; j < TILT; j++)
      by[i][j] = flat[i][0] * before[0][j] + flat[i][1] * before[1][j];
    by[i][TILT] = angle_x[i];
    by[i][TILT + 1] = angle_y[i];
  }
}

/* The film point (x, y) r / rho, rho = |(x, y)|, where the chief ray of the film radius r
 * passes through the point: -(x0(r) + slope(r) z) = rho (implicit function theorem). */
static FilmDerivatives optics_derivatives(const vlCameraCompiled *c, double x, double y,
                                          double z) {
  FilmDerivatives d = {.numbers = {{0.0, 0.0, 0.0, 1.0, 0.0}, {0.0, 0.0, 0.0, 0.0, 1.0}}};
  double film[2], x0, slope, rho = vl_length_2d(x, y), inv = 1.0 / vl_not_tiny(rho);
  vlChief chief = {0};
  bool good = vl_optics_project(c->optics, x, y, z, film);
  double radius = good ? vl_length_2d(film[0], film[1]) : 0.0;
  if (!good || !vl_optics_chief_derivatives(c->optics, radius, &chief, &x0, &slope)) {
    d.point[0][0] = NAN;
    return d;
  }
  double by_rho = -1.0 / (x0 + slope * z), by_z = chief.slope * by_rho;
  double k = rho > 0.0 ? radius * inv : by_rho, across = (by_rho - k) * inv * inv;
  const double by[5] = {x * across, y * across, by_z * inv, 0.0, 0.0};
  vlPlaneDerivatives p = vl_derive_factor(x, y, k, by);
  for (int j = 0; j < 3; j++) {
    d.point[0][j] = p.x[j] / c->pitch;
    d.point[1][j] = p.y[j] / c->pitch;
  }
  return d;
}

static FilmDerivatives film_derivatives(const vlCameraCompiled *c, double x, double y,
                                        double z) {
  if (c->optics)
    return optics_derivatives(c, x, y, z);
  vlPlanePoint ideal = vl_plane_project(c->projection, c, x, y, z);
  vlPlaneDerivatives p = vl_plane_derive(c->projection, c, x, y, z);
  double at[2], by_ideal[2][2], by[2][COEFFICIENTS];
  distortion(&c->distortion, ideal.x, ideal.y, at, by_ideal, by);
  const double k[2][2] = {{c->fx, c->skew}, {0.0, c->fy}};
  FilmDerivatives d = {.numbers = {{at[0], 0.0, at[1], 1.0, 0.0}, {0.0, at[1], 0.0, 0.0, 1.0}}};
  for (int i = 0; i < 2; i++) {
    double to_x = k[i][0] * by_ideal[0][0] + k[i][1] * by_ideal[1][0];
    double to_y = k[i][0] * by_ideal[0][1] + k[i][1] * by_ideal[1][1];
    for (int j = 0; j < 3; j++)
      d.point[i][j] = to_x * p.x[j] + to_y * p.y[j];
    for (int j = 0; j < 2; j++)
      d.numbers[i][SHAPE + j] = to_x * p.x[3 + j] + to_y * p.y[3 + j];
    for (int j = 0; j < COEFFICIENTS; j++)
      d.numbers[i][DISTORTION + j] = k[i][0] * by[0][j] + k[i][1] * by[1][j];
  }
  return d;
}

static bool all_finite(const double *numbers, int count) {
  bool finite = true;
  for (int i = 0; i < count; i++)
    finite = finite && isfinite(numbers[i]);
  return finite;
}

/* The point moves in camera space by t + r x point. */
static bool project_one(const vlCameraCompiled *c, const double point[3], double *rows) {
  const double *m = c->camera_from_world;
  double at[3];
  vl_map_point(m, point, at);
  if (!(vl_camera_film_point(c, at[0], at[1], at[2]).valid > 0.0))
    return false;
  FilmDerivatives d = film_derivatives(c, at[0], at[1], at[2]);
  for (int i = 0; i < 2; i++) {
    double *row = rows + (size_t)i * VL_JACOBIAN_COLUMNS;
    const double *g = d.point[i];
    for (int j = 0; j < 3; j++) {
      row[VL_JACOBIAN_POINT + j] = g[0] * m[j] + g[1] * m[4 + j] + g[2] * m[8 + j];
      row[VL_JACOBIAN_POSE + j] = g[j];
    }
    vl_cross3(at, g, row + VL_JACOBIAN_POSE + 3);
    memcpy(row + VL_JACOBIAN_INTRINSICS, d.numbers[i], sizeof d.numbers[i]);
  }
  return all_finite(rows, 2 * VL_JACOBIAN_COLUMNS);
}

/* Writes the world's derivatives of one column: `origin` and `direction` are those of the ray
 * in camera space, ray its direction in the world, not normalised. */
static void store_ray(const vlCameraCompiled *c, const double ray[3], const double origin[3],
                      const double direction[3], double *rows, int column) {
  const double *m = c->rotation;
  double inv = 1.0 / vl_length_3d(ray[0], ray[1], ray[2]), d[3], along = 0.0;
  for (int i = 0; i < 3; i++) {
    const double *r = m + 3 * (size_t)i;
    double *row = rows + (size_t)i * VL_JACOBIAN_COLUMNS + column;
    row[0] = vl_dot3(r, origin);
    d[i] = vl_dot3(r, direction) * inv;
    along += d[i] * ray[i] * inv;
  }
  for (int i = 0; i < 3; i++)
    rows[(size_t)(3 + i) * VL_JACOBIAN_COLUMNS + column] = d[i] - along * ray[i] * inv;
}

/* What a change of the film point, (dx, dy) pixels, does to a ray in camera space: across its
 * direction; of an orthographic camera, to its origin. solve: 3 x 2. */
static bool solve_ray(const vlCameraCompiled *c, const double d[3], const FilmDerivatives *f,
                      double solve[3][2]) {
  bool orthographic = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double tangent[2][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, p[2][2];
  if (!orthographic) {
    int min = fabs(d[0]) < fabs(d[1]) ? 0 : 1;
    double axis[3] = {0.0, 0.0, 0.0};
    axis[min] = 1.0;
    vl_cross3(d, axis, tangent[0]);
    vl_cross3(d, tangent[0], tangent[1]);
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      p[i][j] = f->point[i][0] * tangent[j][0] + f->point[i][1] * tangent[j][1] +
                f->point[i][2] * tangent[j][2];
  double inv = 1.0 / (p[0][0] * p[1][1] - p[0][1] * p[1][0]);
  for (int i = 0; i < 3; i++) {
    solve[i][0] = (tangent[0][i] * p[1][1] - tangent[1][i] * p[1][0]) * inv;
    solve[i][1] = (tangent[1][i] * p[0][0] - tangent[0][i] * p[0][1]) * inv;
  }
  return isfinite(inv);
}

/* A ray in camera space, and its derivatives by the film point, pixels; the direction's length
 * is of no matter. numbers: those of the film point. */
typedef struct {
  double o[3], d[3], origin[3][2], direction[3][2];
  double numbers[2][NUMBERS];
} RayDerivatives;

/* The chief ray of the film point (x, y), scene units, of radius r: origin (x, y, 0) times
 * -x0 / r, direction (x, y) times -slope / r, and 1. */
static bool optics_ray(const vlCameraCompiled *c, double x, double y, RayDerivatives *ray) {
  double of_x0, of_slope, r = vl_length_2d(x, y), inv = 1.0 / vl_not_tiny(r);
  vlChief chief = {0};
  if (!vl_optics_chief_derivatives(c->optics, r, &chief, &of_x0, &of_slope))
    return false;
  double at = r > 0.0 ? -chief.x0 * inv : -of_x0,
         towards = r > 0.0 ? -chief.slope * inv : -of_slope;
  double by_at = (-of_x0 - at) * inv * inv, by_towards = (-of_slope - towards) * inv * inv;
  const double by_o[5] = {x * by_at, y * by_at, 0.0, 0.0, 0.0};
  const double by_d[5] = {x * by_towards, y * by_towards, 0.0, 0.0, 0.0};
  vlPlaneDerivatives o = vl_derive_factor(x, y, at, by_o);
  vlPlaneDerivatives d = vl_derive_factor(x, y, towards, by_d);
  *ray = (RayDerivatives){.o = {x * at, y * at, 0.0}, .d = {x * towards, y * towards, 1.0}};
  for (int j = 0; j < 2; j++) {
    ray->origin[0][j] = o.x[j] * c->pitch;
    ray->origin[1][j] = o.y[j] * c->pitch;
    ray->direction[0][j] = d.x[j] * c->pitch;
    ray->direction[1][j] = d.y[j] * c->pitch;
  }
  ray->numbers[0][3] = 1.0;
  ray->numbers[1][4] = 1.0;
  return true;
}

static bool central_ray(const vlCameraCompiled *c, const double pixel[2], RayDerivatives *ray) {
  bool orthographic = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double x = pixel[0] - c->cx, y = pixel[1] - c->cy;
  vlDirection d = {0.0, 0.0, 1.0, 1.0};
  vlPlanePoint plane = vl_pixel_to_plane(c, x, y);
  if (!orthographic)
    d = vl_camera_direction(c, x, y);
  double length = vl_length_3d(d.x, d.y, d.z);
  *ray =
      (RayDerivatives){.o = {orthographic ? plane.x : 0.0, orthographic ? plane.y : 0.0, 0.0},
                       .d = {d.x / length, d.y / length, d.z / length}};
  const double at[3] = {ray->o[0] + ray->d[0], ray->o[1] + ray->d[1], ray->d[2]};
  vlPlanePoint film = vl_camera_film_point(c, at[0], at[1], at[2]);
  double size = 1.0 + fabs(pixel[0]) + fabs(pixel[1]);
  if (!(d.valid > 0.0 && film.valid > 0.0) ||
      !(fabs(film.x - pixel[0]) + fabs(film.y - pixel[1]) < 1e-6 * size))
    return false;
  FilmDerivatives f = film_derivatives(c, at[0], at[1], at[2]);
  memcpy(ray->numbers, f.numbers, sizeof f.numbers);
  return solve_ray(c, ray->d, &f, orthographic ? ray->origin : ray->direction);
}

static bool ray_of(const vlCameraCompiled *c, const double pixel[2], RayDerivatives *ray) {
  return c->optics
             ? optics_ray(c, c->pitch * (pixel[0] - c->cx), c->pitch * (pixel[1] - c->cy), ray)
             : central_ray(c, pixel, ray);
}

static bool unproject_one(const vlCameraCompiled *c, const double pixel[2], double *rows) {
  RayDerivatives ray;
  if (!ray_of(c, pixel, &ray))
    return false;
  const double *o = ray.o, *d = ray.d, none[3] = {0.0, 0.0, 0.0};
  double world[3];
  vl_mat3_vector(c->rotation, d, world);
  for (int j = 0; j < 2 + NUMBERS; j++) {
    double origin[3], direction[3];
    double x = j < 2 ? (j == 0) : -ray.numbers[0][j - 2];
    double y = j < 2 ? (j == 1) : -ray.numbers[1][j - 2];
    for (int i = 0; i < 3; i++) {
      origin[i] = ray.origin[i][0] * x + ray.origin[i][1] * y;
      direction[i] = ray.direction[i][0] * x + ray.direction[i][1] * y;
    }
    int column = j < 2 ? VL_JACOBIAN_POINT + j : VL_JACOBIAN_INTRINSICS + j - 2;
    store_ray(c, world, origin, direction, rows, column);
  }
  /* world_from_camera' = world_from_camera exp(-(t, r)^) */
  for (int j = 0; j < 3; j++) {
    double axis[3] = {0.0, 0.0, 0.0}, back[3] = {0.0, 0.0, 0.0}, of_origin[3], of_direction[3];
    axis[j] = 1.0;
    back[j] = -1.0;
    vl_cross3(o, axis, of_origin);
    vl_cross3(d, axis, of_direction);
    store_ray(c, world, back, none, rows, VL_JACOBIAN_POSE + j);
    store_ray(c, world, of_origin, of_direction, rows, VL_JACOBIAN_POSE + 3 + j);
  }
  return all_finite(rows, 6 * VL_JACOBIAN_COLUMNS);
}

/* ---- cameras in motion ------------------------------------------------------------------- */

/* The derivatives of a film point's time by its x and y; 0 beyond the image's edges, where it
 * is that of the edge. */
static void time_by_film(const vlCameraCompiled *c, const double film[2], double by[2]) {
  const vlCameraTime *t = &c->when;
  bool inside = t->per_column != 0.0 ? film[0] > 0.0 && film[0] < t->columns
                                     : film[1] > 0.0 && film[1] < t->rows;
  by[0] = inside ? t->per_column : 0.0;
  by[1] = inside ? t->per_row : 0.0;
}

/* v' = a (3 x 3) v + p */
static void apply(const double m[9], const double p[3], const double v[3], double result[3]) {
  for (int i = 0; i < 3; i++)
    result[i] = vl_dot3(m + 3 * (size_t)i, v) + p[i];
}

/* The film point f = F(camera_from_world(t(f)) point, ...), so that its derivatives are those
 * of the camera held at its time, times (1 - F' d(camera_from_world point)/dt dt/df)^-1. */
static bool project_moving(const vlCameraCompiled *c, const double point[3], double *rows) {
  const double none[3] = {0.0, 0.0, 0.0};
  vlCameraCompiled held = *c;
  if (!vl_camera_hold_at_point(&held, point) || !project_one(&held, point, rows))
    return false;
  double back[9], last[3], x[3], moved[3], slip[3], by[2], speed[2];
  vlAffine rate = vl_camera_rate_at(c, held.shutter_open);
  vl_split_map(held.camera_from_world, back, last);
  apply(back, last, point, x);
  vlPlanePoint film = vl_camera_film_point(&held, x[0], x[1], x[2]);
  time_by_film(c, (const double[2]){film.x, film.y}, by);
  apply(rate.m, rate.p, x, moved); /* of the world's point at x */
  apply(back, none, moved, slip);  /* x moves by less this */
  for (int i = 0; i < 2; i++) {
    const double *g = rows + (size_t)i * VL_JACOBIAN_COLUMNS + VL_JACOBIAN_POSE;
    speed[i] = -vl_dot3(g, slip);
  }
  double inv = 1.0 / (1.0 - by[0] * speed[0] - by[1] * speed[1]);
  for (int j = 0; j < VL_JACOBIAN_COLUMNS; j++) {
    double later = (by[0] * rows[j] + by[1] * rows[VL_JACOBIAN_COLUMNS + j]) * inv;
    rows[j] += speed[0] * later;
    rows[VL_JACOBIAN_COLUMNS + j] += speed[1] * later;
  }
  return all_finite(rows, 2 * VL_JACOBIAN_COLUMNS);
}

/* The ray of a camera that is held where it is; it moves with the camera's rate by the film
 * point's time. */
static bool unproject_moving(const vlCameraCompiled *c, const double pixel[2], double *rows) {
  vlCameraCompiled held = *c;
  vl_camera_hold(&held, vl_camera_film_time(c, pixel[0], pixel[1]));
  RayDerivatives ray;
  if (!unproject_one(&held, pixel, rows) || !ray_of(c, pixel, &ray))
    return false;
  const double none[3] = {0.0, 0.0, 0.0};
  double by[2], d[3], moved[6], along = 0.0;
  vlAffine rate = vl_camera_rate_at(c, held.shutter_open);
  time_by_film(c, pixel, by);
  apply(held.rotation, none, ray.d, d);
  apply(rate.m, rate.p, ray.o, moved);
  apply(rate.m, none, ray.d, moved + 3);
  double inv = 1.0 / vl_length_3d(d[0], d[1], d[2]);
  for (int i = 0; i < 3; i++) {
    moved[3 + i] *= inv;
    along += moved[3 + i] * d[i] * inv;
  }
  for (int i = 0; i < 6; i++) {
    double *row = rows + (size_t)i * VL_JACOBIAN_COLUMNS;
    double speed = i < 3 ? moved[i] : moved[i] - along * d[i - 3] * inv;
    row[VL_JACOBIAN_POINT] += speed * by[0];
    row[VL_JACOBIAN_POINT + 1] += speed * by[1];
  }
  return all_finite(rows, 6 * VL_JACOBIAN_COLUMNS);
}

static vlResult check(const vlCamera *camera, bool missing, vlError *error) {
  vl_error_clear(error);
  if (!camera || missing)
    return vl_fail_argument(error, "camera: a null pointer");
  const char *what = NULL;
  if (camera->own)
    what = "a camera of one's own";
  else if (camera->eye_circle != 0.0)
    what = "an eye of omnidirectional stereo";
  if (what)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera: %s has no Jacobian", what);
  return VL_OK;
}

/* Of a camera at rest, and of one in motion. */
typedef bool JacobianFn(const vlCameraCompiled *c, const double *in, double *rows);
static JacobianFn *const project[2] = {project_one, project_moving};
static JacobianFn *const unproject[2] = {unproject_one, unproject_moving};

static vlResult each(const vlCamera *camera, size_t count, const double *in, size_t inputs,
                     double *out, size_t outputs, uint8_t *valid, JacobianFn *const one[2],
                     vlError *error) {
  VL_TRY(check(camera, count > 0 && (!in || !out), error));
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  for (size_t i = 0; i < count; i++) {
    const double *from = in + inputs * i;
    double *rows = out + outputs * VL_JACOBIAN_COLUMNS * i;
    memset(rows, 0, outputs * VL_JACOBIAN_COLUMNS * sizeof *rows);
    bool good = all_finite(from, (int)inputs) && one[c.when.moves](&c, from, rows);
    if (!good)
      memset(rows, 0, outputs * VL_JACOBIAN_COLUMNS * sizeof *rows);
    if (valid)
      valid[i] = good;
  }
  return VL_OK;
}

vlResult vl_camera_project_jacobian(const vlCamera *camera, size_t count, const double *points,
                                    double *jacobians, uint8_t *valid, vlError *error) {
  return each(camera, count, points, 3, jacobians, 2, valid, project, error);
}

vlResult vl_camera_unproject_jacobian(const vlCamera *camera, size_t count,
                                      const double *pixels, double *jacobians, uint8_t *valid,
                                      vlError *error) {
  return each(camera, count, pixels, 2, jacobians, 6, valid, unproject, error);
}
