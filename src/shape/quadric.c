/* shape/quadric.c: sphere, disk and cylinder: intersection, surface at a point, sampling
 * by area. Everything is in shape space unless stated otherwise. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/approx.h"
#include "shape/shape_kind.h"
#include "shape/surface_point.h"
#include "velo/shape_kinds.h"

/* One primitive of a shape in its own space. This is shape space; if the shape is many spheres,
 * it is shape space translated so that this sphere is at the origin. */
typedef struct Quadric {
  vlShapeKind kind;
  bool flip;
  float radius, inner_radius, z_min, z_max, phi_max, height;
  const double *center; /* centre in shape space; null: the origin */
  const double *from_shape, *to_shape;
  const double *error; /* vlWorldShape.own_error */
} Quadric;

static Quadric load(const vlWorldShape *s, uint32_t prim) {
  Quadric q = {s->kind,    s->flip,   s->radius, s->inner_radius, s->z_min,    s->z_max,
               s->phi_max, s->height, NULL,      s->from_shape,   s->to_shape, s->own_error};
  if (s->centers) {
    q.center = s->centers + 3 * (size_t)prim;
    q.radius = q.z_max = s->radii[prim];
    q.z_min = -q.radius;
  }
  return q;
}

static void to_own(const Quadric *q, const double p[3], double r[3]) {
  vl_map_point(q->to_shape, p, r);
  for (int i = 0; q->center && i < 3; i++)
    r[i] -= q->center[i];
}

static void from_own(const Quadric *q, const double p[3], double r[3]) {
  double at[3] = {p[0], p[1], p[2]};
  for (int i = 0; q->center && i < 3; i++)
    at[i] += q->center[i];
  vl_map_point(q->from_shape, at, r);
}

static double angle_of(const double p[3]) {
  double phi = vl_atan2((float)p[1], (float)p[0]);
  return phi < 0 ? phi + 2 * M_PI : phi;
}

/* Whether a point of the full quadric is part of the shape. */
static bool inside_limits(const Quadric *s, const double p[3]) {
  if (s->kind == VL_SHAPE_SPHERE &&
      ((s->z_min > -s->radius && p[2] < s->z_min) || (s->z_max < s->radius && p[2] > s->z_max)))
    return false;
  if (s->kind == VL_SHAPE_CYLINDER && (p[2] < s->z_min || p[2] > s->z_max))
    return false;
  if (s->kind == VL_SHAPE_DISK) {
    double r2 = p[0] * p[0] + p[1] * p[1];
    if (r2 > (double)s->radius * s->radius || r2 < (double)s->inner_radius * s->inner_radius)
      return false;
  }
  return s->phi_max >= 6.2831f || angle_of(p) <= s->phi_max;
}

static bool try_root(const Quadric *s, const double o[3], const double d[3], double t,
                     double t_min, double t_max, vlShapeHit *hit) {
  if (!(t > t_min && t < t_max))
    return false;
  double p[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
  /* Projects the point onto the surface, which removes the error that grows with t. */
  double r2 = p[0] * p[0] + p[1] * p[1] + (s->kind == VL_SHAPE_SPHERE ? p[2] * p[2] : 0);
  if (s->kind == VL_SHAPE_DISK) {
    p[2] = s->height;
  } else if (r2 > 0) {
    double f = s->radius / sqrt(r2);
    p[0] *= f;
    p[1] *= f;
    if (s->kind == VL_SHAPE_SPHERE)
      p[2] *= f;
  }
  if (!inside_limits(s, p))
    return false;
  hit->t = t;
  memcpy(hit->p, p, 3 * sizeof *hit->p);
  return true;
}

/* Whether a ray clearly misses the sphere or cylinder between t_min and t_max: both roots are
 * negative, or both are beyond t_max, or its distance from the centre or axis is larger than
 * the radius; the latter two by more than rounding errors. o2: squared distance of its origin;
 * a, half_b, c: the coefficients of the equation for t. It spares most misses divisions and
 * square roots. */
static inline bool clearly_misses(double o2, double a, double half_b, double c, double r,
                                  double t_min, double t_max) {
  const double margin = 1e-12; /* several thousand rounding errors */
  if (c > 0 && half_b >= 0 && t_min >= 0)
    return true;
  if (half_b + a * t_max < 0 && (a * t_max + 2 * half_b) * t_max + c > margin * o2)
    return true;
  double scale = o2 * a;
  return scale - half_b * half_b > r * r * a * (1 + 1e-9) + scale * margin;
}

static bool quadric_intersect(const vlWorldShape *shape, uint32_t prim, const double go[3],
                              const double gd[3], double t_min, double t_max, vlShapeHit *hit) {
  Quadric quadric = load(shape, prim), *s = &quadric;
  double o[3], d[3];
  to_own(s, go, o);
  vl_map_vector(s->to_shape, gd, d);
  if (s->kind == VL_SHAPE_DISK)
    return d[2] != 0 && try_root(s, o, d, (s->height - o[2]) / d[2], t_min, t_max, hit);
  bool sphere = s->kind == VL_SHAPE_SPHERE;
  double r = s->radius;
  double a = d[0] * d[0] + d[1] * d[1] + (sphere ? d[2] * d[2] : 0);
  double half_b = o[0] * d[0] + o[1] * d[1] + (sphere ? o[2] * d[2] : 0);
  double o2 = o[0] * o[0] + o[1] * o[1] + (sphere ? o[2] * o[2] : 0), c = o2 - r * r;
  if (!(a > 0) || clearly_misses(o2, a, half_b, c, r, t_min, t_max))
    return false;
  /* Computes the discriminant from the vector between the axis (or centre) and the nearest
   * point of the ray (pbrt book 6.8.3), which avoids cancellation. */
  double k = half_b / a, l2 = 0;
  for (int i = 0; i < (sphere ? 3 : 2); i++) {
    double e = o[i] - k * d[i];
    l2 += e * e;
  }
  double disc = a * (r - sqrt(l2)) * (r + sqrt(l2));
  if (disc < 0)
    return false;
  double root = sqrt(disc), q = half_b < 0 ? -half_b + root : -half_b - root;
  double t0 = q / a, t1 = q != 0 ? c / q : t0;
  if (t0 > t1) {
    double t = t0;
    t0 = t1;
    t1 = t;
  }
  return try_root(s, o, d, t0, t_min, t_max, hit) || try_root(s, o, d, t1, t_min, t_max, hit);
}

/* The polar angle of a sphere's limit z. Most limits are poles, for which the compiler computes
 * it. */
static inline double theta_of(double z, double r) {
  if (z == -r)
    return vl_acos(-1.0f);
  return z == r ? vl_acos(1.0f) : vl_acos(vl_clamp((float)(z / r), -1, 1));
}

/* Partial derivatives over (u, v) in shape space, and uv. */
static void quadric_derivatives(const Quadric *s, const double p[3], double dpdu[3],
                                double dpdv[3], float uv[2]) {
  double phi = angle_of(p);
  uv[0] = (float)(phi / s->phi_max);
  dpdu[0] = -s->phi_max * p[1];
  dpdu[1] = s->phi_max * p[0];
  dpdu[2] = 0;
  if (s->kind == VL_SHAPE_SPHERE) {
    double r = s->radius;
    double low = theta_of(s->z_min, r), high = theta_of(s->z_max, r);
    double theta = vl_acos(vl_clamp((float)(p[2] / r), -1, 1));
    uv[1] = (float)((theta - low) / (high - low));
    double radial = sqrt(p[0] * p[0] + p[1] * p[1]);
    double cos_phi = radial > 0 ? p[0] / radial : 1, sin_phi = radial > 0 ? p[1] / radial : 0;
    if (!(radial > 0)) { /* at the poles any direction of a length near 0 is valid */
      dpdu[0] = 0;
      dpdu[1] = s->phi_max * 1e-12;
    }
    dpdv[0] = (high - low) * p[2] * cos_phi;
    dpdv[1] = (high - low) * p[2] * sin_phi;
    dpdv[2] = -(high - low) * radial;
  } else if (s->kind == VL_SHAPE_CYLINDER) {
    uv[1] = (float)((p[2] - s->z_min) / (s->z_max - s->z_min));
    dpdv[0] = 0;
    dpdv[1] = 0;
    dpdv[2] = s->z_max - s->z_min;
  } else {
    double radial = sqrt(p[0] * p[0] + p[1] * p[1]);
    uv[1] = (float)((s->radius - radial) / (s->radius - s->inner_radius));
    double f = radial > 0 ? (s->inner_radius - s->radius) / radial : 0;
    dpdv[0] = p[0] * f;
    dpdv[1] = p[1] * f;
    dpdv[2] = 0;
    if (!(radial > 0)) {
      dpdu[1] = s->phi_max * 1e-12;
      dpdv[0] = -1;
    }
  }
}

/* The direction of dpdu x dpdv in shape space. The inverse transpose maps it to group space,
 * where it still points outside, whether the map mirrors or not. Then vlWorldShape.flip
 * reverses it, as in pbrt: a mirrored sphere without reverse orientation has inward normals. */
static void quadric_normal(const Quadric *s, const double p[3], double n[3]) {
  n[0] = s->kind == VL_SHAPE_DISK ? 0 : p[0] / s->radius;
  n[1] = s->kind == VL_SHAPE_DISK ? 0 : p[1] / s->radius;
  n[2] = s->kind == VL_SHAPE_DISK ? 1 : s->kind == VL_SHAPE_SPHERE ? p[2] / s->radius : 0;
}

/* Bounds the rounding errors of a point: they are those of the numbers that it is computed
 * from, which may be larger than the point. */
static void bound_error(const Quadric *s, double error[3]) {
  double size =
      fmax(s->radius, s->kind == VL_SHAPE_DISK ? fabsf(s->height)
                                               : fmaxf(fabsf(s->z_min), fabsf(s->z_max)));
  for (int i = 0; i < 3; i++) {
    const double *m = s->from_shape + 4 * i;
    error[i] = fabs(m[3]);
    for (int j = 0; j < 3; j++)
      error[i] += fabs(m[j]) * (size + (s->center ? fabs(s->center[j]) : 0));
    error[i] *= VL_SHAPE_ERROR;
  }
}

static void describe(const Quadric *s, const double p[3], vlSurfacePoint *point) {
  double dpdu[3], dpdv[3], n[3];
  quadric_derivatives(s, p, dpdu, dpdv, point->uv);
  quadric_normal(s, p, n);
  from_own(s, p, point->p);
  if (s->center)
    bound_error(s, point->error);
  else
    memcpy(point->error, s->error, sizeof point->error);
  vl_map_vector(s->from_shape, dpdu, point->dpdu);
  vl_map_vector(s->from_shape, dpdv, point->dpdv);
  vl_map_normal(s->to_shape, n, point->n);
  double length = vl_normalize3(point->n), side = s->flip ? -1 : 1;
  double bend = s->kind == VL_SHAPE_DISK || !(s->radius > 0) ? 0 : 1.0 / s->radius;
  if (s->kind == VL_SHAPE_CYLINDER)
    dpdv[2] = 0; /* the normal of a cylinder does not change along its axis */
  for (int i = 0; i < 3; i++) {
    dpdu[i] *= bend;
    dpdv[i] *= bend;
  }
  vl_map_normal(s->to_shape, dpdu, point->dndu);
  vl_map_normal(s->to_shape, dpdv, point->dndv);
  vl_normal_derivative(point->n, length, point->dndu);
  vl_normal_derivative(point->n, length, point->dndv);
  for (int i = 0; i < 3; i++) {
    point->ns[i] = point->n[i] = side * point->n[i];
    point->dndu[i] *= side;
    point->dndv[i] *= side;
  }
}

static void quadric_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                          vlSurfacePoint *point) {
  Quadric quadric = load(shape, prim);
  describe(&quadric, hit->p, point);
}

static void quadric_bounds(const vlWorldShape *shape, uint32_t prim, double low[3],
                           double high[3]) {
  Quadric q = load(shape, prim);
  double r = q.radius, z0 = q.z_min, z1 = q.z_max;
  if (q.kind == VL_SHAPE_DISK)
    z0 = z1 = q.height;
  for (int k = 0; k < 8; k++) {
    double p[3] = {k & 1 ? r : -r, k & 2 ? r : -r, k & 4 ? z1 : z0}, g[3];
    from_own(&q, p, g);
    for (int i = 0; i < 3; i++) {
      low[i] = g[i] < low[i] ? g[i] : low[i];
      high[i] = g[i] > high[i] ? g[i] : high[i];
    }
  }
}

/* Factor by which the map from shape to group space stretches area: |det M| |M^-T n|. */
static double area_stretch(const Quadric *s, const double n_shape[3]) {
  double n[3];
  vl_map_normal(s->to_shape, n_shape, n);
  return fabs(vl_determinant3(s->from_shape)) * sqrt(vl_dot3(n, n));
}

static double shape_area(const Quadric *s) {
  if (s->kind == VL_SHAPE_DISK)
    return 0.5 * s->phi_max *
           ((double)s->radius * s->radius - (double)s->inner_radius * s->inner_radius);
  return (double)s->phi_max * s->radius * (s->z_max - s->z_min);
}

static void quadric_sample(const vlWorldShape *shape, uint32_t prim, float u, float v,
                           vlSurfacePoint *point, double *pdf) {
  Quadric quadric = load(shape, prim), *s = &quadric;
  double p[3];
  vlSinCos a = vl_sincos((float)(u * s->phi_max));
  /* Normalised, because the rounding of floats would put the point off the surface. */
  double length = sqrt((double)a.cos * a.cos + (double)a.sin * a.sin), x = a.cos / length,
         y = a.sin / length;
  if (s->kind == VL_SHAPE_DISK) {
    double inner2 = (double)s->inner_radius * s->inner_radius,
           outer2 = (double)s->radius * s->radius;
    double r = sqrt(inner2 + v * (outer2 - inner2));
    p[0] = r * x;
    p[1] = r * y;
    p[2] = s->height;
  } else {
    double z = s->z_min + v * ((double)s->z_max - s->z_min);
    double r = s->kind == VL_SHAPE_SPHERE ? sqrt(fmax(0, (double)s->radius * s->radius - z * z))
                                          : s->radius;
    p[0] = r * x;
    p[1] = r * y;
    p[2] = z;
  }
  describe(s, p, point);
  double n[3];
  quadric_normal(s, p, n);
  *pdf = 1 / (shape_area(s) * area_stretch(s, n));
}

static double quadric_pdf(const vlWorldShape *shape, uint32_t prim, const double at[3]) {
  Quadric quadric = load(shape, prim), *s = &quadric;
  double p[3], n[3];
  to_own(s, at, p);
  quadric_normal(s, p, n);
  if (s->kind != VL_SHAPE_DISK)
    vl_normalize3(n);
  return 1 / (shape_area(s) * area_stretch(s, n));
}

/* Finds whether the shape is a full sphere under a similarity. */
static void find_whole_sphere(vlWorldShape *s) {
  const double *m = s->from_shape;
  double scale;
  if (s->kind != VL_SHAPE_SPHERE || s->z_min > -s->radius || s->z_max < s->radius ||
      s->phi_max < 6.2831f || !vl_is_similarity(m, &scale))
    return;
  for (int i = 0; i < 3; i++)
    s->whole_center[i] = (float)m[4 * i + 3];
  s->whole_radius = s->radius * (float)scale;
}

/* Copies the centres and radii of a shape of many spheres. */
static vlResult copy_spheres(vlWorld *world, const vlShapeDef *def, vlWorldShape *s,
                             vlError *error) {
  s->faces = def->faces;
  s->phi_max = 2.0f * 3.14159265358979f;
  s->centers = vl_world_block(world, def->faces, 3 * sizeof *s->centers);
  if (!s->centers || !vl_world_copy_floats(world, def->radii, def->faces, &s->radii))
    return vl_fail_memory(error);
  memcpy(s->centers, def->centers, 3 * (size_t)def->faces * sizeof *s->centers);
  return VL_OK;
}

static vlResult quadric_compile(vlWorld *world, const vlShapeDef *def,
                                VL_UNUSED const vlMat4 *to_group,
                                VL_UNUSED const vlMat4 *from_group, vlWorldShape *shape,
                                vlError *error) {
  if (def->centers)
    return copy_spheres(world, def, shape, error);
  const Quadric quadric = load(shape, 0);
  bound_error(&quadric, shape->own_error);
  find_whole_sphere(shape);
  return VL_OK;
}

const vlShapeFunctions vl_quadric_functions = {quadric_compile,   quadric_bounds,
                                               quadric_intersect, quadric_point,
                                               quadric_sample,    quadric_pdf};
