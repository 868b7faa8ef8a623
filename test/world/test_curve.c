/* test_curve.c: curves through Embree and curve.c against a brute-force search: thousands of
 * points along each segment, with those nearest to the ray refined by bisection. Splitting,
 * transforms and instances must not matter. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "shape/surface_point.h"
#include "unit.h"
#include "velo/shape_kinds.h"

enum { SEGMENTS = 5, STEPS = 4000 };

static uint32_t seed = 7;
static double random_unit(void) {
  seed = seed * 1664525u + 1013904223u;
  return (seed >> 8) * 0x1p-24;
}
static double random_signed(void) {
  return 2 * random_unit() - 1;
}

typedef struct Hair {
  float p[SEGMENTS][12], w[SEGMENTS][2], n[SEGMENTS][6];
} Hair;

static void make_hair(Hair *h) {
  for (int s = 0; s < SEGMENTS; s++) {
    for (int i = 0; i < 12; i++)
      h->p[s][i] = (float)random_signed();
    for (int k = 0; k < 2; k++)
      h->w[s][k] = (float)(0.02 + 0.25 * random_unit());
    for (int k = 0; k < 2; k++) {
      double n[3] = {random_signed(), random_signed(), random_signed() + 0.1};
      double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      for (int i = 0; i < 3; i++)
        h->n[s][3 * k + i] = (float)(n[i] / l);
    }
  }
}

/* Shape space of curves to the world. */
static const double stretched[16] = {1.3, 0.2,  0,    0.1, -0.3, 0.7, 0.4, 0.2,
                                     0.1, -0.2, -1.1, 0,   0,    0,   0,   1};

static vlWorld *build(vlContext *context, const Hair *h, vlCurveKind kind, uint32_t split,
                      bool instance) {
  vlScene *scene;
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_CURVES);
  def.faces = SEGMENTS;
  def.vertices = 4 * SEGMENTS;
  def.positions = h->p[0];
  def.widths = h->w[0];
  def.normals = h->n[0];
  def.curve = kind;
  def.split_depth = split;
  if (instance) {
    def.group = vl_scene_add_group(scene, "hair");
    vl_scene_add_instance(scene, def.group, stretched, (vlSource){0});
  } else {
    memcpy(def.group_from_shape, stretched, sizeof stretched);
  }
  vl_scene_add_shape(scene, &def);
  vlResult r = vl_world_build(scene, NULL, &world, &error);
  if (r != VL_OK)
    fail_msg("%s", error.message);
  vl_scene_destroy(scene);
  return world;
}

/* ---- brute force, in shape space --------------------------------------------------------- */

typedef struct Found {
  bool hit, doubtful; /* so near an edge that rounding decides */
  double t, u, v;
} Found;

static void bezier(const float *p, double u, double q[3], double slope[3]) {
  double r = 1 - u;
  for (int i = 0; i < 3; i++) {
    q[i] = r * r * r * p[i] + 3 * r * r * u * p[3 + i] + 3 * r * u * u * p[6 + i] +
           u * u * u * p[9 + i];
    slope[i] = 3 * (r * r * (p[3 + i] - p[i]) + 2 * r * u * (p[6 + i] - p[3 + i]) +
                    u * u * (p[9 + i] - p[6 + i]));
  }
}
static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Half the derivative of the squared distance between the ray and the curve at u. */
static double falling(const float *p, double u, const double o[3], const double d[3]) {
  double q[3], s[3], r[3];
  bezier(p, u, q, s);
  for (int i = 0; i < 3; i++)
    r[i] = q[i] - o[i];
  double along = dot(r, d) / dot(d, d);
  for (int i = 0; i < 3; i++)
    r[i] -= along * d[i];
  return dot(r, s);
}

static void consider(const Hair *h, int s, vlCurveKind kind, double u, const double o[3],
                     const double d[3], Found *f) {
  double q[3], slope[3], r[3], d2 = dot(d, d), width = (1 - u) * h->w[s][0] + u * h->w[s][1];
  bezier(h->p[s], u, q, slope);
  for (int i = 0; i < 3; i++)
    r[i] = q[i] - o[i];
  double t = dot(r, d) / d2;
  for (int i = 0; i < 3; i++)
    r[i] = t * d[i] - r[i]; /* from the curve to the ray */
  double distance = sqrt(dot(r, r));
  if (kind == VL_CURVE_RIBBON) {
    const float *a = h->n[s], *b = a + 3;
    double angle =
               acos(fmin(1, (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2])),
           n[3];
    for (int i = 0; i < 3; i++)
      n[i] = (sin((1 - u) * angle) * a[i] + sin(u * angle) * b[i]) / sin(angle);
    width *= fabs(dot(n, d)) / sqrt(d2);
  }
  if (fabs(distance - 0.5 * width) < 2e-5)
    f->doubtful = true;
  if (distance > 0.5 * width || t <= 0 || (f->hit && t >= f->t))
    return;
  double left[3] = {d[1] * slope[2] - d[2] * slope[1], d[2] * slope[0] - d[0] * slope[2],
                    d[0] * slope[1] - d[1] * slope[0]};
  double v = distance / width;
  *f = (Found){true, f->doubtful, t, u, dot(left, r) > 0 ? 0.5 + v : 0.5 - v};
}

static Found brute_force(const Hair *h, vlCurveKind kind, const double o[3],
                         const double d[3]) {
  Found f = {0};
  for (int s = 0; s < SEGMENTS; s++) {
    double last = falling(h->p[s], 0, o, d);
    for (int k = 1; k <= STEPS; k++) {
      double u = (double)k / STEPS, now = falling(h->p[s], u, o, d);
      if (last <= 0 && now >= 0) {
        double low = (double)(k - 1) / STEPS, high = u;
        for (int i = 0; i < 40; i++) {
          double middle = 0.5 * (low + high);
          if (falling(h->p[s], middle, o, d) > 0)
            high = middle;
          else
            low = middle;
        }
        if (low < 1e-5 || high > 1 - 1e-5)
          f.doubtful = true;
        consider(h, s, kind, low, o, d, &f);
      }
      last = now;
    }
  }
  return f;
}

/* ---- the comparison ---------------------------------------------------------------------- */

static void to_shape(const double p[3], bool vector, double r[3]) {
  const double *m = stretched;
  double det = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
               m[2] * (m[4] * m[9] - m[5] * m[8]);
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = p[i] - (vector ? 0 : m[4 * i + 3]);
  for (int i = 0; i < 3; i++) { /* Cramer's rule */
    double c[9];
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        c[3 * a + b] = b == i ? q[a] : m[4 * a + b];
    r[i] = (c[0] * (c[4] * c[8] - c[5] * c[7]) - c[1] * (c[3] * c[8] - c[5] * c[6]) +
            c[2] * (c[3] * c[7] - c[4] * c[6])) /
           det;
  }
}

static int compare(vlWorld *world, const Hair *h, vlCurveKind kind, bool instance, int rays) {
  int hits = 0, doubtful = 0;
  for (int k = 0; k < rays; k++) {
    float o[3], d[3], t;
    double target[3], od[3], dd[3], so[3], sd[3];
    for (int i = 0; i < 3; i++) {
      o[i] = (float)(4 * random_signed());
      target[i] = 0.8 * random_signed();
    }
    for (int i = 0; i < 3; i++)
      d[i] = (float)(target[i] - o[i]);
    for (int i = 0; i < 3; i++) {
      od[i] = o[i];
      dd[i] = d[i];
    }
    to_shape(od, false, so);
    to_shape(dd, true, sd);
    Found f = brute_force(h, kind, so, sd);
    vlRays ray = {o, o + 1, o + 2, d, d + 1, d + 2, NULL, NULL, NULL, NULL};
    uint32_t shape, prim, at;
    uint8_t occluded;
    vl_accel_closest(world, 1, &ray, k % 2, &shape, &prim, &at, &t);
    vl_accel_occluded(world, 1, &ray, NULL, &occluded);
    doubtful += f.doubtful;
    if (f.doubtful)
      continue;
    if ((shape != VL_NONE) != f.hit || occluded != f.hit)
      fail_msg("ray %d: hit %d, by brute force %d", k, shape == 0, f.hit);
    if (!f.hit)
      continue;
    hits++;
    if (!(fabs(t - f.t) < 1e-5 * f.t))
      fail_msg("ray %d: t %g, by brute force %g", k, (double)t, f.t);
    vlShapeHit hit;
    vlSurfacePoint point;
    double go[3], gd[3];
    memcpy(go, od, sizeof go);
    memcpy(gd, dd, sizeof gd);
    if (instance)
      vl_ray_to_group(&world->instances.items[at], go, gd);
    assert_true(vl_shape_intersect(&world->shapes.items[0], prim, go, gd, t * 0.999999,
                                   t * 1.000001, &hit));
    vl_shape_point(&world->shapes.items[0], prim, &hit, &point);
    /* u may turn quickly with the ray where it looks along the curve. */
    if (!(fabs(point.uv[0] - f.u) < 1e-3) || !(fabs(point.uv[1] - f.v) < 2e-3))
      fail_msg("ray %d: u, v %g %g, by brute force %g %g", k, (double)point.uv[0],
               (double)point.uv[1], f.u, f.v);
    double off[3], on[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
      on[i] = go[i] + f.t * gd[i];
      off[i] = point.p[i] - on[i];
    }
    assert_true(dot(off, off) < 1e-8);
    assert_true(fabs(dot(point.n, point.n) - 1) < 1e-9 &&
                fabs(dot(point.n, point.dpdu)) < 1e-6 * (1 + dot(point.dpdu, point.dpdu)));
    assert_true(point.off > 0);
  }
  assert_true(doubtful < rays / 20);
  return hits;
}

static void against_brute_force(void **state) {
  (void)state;
  vlContextDef context_def = vl_default_context_def();
  vlContext *context;
  assert_int_equal(vl_context_create(&context_def, &context), VL_OK);
  Hair hair;
  for (int round = 0; round < 6; round++)
    for (int kind = 0; kind < 3; kind++) {
      make_hair(&hair);
      bool instance = round & 1;
      static const uint32_t splits[3] = {3, 0, 6};
      vlWorld *world = build(context, &hair, (vlCurveKind)kind, splits[round / 2], instance);
      int hits = compare(world, &hair, (vlCurveKind)kind, instance, 150);
      assert_true(hits > 10);
      vl_world_destroy(world);
    }
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* The normal of a cylinder at v: across the curve as a tube has it, also where rays are oblique
 * to the curve; of a flat curve: along the ray, as far as it is perpendicular to the curve. */
static void normals(void **state) {
  (void)state;
  vlWorldShape s = {.kind = VL_SHAPE_CURVES, .faces = 1, .steps = 1, .alpha = -1};
  float p[12] = {0, -1, 0, 0, -0.33f, 0, 0, 0.33f, 0, 0, 1, 0}, w[2] = {0.5f, 0.5f},
        n[6] = {0.6f, 0, -0.8f, 0.6f, 0, -0.8f};
  s.positions = p;
  s.widths = w;
  s.normals = n;
  for (int i = 0; i < 3; i++)
    s.from_shape[5 * i] = s.to_shape[5 * i] = 1;
  for (int kind = 0; kind < 3; kind++)
    for (int k = -18; k < 20; k++) {
      s.curve = (vlCurveKind)kind;
      double slant = k & 1 && kind != VL_CURVE_RIBBON ? 2.5 : 0;
      double x = 0.0247 * (k >> 1), o[3] = {x, 0.1 - 1.5 * slant, -3}, d[3] = {0, slant, 2};
      vlShapeHit hit;
      vlSurfacePoint point;
      bool met = vl_shape_intersect(&s, 0, o, d, 0, 10, &hit);
      assert_true(met == (kind != VL_CURVE_RIBBON || fabs(x) <= 0.25 * 0.8));
      if (!met)
        continue;
      assert_true(fabs(hit.t - 1.5) < 1e-12);
      vl_shape_point(&s, 0, &hit, &point);
      /* dpdu is up, left of it (as numbers, d x up) is -x: v grows to there; n = dpdu x
       * dpdv. */
      double v = 0.5 - x / (kind == VL_CURVE_RIBBON ? 0.4 : 0.5),
             turn = 3.14159265358979 * (v - 0.5);
      assert_true(fabs(point.uv[1] - v) < 1e-6);
      double expected[3] = {0, 0, 1};
      if (kind == VL_CURVE_CYLINDER) {
        expected[0] = -sin(turn);
        expected[2] = cos(turn);
      }
      if (kind == VL_CURVE_RIBBON) {
        expected[0] = -0.6;
        expected[2] = 0.8;
      }
      for (int i = 0; i < 3; i++)
        if (!(fabs(fabs(point.n[i]) - fabs(expected[i])) < 1e-6))
          fail_msg("kind %d, v %g: normal %d", kind, v, i);
      if (kind == VL_CURVE_CYLINDER)
        for (int i = 0; i < 3; i++)
          assert_true(fabs(point.n[i] - expected[i]) < 1e-6);
      assert_true(point.dpdu[1] > 0);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(against_brute_force),
                                     cmocka_unit_test(normals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
