/* world/surface_point.c: see surface_point.h. */
#include "world/surface_point.h"

#include <math.h>

#include "math/approx.h"

static void map_point(const double m[12], const double p[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}
static void map_vector(const double m[12], const double v[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
}
static void map_normal(const double inverse[12], const double n[3], double r[3]) {
  for (int i = 0; i < 3; i++) r[i] = inverse[i] * n[0] + inverse[4 + i] * n[1] + inverse[8 + i] * n[2];
}
static double dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static void cross3(const double a[3], const double b[3], double r[3]) {
  r[0] = a[1] * b[2] - a[2] * b[1];
  r[1] = a[2] * b[0] - a[0] * b[2];
  r[2] = a[0] * b[1] - a[1] * b[0];
}
static double normalize3(double a[3]) {
  double l = sqrt(dot3(a, a));
  if (l > 0)
    for (int i = 0; i < 3; i++) a[i] /= l;
  return l;
}

static double determinant3(const double m[12]) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* ---- quadrics, in shape space ---------------------------------------------------------------------------------------
 */

static double angle_of(const double p[3]) {
  double phi = vl_atan2((float)p[1], (float)p[0]);
  return phi < 0 ? phi + 2 * M_PI : phi;
}

/* Is this point of the full quadric part of the shape? */
static bool inside_limits(const vlWorldShape *s, const double p[3]) {
  if (s->kind == VL_SHAPE_SPHERE &&
      ((s->z_min > -s->radius && p[2] < s->z_min) || (s->z_max < s->radius && p[2] > s->z_max)))
    return false;
  if (s->kind == VL_SHAPE_CYLINDER && (p[2] < s->z_min || p[2] > s->z_max)) return false;
  if (s->kind == VL_SHAPE_DISK) {
    double r2 = p[0] * p[0] + p[1] * p[1];
    if (r2 > (double)s->radius * s->radius || r2 < (double)s->inner_radius * s->inner_radius) return false;
  }
  return s->phi_max >= 6.2831f || angle_of(p) <= s->phi_max;
}

static bool try_root(const vlWorldShape *s, const double o[3], const double d[3], double t, double t_min, double t_max,
                     vlShapeHit *hit) {
  if (!(t > t_min && t < t_max)) return false;
  double p[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
  /* Put the point on the surface: removes the error that grows with t. */
  double r2 = p[0] * p[0] + p[1] * p[1] + (s->kind == VL_SHAPE_SPHERE ? p[2] * p[2] : 0);
  if (s->kind == VL_SHAPE_DISK) {
    p[2] = s->height;
  } else if (r2 > 0) {
    double f = s->radius / sqrt(r2);
    p[0] *= f, p[1] *= f;
    if (s->kind == VL_SHAPE_SPHERE) p[2] *= f;
  }
  if (!inside_limits(s, p)) return false;
  hit->t = t;
  for (int i = 0; i < 3; i++) hit->p[i] = p[i];
  return true;
}

static bool intersect_quadric(const vlWorldShape *s, const double go[3], const double gd[3], double t_min, double t_max,
                              vlShapeHit *hit) {
  double o[3], d[3];
  map_point(s->to_shape, go, o);
  map_vector(s->to_shape, gd, d);
  if (s->kind == VL_SHAPE_DISK) return d[2] != 0 && try_root(s, o, d, (s->height - o[2]) / d[2], t_min, t_max, hit);
  bool sphere = s->kind == VL_SHAPE_SPHERE;
  double r = s->radius;
  double a = d[0] * d[0] + d[1] * d[1] + (sphere ? d[2] * d[2] : 0);
  double half_b = o[0] * d[0] + o[1] * d[1] + (sphere ? o[2] * d[2] : 0);
  if (!(a > 0)) return false;
  /* Discriminant through the vector from the axis to the nearest point of the ray (pbrt book 6.8.3): no cancellation.
   */
  double k = half_b / a, l2 = 0;
  for (int i = 0; i < (sphere ? 3 : 2); i++) {
    double e = o[i] - k * d[i];
    l2 += e * e;
  }
  double disc = a * (r - sqrt(l2)) * (r + sqrt(l2));
  if (disc < 0) return false;
  double root = sqrt(disc), q = half_b < 0 ? -half_b + root : -half_b - root;
  double c = o[0] * o[0] + o[1] * o[1] + (sphere ? o[2] * o[2] : 0) - r * r;
  double t0 = q / a, t1 = q != 0 ? c / q : t0;
  if (t0 > t1) {
    double t = t0;
    t0 = t1;
    t1 = t;
  }
  return try_root(s, o, d, t0, t_min, t_max, hit) || try_root(s, o, d, t1, t_min, t_max, hit);
}

/* Partial derivatives over (u, v) in shape space, and uv. */
static void quadric_derivatives(const vlWorldShape *s, const double p[3], double dpdu[3], double dpdv[3], float uv[2]) {
  double phi = angle_of(p);
  uv[0] = (float)(phi / s->phi_max);
  dpdu[0] = -s->phi_max * p[1], dpdu[1] = s->phi_max * p[0], dpdu[2] = 0;
  if (s->kind == VL_SHAPE_SPHERE) {
    double r = s->radius;
    double low = vl_acos(vl_clamp((float)(s->z_min / r), -1, 1)),
           high = vl_acos(vl_clamp((float)(s->z_max / r), -1, 1));
    double theta = vl_acos(vl_clamp((float)(p[2] / r), -1, 1));
    uv[1] = (float)((theta - low) / (high - low));
    double radial = sqrt(p[0] * p[0] + p[1] * p[1]);
    double cos_phi = radial > 0 ? p[0] / radial : 1, sin_phi = radial > 0 ? p[1] / radial : 0;
    if (!(radial > 0)) dpdu[0] = 0, dpdu[1] = s->phi_max * 1e-12; /* at the poles any direction will do */
    dpdv[0] = (high - low) * p[2] * cos_phi, dpdv[1] = (high - low) * p[2] * sin_phi, dpdv[2] = -(high - low) * radial;
  } else if (s->kind == VL_SHAPE_CYLINDER) {
    uv[1] = (float)((p[2] - s->z_min) / (s->z_max - s->z_min));
    dpdv[0] = 0, dpdv[1] = 0, dpdv[2] = s->z_max - s->z_min;
  } else {
    double radial = sqrt(p[0] * p[0] + p[1] * p[1]);
    uv[1] = (float)((s->radius - radial) / (s->radius - s->inner_radius));
    double f = radial > 0 ? (s->inner_radius - s->radius) / radial : 0;
    dpdv[0] = p[0] * f, dpdv[1] = p[1] * f, dpdv[2] = 0;
    if (!(radial > 0)) dpdu[1] = s->phi_max * 1e-12, dpdv[0] = -1;
  }
}

/* The normal transforms to the outside whatever the handedness; pbrt's flip is told by reverse orientation xor mirror,
 * and its cross product dpdu x dpdv mirrors too: both together leave the reverse orientation alone. flip holds the xor.
 */
bool vl_shape_reversed(const vlWorldShape *s) {
  return s->flip != (determinant3(s->from_shape) < 0);
}

static void quadric_normal(const vlWorldShape *s, const double p[3], double n[3]) {
  n[0] = s->kind == VL_SHAPE_DISK ? 0 : p[0] / s->radius;
  n[1] = s->kind == VL_SHAPE_DISK ? 0 : p[1] / s->radius;
  n[2] = s->kind == VL_SHAPE_DISK ? 1 : s->kind == VL_SHAPE_SPHERE ? p[2] / s->radius : 0;
}

static void quadric_point(const vlWorldShape *s, const double p[3], vlSurfacePoint *point) {
  double dpdu[3], dpdv[3], n[3];
  quadric_derivatives(s, p, dpdu, dpdv, point->uv);
  quadric_normal(s, p, n);
  map_point(s->from_shape, p, point->p);
  map_vector(s->from_shape, dpdu, point->dpdu);
  map_normal(s->to_shape, n, point->n);
  normalize3(point->n);
  bool reversed = vl_shape_reversed(s);
  for (int i = 0; i < 3; i++) point->ns[i] = point->n[i] = reversed ? -point->n[i] : point->n[i];
}

/* ---- bilinear patches
 * ------------------------------------------------------------------------------------------------ */

typedef struct Patch {
  double p00[3], p10[3], p01[3], p11[3];
  const uint32_t *index;
} Patch;

static Patch load_patch(const vlWorldShape *s, uint32_t prim) {
  Patch r;
  r.index = s->indices + 4 * (size_t)prim;
  for (int i = 0; i < 3; i++) {
    r.p00[i] = s->positions[3 * (size_t)r.index[0] + i];
    r.p10[i] = s->positions[3 * (size_t)r.index[1] + i];
    r.p01[i] = s->positions[3 * (size_t)r.index[2] + i];
    r.p11[i] = s->positions[3 * (size_t)r.index[3] + i];
  }
  return r;
}

static void patch_position(const Patch *q, double u, double v, double p[3]) {
  for (int i = 0; i < 3; i++)
    p[i] = (1 - u) * ((1 - v) * q->p00[i] + v * q->p01[i]) + u * ((1 - v) * q->p10[i] + v * q->p11[i]);
}

static void patch_derivatives(const Patch *q, double u, double v, double dpdu[3], double dpdv[3]) {
  for (int i = 0; i < 3; i++) {
    dpdu[i] = (1 - v) * (q->p10[i] - q->p00[i]) + v * (q->p11[i] - q->p01[i]);
    dpdv[i] = (1 - u) * (q->p01[i] - q->p00[i]) + u * (q->p11[i] - q->p10[i]);
  }
}

/* For a fixed u the patch is the line a(u) + v e(u); the ray meets it where the scalar triple product
 * (a(u) - o) . (d x e(u)) vanishes: a quadratic in u (Reshetov 2019, "Cool Patches"). */
static bool intersect_patch(const vlWorldShape *s, uint32_t prim, const double o[3], const double d[3], double t_min,
                            double t_max, vlShapeHit *hit) {
  Patch q = load_patch(s, prim);
  double a0[3], a1[3], e0[3], e1[3], x0[3], x1[3];
  for (int i = 0; i < 3; i++) {
    a0[i] = q.p00[i] - o[i];
    a1[i] = q.p10[i] - q.p00[i];
    e0[i] = q.p01[i] - q.p00[i];
    e1[i] = (q.p11[i] - q.p10[i]) - e0[i];
  }
  cross3(d, e0, x0);
  cross3(d, e1, x1);
  double c = dot3(a0, x0), b = dot3(a0, x1) + dot3(a1, x0), a = dot3(a1, x1);
  double roots[2];
  int count = 0;
  double scale = fabs(b) + fabs(c);
  if (fabs(a) <= 1e-14 * scale) {
    if (b != 0) roots[count++] = -c / b;
  } else {
    double disc = b * b - 4 * a * c;
    if (disc < 0) return false;
    double w = -0.5 * (b + copysign(sqrt(disc), b));
    roots[count++] = w / a;
    if (w != 0) roots[count++] = c / w;
  }
  bool found = false;
  for (int k = 0; k < count; k++) {
    double u = roots[k];
    if (!(u >= -1e-12 && u <= 1 + 1e-12)) continue;
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    double base[3], e[3], x[3];
    for (int i = 0; i < 3; i++) base[i] = a0[i] + u * a1[i], e[i] = e0[i] + u * e1[i];
    /* base + v e = t d: solve with the normal of the plane of d and e. */
    cross3(d, e, x);
    double den = dot3(x, x);
    if (!(den > 0)) continue;
    double y[3];
    cross3(base, d, y);
    double v = dot3(y, x) / den;
    cross3(base, e, y);
    double t = dot3(y, x) / den;
    if (!(v >= -1e-12 && v <= 1 + 1e-12) || !(t > t_min && t < t_max)) continue;
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    t_max = t;
    hit->t = t;
    hit->a = u;
    hit->b = v;
    found = true;
  }
  return found;
}

static void patch_point(const vlWorldShape *s, uint32_t prim, double u, double v, vlSurfacePoint *point) {
  Patch q = load_patch(s, prim);
  double dpdv[3];
  patch_position(&q, u, v, point->p);
  patch_derivatives(&q, u, v, point->dpdu, dpdv);
  cross3(point->dpdu, dpdv, point->n);
  normalize3(point->n);
  double w[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  point->uv[0] = (float)u, point->uv[1] = (float)v;
  if (s->uvs) {
    double a = 0, b = 0;
    for (int k = 0; k < 4; k++) {
      a += w[k] * s->uvs[2 * (size_t)q.index[k]];
      b += w[k] * s->uvs[2 * (size_t)q.index[k] + 1];
    }
    point->uv[0] = (float)a, point->uv[1] = (float)b;
  }
  if (s->flip)
    for (int i = 0; i < 3; i++) point->n[i] = -point->n[i];
  for (int i = 0; i < 3; i++) point->ns[i] = point->n[i];
  if (s->normals) {
    double ns[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++)
      for (int i = 0; i < 3; i++) ns[i] += w[k] * s->normals[3 * (size_t)q.index[k] + i];
    if (normalize3(ns) > 0) {
      double side = dot3(ns, point->n) < 0 ? -1 : 1; /* the geometric normal goes to the shading normal's side */
      for (int i = 0; i < 3; i++) point->ns[i] = ns[i], point->n[i] *= side;
    }
  }
}

/* ---- all kinds
 * --------------------------------------------------------------------------------------------------------- */

void vl_ray_to_group(const vlWorldInstance *instance, double o[3], double d[3]) {
  const float *m = instance->to_group;
  double p[3] = {o[0], o[1], o[2]}, v[3] = {d[0], d[1], d[2]};
  for (int i = 0; i < 3; i++) {
    o[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
    d[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
  }
}

bool vl_shape_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                        double t_max, vlShapeHit *hit) {
  hit->a = hit->b = 0;
  return shape->kind == VL_SHAPE_BILINEAR ? intersect_patch(shape, prim, o, d, t_min, t_max, hit)
                                          : intersect_quadric(shape, o, d, t_min, t_max, hit);
}

void vl_shape_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit, vlSurfacePoint *point) {
  if (shape->kind == VL_SHAPE_BILINEAR)
    patch_point(shape, prim, hit->a, hit->b, point);
  else
    quadric_point(shape, hit->p, point);
}

/* Density over area of points uniform in shape-space area: the map stretches area by |det M| |M^-T n|. */
static double area_stretch(const vlWorldShape *s, const double n_shape[3]) {
  double n[3];
  map_normal(s->to_shape, n_shape, n);
  return fabs(determinant3(s->from_shape)) * sqrt(dot3(n, n));
}

static double shape_area(const vlWorldShape *s) {
  if (s->kind == VL_SHAPE_DISK)
    return 0.5 * s->phi_max * ((double)s->radius * s->radius - (double)s->inner_radius * s->inner_radius);
  return (double)s->phi_max * s->radius * (s->z_max - s->z_min);
}

void vl_shape_sample(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf) {
  if (shape->kind == VL_SHAPE_BILINEAR) {
    patch_point(shape, prim, u, v, point);
    Patch q = load_patch(shape, prim);
    double dpdu[3], dpdv[3], n[3];
    patch_derivatives(&q, u, v, dpdu, dpdv);
    cross3(dpdu, dpdv, n);
    double l = sqrt(dot3(n, n));
    *pdf = l > 0 ? 1 / l : 0;
    return;
  }
  double p[3];
  vlSinCos a = vl_sincos((float)(u * shape->phi_max));
  if (shape->kind == VL_SHAPE_DISK) {
    double inner2 = (double)shape->inner_radius * shape->inner_radius, outer2 = (double)shape->radius * shape->radius;
    double r = sqrt(inner2 + v * (outer2 - inner2));
    p[0] = r * a.cos, p[1] = r * a.sin, p[2] = shape->height;
  } else {
    double z = shape->z_min + v * ((double)shape->z_max - shape->z_min);
    double r =
        shape->kind == VL_SHAPE_SPHERE ? sqrt(fmax(0, (double)shape->radius * shape->radius - z * z)) : shape->radius;
    p[0] = r * a.cos, p[1] = r * a.sin, p[2] = z;
  }
  quadric_point(shape, p, point);
  double n[3];
  quadric_normal(shape, p, n);
  *pdf = 1 / (shape_area(shape) * area_stretch(shape, n));
}

double vl_shape_pdf(const vlWorldShape *shape, uint32_t prim, const vlSurfacePoint *point) {
  if (shape->kind == VL_SHAPE_BILINEAR) {
    /* The parameters again: two Newton steps from the projection onto the patch would do; the density varies so slowly
     * that the nearest parameters by a coarse-to-fine search give it to float precision. */
    Patch q = load_patch(shape, prim);
    double u = 0.5, v = 0.5;
    for (int step = 0; step < 20; step++) {
      double p[3], du[3], dv[3], r[3];
      patch_position(&q, u, v, p);
      patch_derivatives(&q, u, v, du, dv);
      for (int i = 0; i < 3; i++) r[i] = point->p[i] - p[i];
      double a = dot3(du, du), b = dot3(du, dv), c = dot3(dv, dv), e = dot3(du, r), f = dot3(dv, r);
      double det = a * c - b * b;
      if (!(det > 0)) break;
      double su = (c * e - b * f) / det, sv = (a * f - b * e) / det;
      u += su, v += sv;
      u = u < 0 ? 0 : u > 1 ? 1 : u;
      v = v < 0 ? 0 : v > 1 ? 1 : v;
      if (fabs(su) + fabs(sv) < 1e-9) break;
    }
    double dpdu[3], dpdv[3], n[3];
    patch_derivatives(&q, u, v, dpdu, dpdv);
    cross3(dpdu, dpdv, n);
    double l = sqrt(dot3(n, n));
    return l > 0 ? 1 / l : 0;
  }
  double p[3], n[3];
  map_point(shape->to_shape, point->p, p);
  quadric_normal(shape, p, n);
  if (shape->kind != VL_SHAPE_DISK) normalize3(n);
  return 1 / (shape_area(shape) * area_stretch(shape, n));
}

/* ---- bounds and area, also of triangles
 * ---------------------------------------------------------------------------------- */

float vl_world_prim_area(const vlWorldShape *shape, uint32_t prim) {
  if (shape->kind == VL_SHAPE_TRIANGLES) {
    const uint32_t *f = shape->indices + 3 * (size_t)prim;
    double a[3], b[3], n[3];
    for (int i = 0; i < 3; i++) {
      double o = shape->positions[3 * (size_t)f[0] + i];
      a[i] = shape->positions[3 * (size_t)f[1] + i] - o;
      b[i] = shape->positions[3 * (size_t)f[2] + i] - o;
    }
    cross3(a, b, n);
    return (float)(0.5 * sqrt(dot3(n, n)));
  }
  /* Mean of 1/pdf over a grid of parameters: exact for similarity transforms and parallelograms. */
  double sum = 0;
  const int steps = 16;
  for (int i = 0; i < steps; i++)
    for (int j = 0; j < steps; j++) {
      vlSurfacePoint point;
      double pdf;
      vl_shape_sample(shape, prim, ((float)i + 0.5f) / steps, ((float)j + 0.5f) / steps, &point, &pdf);
      sum += pdf > 0 ? 1 / pdf : 0;
    }
  return (float)(sum / (steps * steps));
}

void vl_world_prim_bounds(const vlWorldShape *shape, uint32_t prim, float low[3], float high[3]) {
  double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
  int corners = shape->kind == VL_SHAPE_TRIANGLES ? 3 : shape->kind == VL_SHAPE_BILINEAR ? 4 : 0;
  for (int k = 0; k < corners; k++)
    for (int i = 0; i < 3; i++) {
      double x = shape->positions[3 * (size_t)shape->indices[(size_t)corners * prim + k] + i];
      lo[i] = x < lo[i] ? x : lo[i];
      hi[i] = x > hi[i] ? x : hi[i];
    }
  if (!corners) {
    double r = shape->radius;
    double z0 = shape->kind == VL_SHAPE_DISK ? shape->height : shape->z_min;
    double z1 = shape->kind == VL_SHAPE_DISK ? shape->height : shape->z_max;
    for (int k = 0; k < 8; k++) {
      double p[3] = {k & 1 ? r : -r, k & 2 ? r : -r, k & 4 ? z1 : z0}, g[3];
      map_point(shape->from_shape, p, g);
      for (int i = 0; i < 3; i++) {
        lo[i] = g[i] < lo[i] ? g[i] : lo[i];
        hi[i] = g[i] > hi[i] ? g[i] : hi[i];
      }
    }
  }
  for (int i = 0; i < 3; i++) { /* outwards by a float step, for the rounding */
    low[i] = nextafterf((float)lo[i], -INFINITY);
    high[i] = nextafterf((float)hi[i], INFINITY);
  }
}
