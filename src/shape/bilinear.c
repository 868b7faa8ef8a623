/* shape/bilinear.c: the bilinear patch: intersection, surface at given parameters, uniform
 * sampling of the parameters. */
#include <math.h>
#include <string.h>

#include "shape/mesh.h"

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
    p[i] = (1 - u) * ((1 - v) * q->p00[i] + v * q->p01[i]) +
           u * ((1 - v) * q->p10[i] + v * q->p11[i]);
}

static void patch_derivatives(const Patch *q, double u, double v, double dpdu[3],
                              double dpdv[3]) {
  for (int i = 0; i < 3; i++) {
    dpdu[i] = (1 - v) * (q->p10[i] - q->p00[i]) + v * (q->p11[i] - q->p01[i]);
    dpdv[i] = (1 - u) * (q->p01[i] - q->p00[i]) + u * (q->p11[i] - q->p10[i]);
  }
}

/* Intersection accepts u and v outside [0, 1] by this much, about 10^4 rounding errors, so that
 * no ray passes between adjacent patches. */
static const double overlap = 1e-12;
/* Relative size of the determinant below which the gradients of the two texture coordinates
 * count as parallel. */
static const double parallel = 1e-12;

/* For a fixed u the patch is the line a(u) + v e(u); the ray meets it where the scalar triple
 * product (a(u) - o) . (d x e(u)) is zero. This is a quadratic equation in u (Reshetov 2019,
 * "Cool Patches"). */
static bool patch_intersect(const vlWorldShape *s, uint32_t prim, const double o[3],
                            const double d[3], double t_min, double t_max, vlShapeHit *hit) {
  Patch q = load_patch(s, prim);
  double a0[3], a1[3], e0[3], e1[3], x0[3], x1[3];
  for (int i = 0; i < 3; i++) {
    a0[i] = q.p00[i] - o[i];
    a1[i] = q.p10[i] - q.p00[i];
    e0[i] = q.p01[i] - q.p00[i];
    e1[i] = (q.p11[i] - q.p10[i]) - e0[i];
  }
  vl_cross3(d, e0, x0);
  vl_cross3(d, e1, x1);
  double c = vl_dot3(a0, x0), b = vl_dot3(a0, x1) + vl_dot3(a1, x0), a = vl_dot3(a1, x1);
  double roots[2];
  int count = 0;
  double scale = fabs(b) + fabs(c);
  if (fabs(a) <= 1e-14 * scale) {
    /* the equation is linear: a is only rounding error, about 100 times 1e-16 */
    if (b != 0)
      roots[count++] = -c / b;
  } else {
    double disc = b * b - 4 * a * c;
    if (disc < 0)
      return false;
    double w = -0.5 * (b + copysign(sqrt(disc), b));
    roots[count++] = w / a;
    if (w != 0)
      roots[count++] = c / w;
  }
  bool found = false;
  for (int k = 0; k < count; k++) {
    double u = roots[k];
    if (!(u >= -overlap && u <= 1 + overlap))
      continue;
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    double base[3], e[3], x[3];
    vl_along3(a0, u, a1, base);
    vl_along3(e0, u, e1, e);
    /* Solves base + v e = t d with the normal of the plane that d and e span. */
    vl_cross3(d, e, x);
    double den = vl_dot3(x, x);
    if (!(den > 0))
      continue;
    double y[3];
    vl_cross3(base, d, y);
    double v = vl_dot3(y, x) / den;
    vl_cross3(base, e, y);
    double t = vl_dot3(y, x) / den;
    if (!(v >= -overlap && v <= 1 + overlap) || !(t > t_min && t < t_max))
      continue;
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    t_max = t;
    hit->t = t;
    hit->a = u;
    hit->b = v;
    found = true;
  }
  return found;
}

/* Derivatives of what is interpolated between the vertices: normals before normalisation, or
 * texture coordinates. of: `count` numbers for each vertex. */
static void slopes(const float *of, int count, const Patch *q, double u, double v, double *du,
                   double *dv) {
  for (int i = 0; i < count; i++) {
    double n[4];
    for (int k = 0; k < 4; k++)
      n[k] = of[(size_t)count * q->index[k] + (size_t)i];
    du[i] = (1 - v) * (n[1] - n[0]) + v * (n[3] - n[2]);
    dv[i] = (1 - u) * (n[2] - n[0]) + u * (n[3] - n[1]);
  }
}

/* Converts derivatives over the patch's parameters to derivatives over its texture coordinates
 * (pbrt book 6.6.2). If the texture coordinates are degenerate, the derivatives are kept. */
static void over_texture(const vlWorldShape *s, const Patch *q, double u, double v,
                         vlSurfacePoint *point) {
  double du[2], dv[2];
  slopes(s->uvs, 2, q, u, v, du, dv);
  double det = du[0] * dv[1] - du[1] * dv[0];
  if (!(fabs(det) > parallel * (fabs(du[0] * dv[1]) + fabs(du[1] * dv[0]))))
    return;
  double *pairs[2][2] = {{point->dpdu, point->dpdv}, {point->dndu, point->dndv}};
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 3; i++) {
      double a = pairs[k][0][i], b = pairs[k][1][i];
      pairs[k][0][i] = (dv[1] * a - du[1] * b) / det;
      pairs[k][1][i] = (du[0] * b - dv[0] * a) / det;
    }
}

static void surface_at(const vlWorldShape *s, uint32_t prim, double u, double v,
                       vlSurfacePoint *point) {
  Patch q = load_patch(s, prim);
  double mixed[3], length;
  patch_position(&q, u, v, point->p);
  double sum = 0; /* the error is along rays, in any direction */
  for (int i = 0; i < 3; i++)
    sum += fabs(q.p00[i]) + fabs(q.p10[i]) + fabs(q.p01[i]) + fabs(q.p11[i]);
  for (int i = 0; i < 3; i++)
    point->error[i] = VL_SHAPE_ERROR * sum;
  patch_derivatives(&q, u, v, point->dpdu, point->dpdv);
  vl_cross3(point->dpdu, point->dpdv, point->n);
  length = vl_normalize3(point->n);
  for (int i = 0; i < 3; i++)
    mixed[i] = q.p00[i] - q.p10[i] - q.p01[i] + q.p11[i];
  /* derivatives of dpdu x dpdv: dpdu is constant along u, dpdv along v */
  vl_cross3(point->dpdu, mixed, point->dndu);
  vl_cross3(mixed, point->dpdv, point->dndv);
  vl_normal_derivative(point->n, length, point->dndu);
  vl_normal_derivative(point->n, length, point->dndv);
  double w[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  point->uv[0] = (float)u;
  point->uv[1] = (float)v;
  if (s->uvs) {
    double a = 0, b = 0;
    for (int k = 0; k < 4; k++) {
      a += w[k] * s->uvs[2 * (size_t)q.index[k]];
      b += w[k] * s->uvs[2 * (size_t)q.index[k] + 1];
    }
    point->uv[0] = (float)a;
    point->uv[1] = (float)b;
  }
  if (s->flip)
    for (int i = 0; i < 3; i++) {
      point->n[i] = -point->n[i];
      point->dndu[i] = -point->dndu[i];
      point->dndv[i] = -point->dndv[i];
    }
  memcpy(point->ns, point->n, 3 * sizeof *point->ns);
  if (s->normals) {
    double ns[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++)
      for (int i = 0; i < 3; i++)
        ns[i] += w[k] * s->normals[3 * (size_t)q.index[k] + i];
    if ((length = vl_normalize3(ns)) > 0) {
      slopes(s->normals, 3, &q, u, v, point->dndu, point->dndv);
      vl_normal_derivative(ns, length, point->dndu);
      vl_normal_derivative(ns, length, point->dndv);
      /* The geometric normal is flipped to the side of the shading normal. */
      double side = vl_dot3(ns, point->n) < 0 ? -1 : 1;
      for (int i = 0; i < 3; i++) {
        point->ns[i] = ns[i];
        point->n[i] *= side;
      }
    }
  }
  if (s->uvs)
    over_texture(s, &q, u, v, point);
}

/* Density per unit area for uniformly sampled parameters. */
static double density(const Patch *q, double u, double v) {
  double dpdu[3], dpdv[3], n[3];
  patch_derivatives(q, u, v, dpdu, dpdv);
  vl_cross3(dpdu, dpdv, n);
  double l = sqrt(vl_dot3(n, n));
  return l > 0 ? 1 / l : 0;
}

static void patch_sample(const vlWorldShape *shape, uint32_t prim, float u, float v,
                         vlSurfacePoint *point, double *pdf) {
  surface_at(shape, prim, u, v, point);
  Patch q = load_patch(shape, prim);
  *pdf = density(&q, u, v);
}

static double patch_pdf(const vlWorldShape *shape, uint32_t prim, const double at[3]) {
  /* Gauss-Newton steps from the centre of the patch recover the parameters. They need not be
   * exact, since the density varies slowly. */
  Patch q = load_patch(shape, prim);
  double u = 0.5, v = 0.5;
  for (int step = 0; step < 20; step++) {
    double p[3], du[3], dv[3], r[3];
    patch_position(&q, u, v, p);
    patch_derivatives(&q, u, v, du, dv);
    vl_sub3(at, p, r);
    double a = vl_dot3(du, du), b = vl_dot3(du, dv), c = vl_dot3(dv, dv), e = vl_dot3(du, r),
           f = vl_dot3(dv, r);
    double det = a * c - b * b;
    if (!(det > 0))
      break;
    double su = (c * e - b * f) / det, sv = (a * f - b * e) / det;
    u += su;
    v += sv;
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    if (fabs(su) + fabs(sv) < 1e-9)
      break; /* the next step would be about 1e-18 */
  }
  return density(&q, u, v);
}

static void patch_bounds(const vlWorldShape *shape, uint32_t prim, double low[3],
                         double high[3]) {
  vl_mesh_bounds(shape, 4, prim, low, high);
}

static void patch_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                        vlSurfacePoint *point) {
  surface_at(shape, prim, hit->a, hit->b, point);
}

const vlShapeFunctions vl_bilinear_functions = {vl_mesh_compile, patch_bounds, patch_intersect,
                                                patch_point,     patch_sample, patch_pdf};
