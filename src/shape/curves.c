/* shape/curves.c: curves with a width: pieces of cubic Bezier segments. A ray is
 * intersected at the point where it comes nearest to the axis.
 *
 * Conventions are pbrt-v4's (book 6.7): a flat curve faces every ray; a cylinder differs from a
 * flat curve by its normal only; the visible width of a ribbon is multiplied by the cosine
 * between its normal and the ray. The hit point lies on the ray, where the ray comes nearest to
 * the axis. Everything is in shape space unless stated otherwise.
 *
 * Where rays start that leave a curve. For a cylinder of radius r, let the hit point lie x r
 * beside the axis; the normal n, turned by the angle a = x pi / 2, is perpendicular to the
 * axis. A point at the distance k along n (or -n) is k + x r sin a (k - x r sin a) from the
 * plane through the axis that is perpendicular to n. A ray that starts there and goes away from
 * that plane, or along it, passes the axis at that distance at least, or has passed it. So it
 * does not meet the curve if k >= r (1 + |x sin a|), which is 2 r, the width, at the edges. For
 * flat curves and ribbons r is enough.
 *
 * velo takes pbrt's distance: the width along each axis of shape space, that is 1 to 1.73
 * widths along the normal. In rows of hair that nearly touch the image depends on it, so it is
 * a convention, as the shape itself is. It does not change when a scene is turned. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/approx.h"
#include "shape/shape_kind.h"
#include "velo/shape.h"

/* Bezier control points in ray coordinates: x and y are perpendicular to the ray, z is along
 * the ray. */
typedef struct Cubic {
  double x[4], y[4], z[4];
} Cubic;

static bool copy_curves(vlWorld *world, const vlShapeDef *def, vlWorldShape *s) {
  size_t n = def->faces;
  /* Pieces per shape, since Embree's box of a piece takes more memory than the curve. */
  enum { MAX_PIECES = 1 << 23 };
  s->curve = def->curve;
  s->split = def->split_depth < 6 ? def->split_depth : 6;
  while (s->split && (n << s->split) > MAX_PIECES)
    s->split--;
  s->vertices = (uint32_t)(4 * n);
  s->faces = (uint32_t)(n << s->split);
  s->positions = vl_world_block(world, 12 * n, sizeof(float));
  s->widths = vl_world_block(world, 2 * n, sizeof(float));
  if (!s->positions || !s->widths)
    return false;
  memcpy(s->positions, def->positions, 12 * n * sizeof(float));
  memcpy(s->widths, def->widths, 2 * n * sizeof(float));
  if (def->curve != VL_CURVE_RIBBON)
    return true;
  if (!(s->normals = vl_world_block(world, 6 * n, sizeof(float))))
    return false;
  memcpy(s->normals, def->normals, 6 * n * sizeof(float));
  return true;
}

static double width_at(const vlWorldShape *s, uint32_t segment, double u) {
  const float *w = s->widths + 2 * (size_t)segment;
  return (1 - u) * w[0] + u * w[1];
}

/* Parameter range of a piece on its segment. */
static void piece_range(const vlWorldShape *s, uint32_t prim, double *u0, double *u1) {
  uint32_t count = 1u << s->split, k = prim & (count - 1);
  *u0 = (double)k / count;
  *u1 = (double)(k + 1) / count;
}

static inline double mix(double a, double b, double t) {
  return (1 - t) * a + t * b;
}

/* The blossom (polar form) of the cubic with control points c, at three parameters. */
static inline double blossom(const double c[4], double a, double b, double e) {
  double p0 = mix(c[0], c[1], a), p1 = mix(c[1], c[2], a), p2 = mix(c[2], c[3], a);
  return mix(mix(p0, p1, b), mix(p1, p2, b), e);
}

static inline void cut(const double c[4], double u0, double u1, double r[4]) {
  r[0] = blossom(c, u0, u0, u0);
  r[1] = blossom(c, u0, u0, u1);
  r[2] = blossom(c, u0, u1, u1);
  r[3] = blossom(c, u1, u1, u1);
}

/* fmin and fmax are calls, which take longer than the comparisons. */
static inline double smaller(double a, double b) {
  return a < b ? a : b;
}
static inline double larger(double a, double b) {
  return a > b ? a : b;
}
static inline double range_low(const double c[4]) {
  return smaller(smaller(c[0], c[1]), smaller(c[2], c[3]));
}
static inline double range_high(const double c[4]) {
  return larger(larger(c[0], c[1]), larger(c[2], c[3]));
}

static void curve_bounds(const vlWorldShape *s, uint32_t prim, double low[3], double high[3]) {
  uint32_t segment = prim >> s->split;
  const float *p = s->positions + 12 * (size_t)segment;
  double u0, u1, c[3][4], q[3][4];
  piece_range(s, prim, &u0, &u1);
  for (int k = 0; k < 4; k++) {
    double from[3] = {p[3 * k], p[3 * k + 1], p[3 * k + 2]}, to[3];
    vl_map_point(s->from_shape, from, to);
    for (int i = 0; i < 3; i++)
      c[i][k] = to[i];
  }
  double radius = 0.5 * fmax(width_at(s, segment, u0), width_at(s, segment, u1));
  for (int i = 0; i < 3; i++) {
    const double *m = s->from_shape + 4 * i;
    double reach = radius * vl_norm3(m); /* extent of a transformed ball */
    cut(c[i], u0, u1, q[i]);
    low[i] = range_low(q[i]) - reach;
    high[i] = range_high(q[i]) + reach;
  }
}

/* ---- meeting a ray ----------------------------------------------------------------------- */

typedef struct Search {
  const vlWorldShape *shape;
  uint32_t segment;
  double d[3]; /* unit */
  /* range of z along the ray in which hits count; every hit lowers z_max */
  double z_min, z_max;
  double flat; /* largest deviation of a leaf of the bisection from a straight line */
  double u, v;
  bool found;
} Search;

/* Normal of a ribbon: spherical interpolation between the normals of the segment's ends. */
static void ribbon_normal(const vlWorldShape *s, uint32_t segment, double u, double n[3]) {
  const float *a = s->normals + 6 * (size_t)segment, *b = a + 3;
  double from[3] = {a[0], a[1], a[2]}, to[3] = {b[0], b[1], b[2]};
  vl_normalize3(from);
  vl_normalize3(to);
  float angle = vl_acos(vl_clamp((float)vl_dot3(from, to), -1, 1));
  double f = 1 - u, t = u;
  /* For angles below 1e-3 linear interpolation has an error of angle^2 / 8 = 1e-7, the rounding
   * error of a float. */
  if (angle > 1e-3f) {
    f = vl_sincos((float)(1 - u) * angle).sin;
    t = vl_sincos((float)u * angle).sin;
  }
  for (int i = 0; i < 3; i++)
    n[i] = f * from[i] + t * to[i];
  vl_normalize3(n);
}

static double seen_width(const vlWorldShape *s, uint32_t segment, double u, const double d[3]) {
  double width = width_at(s, segment, u);
  if (s->curve != VL_CURVE_RIBBON)
    return width;
  double n[3];
  ribbon_normal(s, segment, u, n);
  return width * fabs(vl_dot3(n, d));
}

static inline double bezier(const double c[4], double w) {
  double r = 1 - w;
  return r * r * (r * c[0] + 3 * w * c[1]) + w * w * (3 * r * c[2] + w * c[3]);
}
static inline double bezier_slope(const double c[4], double w) {
  double r = 1 - w;
  return 3 * (r * r * (c[1] - c[0]) + 2 * r * w * (c[2] - c[1]) + w * w * (c[3] - c[2]));
}
static inline double bezier_bend(const double c[4], double w) {
  return 6 * ((1 - w) * (c[2] - 2 * c[1] + c[0]) + w * (c[3] - 2 * c[2] + c[1]));
}

/* Parameter at which the curve is nearest to the ray: the zero of x x' + y y', the derivative
 * of half the squared distance. */
static double find_foot(const Cubic *c, double w) {
  double low = 0, high = 1;
  for (int step = 0; step < 40; step++) {
    double x = bezier(c->x, w), y = bezier(c->y, w), dx = bezier_slope(c->x, w),
           dy = bezier_slope(c->y, w);
    double f = x * dx + y * dy;
    double slope = dx * dx + dy * dy + x * bezier_bend(c->x, w) + y * bezier_bend(c->y, w);
    if (f > 0)
      high = w;
    else
      low = w;
    double next = slope > 0 ? w - f / slope : -1;
    if (!(next >= low && next <= high))
      next = 0.5 * (low + high);
    if (fabs(next - w) < 1e-10)
      return next; /* well below the rounding error of w as a float */
    w = next;
  }
  return w;
}

static void leaf(Search *q, const Cubic *c, double u0, double u1, double half) {
  /* The distance between curve and ray must decrease at the start and increase at the end.
   * Otherwise the nearest point belongs to a neighbouring piece, or lies beyond the end of the
   * curve; the end is cut off perpendicularly. */
  if (c->x[0] * (c->x[1] - c->x[0]) + c->y[0] * (c->y[1] - c->y[0]) > 0)
    return;
  if (c->x[3] * (c->x[3] - c->x[2]) + c->y[3] * (c->y[3] - c->y[2]) < 0)
    return;
  double sx = c->x[3] - c->x[0], sy = c->y[3] - c->y[0], l2 = sx * sx + sy * sy;
  double w = l2 > 0 ? -(c->x[0] * sx + c->y[0] * sy) / l2 : 0.5;
  w = w > 0 ? (w < 1 ? w : 1) : 0;
  double nx = c->x[0] + w * sx, ny = c->y[0] + w * sy, reach = half + q->flat;
  if (nx * nx + ny * ny > reach * reach)
    return;
  w = find_foot(c, w);
  double x = bezier(c->x, w), y = bezier(c->y, w), z = bezier(c->z, w);
  double u = mix(u0, u1, w), width = seen_width(q->shape, q->segment, u, q->d),
         distance2 = x * x + y * y;
  if (!(distance2 <= 0.25 * width * width) || !(z > q->z_min && z < q->z_max))
    return;
  /* side of the curve on which the ray passes */
  double side = bezier_slope(c->y, w) * x - bezier_slope(c->x, w) * y;
  double across = width > 0 ? sqrt(distance2) / width : 0;
  q->z_max = z;
  q->u = u;
  q->v = side > 0 ? 0.5 + across : 0.5 - across;
  q->found = true;
}

static bool misses(const Search *q, const Cubic *c, double half) {
  return range_low(c->x) > half || range_high(c->x) < -half || range_low(c->y) > half ||
         range_high(c->y) < -half || range_low(c->z) > q->z_max || range_high(c->z) < q->z_min;
}

static void split(const double c[4], double a[4], double b[4]) {
  double m = 0.5 * (c[1] + c[2]);
  a[0] = c[0];
  a[1] = 0.5 * (c[0] + c[1]);
  a[2] = 0.5 * (a[1] + m);
  b[3] = c[3];
  b[2] = 0.5 * (c[2] + c[3]);
  b[1] = 0.5 * (m + b[2]);
  a[3] = b[0] = 0.5 * (a[2] + b[1]);
}

static void search(Search *q, const Cubic *c, double u0, double u1, int depth) {
  double half =
      0.5 * larger(width_at(q->shape, q->segment, u0), width_at(q->shape, q->segment, u1));
  if (misses(q, c, half))
    return;
  if (depth == 0) {
    leaf(q, c, u0, u1, half);
    return;
  }
  Cubic a, b;
  double middle = 0.5 * (u0 + u1);
  split(c->x, a.x, b.x);
  split(c->y, a.y, b.y);
  split(c->z, a.z, b.z);
  search(q, &a, u0, middle, depth - 1);
  search(q, &b, middle, u1, depth - 1);
}

/* Number of bisections after which the parts deviate from straight lines by less than a
 * twentieth of the width (pbrt book 6.7.2). */
static int depth_for(const Cubic *c, double width, double *flat) {
  double bend = 0;
  for (int i = 0; i < 2; i++) {
    bend = fmax(bend, fabs(c->x[i] - 2 * c->x[i + 1] + c->x[i + 2]));
    bend = fmax(bend, fabs(c->y[i] - 2 * c->y[i + 1] + c->y[i + 2]));
  }
  double error = 1.0607 * bend; /* sqrt(2) 6 bend / 8 */
  int depth = 0;
  for (; depth < 10 && error > 0.05 * width; depth++)
    error *= 0.25;
  *flat = error;
  return depth;
}

static bool curve_intersect(const vlWorldShape *s, uint32_t prim, const double go[3],
                            const double gd[3], double t_min, double t_max, vlShapeHit *hit) {
  double o[3], x[3], y[3], u0, u1;
  Search q = {.shape = s, .segment = prim >> s->split};
  vl_map_point(s->to_shape, go, o);
  vl_map_vector(s->to_shape, gd, q.d);
  double length = vl_normalize3(q.d);
  if (!(length > 0))
    return false;
  /* An orthonormal basis perpendicular to the ray (Duff et al. 2017). */
  double sign = q.d[2] < 0 ? -1 : 1, a = -1 / (sign + q.d[2]), b = q.d[0] * q.d[1] * a;
  x[0] = 1 + sign * q.d[0] * q.d[0] * a;
  x[1] = sign * b;
  x[2] = -sign * q.d[0];
  y[0] = b;
  y[1] = sign + q.d[1] * q.d[1] * a;
  y[2] = -q.d[1];
  const float *p = s->positions + 12 * (size_t)q.segment;
  Cubic whole, c;
  for (int k = 0; k < 4; k++) {
    double r[3] = {p[3 * k] - o[0], p[3 * k + 1] - o[1], p[3 * k + 2] - o[2]};
    whole.x[k] = vl_dot3(r, x);
    whole.y[k] = vl_dot3(r, y);
    whole.z[k] = vl_dot3(r, q.d);
  }
  piece_range(s, prim, &u0, &u1);
  cut(whole.x, u0, u1, c.x);
  cut(whole.y, u0, u1, c.y);
  cut(whole.z, u0, u1, c.z);
  q.z_min = t_min * length;
  q.z_max = t_max * length;
  double width = larger(width_at(s, q.segment, u0), width_at(s, q.segment, u1));
  if (misses(&q, &c, 0.5 * width))
    return false;
  int depth = depth_for(&c, width, &q.flat);
  search(&q, &c, u0, u1, depth);
  if (!q.found)
    return false;
  hit->t = q.z_max / length;
  hit->a = q.u;
  hit->b = q.v;
  vl_along3(o, q.z_max, q.d, hit->p);
  memcpy(hit->d, q.d, 3 * sizeof *hit->d);
  return hit->t > t_min && hit->t < t_max;
}

/* ---- what it is like there --------------------------------------------------------------- */

static void scale_to(double v[3], double length) {
  double l = vl_normalize3(v);
  for (int i = 0; i < 3; i++)
    v[i] = l > 0 ? v[i] * length : 0;
}

static void curve_point(const vlWorldShape *s, uint32_t prim, const vlShapeHit *hit,
                        vlSurfacePoint *point) {
  uint32_t segment = prim >> s->split;
  const float *p = s->positions + 12 * (size_t)segment;
  double u = hit->a, v = hit->b, along[3], across[3], n[3], width = width_at(s, segment, u);
  for (int i = 0; i < 3; i++) {
    double c[4] = {p[i], p[3 + i], p[6 + i], p[9 + i]};
    along[i] = bezier_slope(c, u);
    if (!(fabs(along[i]) > 0))
      /* if control points coincide; only the direction counts */
      along[i] = (c[3] - c[0]) * 1e-6;
  }
  /* for a curve without length: any direction perpendicular to the ray */
  if (!(vl_dot3(along, along) > 0)) {
    double axis[3] = {fabs(hit->d[0]) < 0.6, fabs(hit->d[0]) >= 0.6, 0};
    vl_cross3(hit->d, axis, along);
  }
  if (s->curve == VL_CURVE_RIBBON) {
    ribbon_normal(s, segment, u, n);
    vl_cross3(n, along, across);
    scale_to(across, seen_width(s, segment, u, hit->d));
  } else {
    vl_cross3(hit->d, along, across);
    scale_to(across, width);
  }
  if (s->curve == VL_CURVE_CYLINDER) { /* the normal is rotated about the curve by up to 90
                                          degrees to each side */
    double axis[3] = {along[0], along[1], along[2]}, up[3];
    scale_to(axis, 1);
    vl_cross3(axis, across, up);
    vlSinCos turn = vl_sincos((float)((0.5 - v) * M_PI));
    for (int i = 0; i < 3; i++)
      across[i] = across[i] * turn.cos + up[i] * turn.sin;
  }
  vl_cross3(along, across, n);
  if (!(vl_normalize3(n) > 0))
    memcpy(n, hit->d, 3 * sizeof *n);
  vl_map_point(s->from_shape, hit->p, point->p);
  vl_map_vector(s->from_shape, along, point->dpdu);
  vl_map_vector(s->from_shape, across, point->dpdv);
  for (int i = 0; i < 3; i++)
    point->dndu[i] = point->dndv[i] = 0;
  vl_map_normal(s->to_shape, n, point->n);
  /* the inverse of the factor for distances along n */
  double stretch = vl_normalize3(point->n);
  point->off = stretch > 0 ? width * (fabs(n[0]) + fabs(n[1]) + fabs(n[2])) / stretch : 0;
  double side = s->flip ? -1 : 1;
  for (int i = 0; i < 3; i++) {
    point->n[i] *= side;
    point->ns[i] = point->n[i];
  }
  point->uv[0] = (float)u;
  point->uv[1] = (float)v;
}

/* Gives the middle of a piece. Curves do not emit light, so no other samples are needed. */
static void curve_sample(const vlWorldShape *s, uint32_t prim, VL_UNUSED float u,
                         VL_UNUSED float v, vlSurfacePoint *point, VL_UNUSED double *pdf) {
  const float *p = s->positions + 12 * (size_t)(prim >> s->split);
  double u0, u1;
  piece_range(s, prim, &u0, &u1);
  vlShapeHit hit = {.a = 0.5 * (u0 + u1), .b = 0.5, .d = {0, 0, 1}};
  for (int i = 0; i < 3; i++) {
    double c[4] = {p[i], p[3 + i], p[6 + i], p[9 + i]};
    hit.p[i] = bezier(c, hit.a);
  }
  curve_point(s, prim, &hit, point);
}

static double curve_pdf(VL_UNUSED const vlWorldShape *shape, VL_UNUSED uint32_t prim,
                        VL_UNUSED const double at[3]) {
  return 0;
}

static vlResult curve_compile(vlWorld *world, const vlShapeDef *def,
                              VL_UNUSED const vlMat4 *to_group,
                              VL_UNUSED const vlMat4 *from_group, vlWorldShape *shape,
                              vlError *error) {
  return copy_curves(world, def, shape) ? VL_OK : vl_fail_memory(error);
}

const vlShapeFunctions vl_curves_functions = {curve_compile, curve_bounds, curve_intersect,
                                              curve_point,   curve_sample, curve_pdf};
