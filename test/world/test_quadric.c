/* test/world/test_quadric.c: partial spheres, disks and cylinders under transforms that are not
 * similarities: sampled points lie on the part, rays hit them there with the same uv and
 * normal, densities are per area, which a grid over the parameters gives. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shape/surface_point.h"
#include "unit.h"
#include "velo/shape_kinds.h"
#include "world/world.h"

typedef struct Part {
  const char *name;
  vlShapeKind kind;
  float radius, inner, z_min, z_max, height, phi_max;
} Part;

static const Part parts[] = {
    {"sphere", VL_SHAPE_SPHERE, 1.5f, 0, -1.5f, 1.5f, 0, 6.2831853f},
    {"zone of a sphere", VL_SHAPE_SPHERE, 1.5f, 0, -0.4f, 1.1f, 0, 4.0f},
    {"cap of a sphere", VL_SHAPE_SPHERE, 2, 0, 1.2f, 2, 0, 6.2831853f},
    {"slice of a cylinder", VL_SHAPE_CYLINDER, 0.7f, 0, -1, 2, 0, 2.5f},
    {"slice of a ring", VL_SHAPE_DISK, 2, 0.8f, 0, 0, 0.3f, 5.0f},
};

static const double matrices[3][16] = {
    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
    {1.2, 0.3, 0, 1, -0.4, 0.8, 0.5, -2, 0.1, -0.2, 0.6, 3, 0, 0, 0, 1},
    {-1, 0.2, 0, 0, 0, 2, 0.3, 1, 0, 0, 0.5, 0, 0, 0, 0, 1}, /* mirrors */
};

static vlWorld *build(const Part *p, const double m[16], vlContext **context) {
  vlScene *scene;
  vlWorld *world;
  vlError error = {0};
  assert_int_equal(vl_context_create(NULL, context), VL_OK);
  assert_int_equal(vl_scene_create(*context, &scene), VL_OK);
  vlShapeDef def = vl_default_shape_def(p->kind);
  def.radius = p->radius;
  def.inner_radius = p->inner;
  def.z_min = p->z_min;
  def.z_max = p->z_max;
  def.height = p->height;
  def.phi_max = p->phi_max;
  memcpy(def.group_from_shape, m, sizeof def.group_from_shape);
  assert_int_not_equal(vl_scene_add_shape(scene, &def).index, 0);
  if (vl_world_build(scene, NULL, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  vl_scene_destroy(scene);
  return world;
}

/* Shape space, by the formulas of pbrt's book; u, v in [0, 1]. */
static void formula(const Part *q, double u, double v, const double m[16], double r[3]) {
  double phi = u * (double)q->phi_max, p[3];
  if (q->kind == VL_SHAPE_SPHERE) {
    double low = acos(fmax(-1, (double)(q->z_min / q->radius))),
           high = acos(fmin(1, (double)(q->z_max / q->radius)));
    double theta = low + v * (high - low);
    p[0] = (double)q->radius * sin(theta) * cos(phi);
    p[1] = (double)q->radius * sin(theta) * sin(phi);
    p[2] = (double)q->radius * cos(theta);
  } else if (q->kind == VL_SHAPE_CYLINDER) {
    p[0] = (double)q->radius * cos(phi);
    p[1] = (double)q->radius * sin(phi);
    p[2] = (double)q->z_min + v * (double)(q->z_max - q->z_min);
  } else {
    double radius = (double)q->radius + v * (double)(q->inner - q->radius);
    p[0] = radius * cos(phi);
    p[1] = radius * sin(phi);
    p[2] = (double)q->height;
  }
  for (int i = 0; i < 3; i++)
    r[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}

/* Area of the cell [u0, u1] x [v0, v1] of the parameters. */
static double cell_area(const Part *q, const double m[16], double u0, double u1, double v0,
                        double v1) {
  const int n = 24;
  const double e = 1e-5;
  double sum = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double u = u0 + (i + 0.5) / n * (u1 - u0), v = v0 + (j + 0.5) / n * (v1 - v0), a[3], b[3],
             c[3], d[3];
      formula(q, u - e, v, m, a);
      formula(q, u + e, v, m, b);
      formula(q, u, v - e, m, c);
      formula(q, u, v + e, m, d);
      for (int k = 0; k < 3; k++) {
        a[k] = (b[k] - a[k]) / (2 * e);
        c[k] = (d[k] - c[k]) / (2 * e);
      }
      double x = a[1] * c[2] - a[2] * c[1], y = a[2] * c[0] - a[0] * c[2],
             z = a[0] * c[1] - a[1] * c[0];
      sum += sqrt(x * x + y * y + z * z);
    }
  return sum / (n * n) * (u1 - u0) * (v1 - v0);
}

enum { CELLS = 6, SAMPLES = 40000 };

/* A ray from either side, aslant, finds the same point. above: on the side of the normal. */
static void check_ray(const Part *q, const vlWorldShape *s, const vlSurfacePoint *at,
                      bool above) {
  double o[3], d[3], side = above ? 1 : -1;
  for (int c = 0; c < 3; c++) {
    o[c] = at->p[c] + side * 1e-2 * (at->n[c] + 0.3 * (c == 0));
    d[c] = at->p[c] - o[c];
  }
  vlShapeHit hit;
  vlSurfacePoint again;
  if (!vl_shape_intersect(s, 0, o, d, 0, 1.5, &hit))
    fail_msg("%s: a ray misses a sampled point", q->name);
  vl_shape_point(s, 0, &hit, &again);
  double same = 0, slope_u = 0, slope_v = 0;
  for (int c = 0; c < 3; c++) {
    same += again.n[c] * at->n[c];
    slope_u += again.dpdu[c] * again.n[c];
    slope_v += again.dpdv[c] * again.n[c];
  }
  if (!(fabs(hit.t - 1) < 1e-4 && same > 0.9999 && fabsf(again.uv[0] - at->uv[0]) < 1e-3f &&
        fabsf(again.uv[1] - at->uv[1]) < 1e-3f))
    fail_msg("%s: met at t %g, uv (%g, %g) for (%g, %g)", q->name, hit.t, again.uv[0],
             again.uv[1], at->uv[0], at->uv[1]);
  assert_true(fabs(slope_u) < 1e-4 && fabs(slope_v) < 1e-4);
}

/* The sample of two random numbers; returns its density per area. */
static double check_sample(const Part *q, const vlWorldShape *s, const double m[16], float u,
                           float v, vlSurfacePoint *at) {
  double pdf, p[3];
  vl_shape_sample(s, 0, u, v, at, &pdf);
  assert_true(pdf > 0);
  double found = vl_shape_pdf(s, 0, at);
  if (!(fabs(found - pdf) < 1e-4 * pdf))
    fail_msg("%s: density %g, found again %g", q->name, pdf, found);
  formula(q, (double)at->uv[0], (double)at->uv[1], m, p);
  for (int c = 0; c < 3; c++)
    if (!(fabs(p[c] - at->p[c]) < 2e-4))
      fail_msg("%s: uv (%g, %g) is elsewhere", q->name, at->uv[0], at->uv[1]);
  return pdf;
}

static void check_part(const Part *q, const double m[16]) {
  vlContext *context;
  vlWorld *world = build(q, m, &context);
  const vlWorldShape *s = &world->shapes.items[0];
  double area[CELLS][CELLS], total = 0, weight[CELLS][CELLS], sum = 0;
  memset(weight, 0, sizeof weight);
  for (int i = 0; i < CELLS; i++)
    for (int j = 0; j < CELLS; j++) {
      area[i][j] = cell_area(q, m, i / (double)CELLS, (i + 1) / (double)CELLS,
                             j / (double)CELLS, (j + 1) / (double)CELLS);
      total += area[i][j];
    }
  /* a lattice of two dimensions, by the golden ratio's sequence */
  for (int i = 0; i < SAMPLES; i++) {
    float u = (float)((i + 0.5) / SAMPLES), v = (float)fmod(i * 0.6180339887498949, 1.0);
    vlSurfacePoint at;
    double share = 1 / check_sample(q, s, m, u, v, &at) / SAMPLES;
    int x = (int)((double)at.uv[0] * CELLS), y = (int)((double)at.uv[1] * CELLS);
    weight[x < CELLS ? x : CELLS - 1][y < CELLS ? y : CELLS - 1] += share;
    sum += share;
    bool rim = v < 0.002f || v > 0.998f || u < 0.002f || u > 0.998f;
    if (i % 16 == 0 && !rim)
      check_ray(q, s, &at, i % 32);
  }
  if (!(fabs(sum - total) < 2e-3 * total))
    fail_msg("%s: area %g, expected %g", q->name, sum, total);
  double told = (double)vl_world_prim_area(s, 0);
  if (!(fabs(told - total) < 5e-3 * total))
    fail_msg("%s: area told %g, expected %g", q->name, told, total);
  for (int i = 0; i < CELLS; i++)
    for (int j = 0; j < CELLS; j++)
      if (!(fabs(weight[i][j] - area[i][j]) <
            0.03 * area[i][j] + 2e-3 * total / (CELLS * CELLS)))
        fail_msg("%s: cell (%d, %d) has %g, expected %g", q->name, i, j, weight[i][j],
                 area[i][j]);
  vl_world_destroy(world);
  vl_context_destroy(context);
}

static void samples_fit_the_area(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
    for (int t = 0; t < 3; t++)
      check_part(&parts[k], matrices[t]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(samples_fit_the_area)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
