/* conformance/bumps.h: the law of bumps: the shading normal is that of the points that the
 * heights move along the normal, on each kind of shape, for heights of its coordinates and of
 * space. */
#ifndef TEST_CONFORMANCE_BUMPS_H
#define TEST_CONFORMANCE_BUMPS_H

#include "conformance.h"
#include "math/double3.h"
#include "shapes.h"
#include "unit.h"

/* The height at (s, t): bilinear, with these values at the corners of the unit square. */
static double bump_height(double s, double t) {
  return 0.1 + 0.3 * s + 0.4 * t;
}
#define BUMP_HEIGHTS                                                      \
  "Texture \"h\" \"float\" \"bilerp\" \"float v00\" .1 \"float v01\" .5 " \
  "\"float v10\" .4 \"float v11\" .8 "

typedef struct Bumps {
  bool solid; /* s and t are x and y of space */
  uint32_t compared, wrong;
  vlTraceRays *rays;
  vlTraceHits *hits;
} Bumps;

/* Ray i's point, moved along the normal of the outside. */
static void moved_point(const Bumps *b, uint32_t i, double moved[3]) {
  const vlTraceHits *h = b->hits;
  double outside = 0;
  for (int k = 0; k < 3; k++)
    outside += (double)h->normal[k][i] * (double)h->shading[k][i];
  const double height = b->solid
                            ? bump_height((double)h->position[0][i], (double)h->position[1][i])
                            : bump_height((double)h->uv[0][i], (double)h->uv[1][i]);
  for (int k = 0; k < 3; k++)
    moved[k] =
        (double)h->position[k][i] + (outside < 0 ? -height : height) * (double)h->normal[k][i];
}

/* Three rays close to each other. */
static void compare_bumps(Bumps *b, uint32_t i, double step) {
  double p[3][3];
  double along[3], up[3], n[3], shading[3];
  double far = 0;
  for (uint32_t j = 0; j < 3; j++) {
    if (!isfinite(b->hits->t[i + j]))
      return;
    moved_point(b, i + j, p[j]);
    for (int c = 0; c < 2; c++) /* a seam lies between them, or coordinates degenerate */
      far = fmax(far, fabs((double)b->hits->uv[c][i + j] - (double)b->hits->uv[c][i]));
    for (int k = 0; k < 3; k++)
      far = fmax(far, fabs(p[j][k] - p[0][k]));
  }
  if (far > 4 * step)
    return;
  for (int k = 0; k < 3; k++) {
    along[k] = p[1][k] - p[0][k];
    up[k] = p[2][k] - p[0][k];
    shading[k] = (double)b->hits->shading[k][i];
  }
  vl_cross3(along, up, n);
  const double same = vl_dot3(n, shading) / vl_norm3(n);
  b->compared++;
  b->wrong += !(fabs(same) > 0.9995);
}

static void ask_bumps(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  const double step = 1e-3;
  Bumps *b = probe->user;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const uint32_t j = i % 3;
    double d[3];
    double x[3];
    double y[3];
    double at[2];
    double origin[3];
    even_direction(i - j, VL_OWN_BATCH, 0.3 + 0.7548776662 * probe->batch, d);
    across(d, x, y);
    even_disk(i - j, 0.2 + 0.618034 * probe->batch, at);
    for (int k = 0; k < 3; k++)
      origin[k] =
          (at[0] + (j == 1) * step) * x[k] + (at[1] + (j == 2) * step) * y[k] - 2 * d[k];
    set_ray(b->rays, i, origin, d);
  }
  vl_world_trace(trace, b->rays, b->hits);
  for (uint32_t i = 0; i + 2 < VL_OWN_BATCH; i += 3)
    compare_bumps(b, i, step);
}

/* ---- vertex normals ---------------------------------------------------------------------- */

/* A triangle whose texture coordinates are its barycentric ones. Its normals differ so much
 * that their means are far from unit length. */
static const double normal_corners[3][3] = {{0.1, -0.2, 0}, {1, 0.1, 0.25}, {-0.3, 0.9, -0.2}};
static const double corner_normals[3][3] = {
    {-0.48, -0.36, 0.8}, {0.8, -0.36, 0.48}, {-0.36, 0.8, 0.48}};
#define NORMAL_TRIANGLE                                                              \
  "Shape \"trianglemesh\" \"point3 P\" [.1 -.2 0 1 .1 .25 -.3 .9 -.2] "              \
  "\"normal N\" [-.48 -.36 .8 .8 -.36 .48 -.36 .8 .48] \"point2 uv\" [0 0 1 0 0 1] " \
  "\"integer indices\" [0 1 2]"

static void normal_between(double u, double v, double n[3]) {
  for (int k = 0; k < 3; k++)
    n[k] = (1 - u - v) * corner_normals[0][k] + u * corner_normals[1][k] +
           v * corner_normals[2][k];
  vl_normalize3(n);
}

/* Turns a tangent of the triangle about the axis that turns its normal to n (Rodrigues). */
static void turn_to_normal(const double n[3], double tangent[3]) {
  double edges[2][3];
  double g[3];
  double axis[3];
  double across_axis[3];
  for (int k = 0; k < 2; k++)
    vl_sub3(normal_corners[1 + k], normal_corners[0], edges[k]);
  vl_cross3(edges[0], edges[1], g);
  vl_normalize3(g);
  vl_cross3(g, n, axis);
  const double cosine = vl_dot3(g, n);
  const double sine = vl_norm3(axis);
  for (int k = 0; k < 3; k++)
    axis[k] /= sine;
  vl_cross3(axis, tangent, across_axis);
  const double along = vl_dot3(axis, tangent);
  for (int k = 0; k < 3; k++)
    tangent[k] = cosine * tangent[k] + sine * across_axis[k] + (1 - cosine) * along * axis[k];
}

/* The derivative of p + h n along u or v. p is on the smooth surface whose normal is n. */
static void bumped_slope(double u, double v, bool along_v, double slope[3]) {
  const double step = 1e-5;
  double n[3];
  double there[3];
  double edge[3];
  normal_between(u, v, n);
  normal_between(u + !along_v * step, v + along_v * step, there);
  vl_sub3(normal_corners[1 + along_v], normal_corners[0], edge);
  turn_to_normal(n, edge);
  const double height = bump_height(u, v);
  const double height_there = bump_height(u + !along_v * step, v + along_v * step);
  for (int k = 0; k < 3; k++)
    slope[k] = edge[k] + (height_there * there[k] - height * n[k]) / step;
}

static void ask_bumped_triangle(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  Bumps *b = probe->user;
  set_rays_down(b->rays);
  vl_world_trace(trace, b->rays, b->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double x[3];
    double y[3];
    double n[3];
    double shading[3];
    if (!isfinite(b->hits->t[i]))
      continue;
    bumped_slope((double)b->hits->uv[0][i], (double)b->hits->uv[1][i], false, x);
    bumped_slope((double)b->hits->uv[0][i], (double)b->hits->uv[1][i], true, y);
    vl_cross3(x, y, n);
    for (int k = 0; k < 3; k++)
      shading[k] = (double)b->hits->shading[k][i];
    b->compared++;
    b->wrong += !(vl_dot3(n, shading) > 0.9999 * vl_norm3(n));
  }
}

static void check_bumped_triangle(void) {
  Bumps b = {.rays = new_rays(), .hits = calloc(1, sizeof *b.hits)};
  assert_non_null(b.hits);
  Probe probe = {.ask = ask_bumped_triangle, .user = &b};
  probe_world(HEAD "WorldBegin LightSource \"infinite\" " BUMP_HEIGHTS
                   "Material \"diffuse\" \"texture displacement\" \"h\" " NORMAL_TRIANGLE,
              &probe, 1);
  if (b.compared < 50 || b.wrong > 0)
    broken("shapes", "trianglemesh",
           "bumps between vertex normals: %u of %u are not those of moved points", b.wrong,
           b.compared);
  free(b.rays);
  free(b.hits);
}

/* ---- each kind --------------------------------------------------------------------------- */

static void check_bumps(const vlKindRow *row, const ShapeVariant *v, bool solid) {
  static char text[TEXT];
  char form[600];
  Bumps b = {.solid = solid, .rays = new_rays(), .hits = calloc(1, sizeof *b.hits)};
  assert_non_null(b.hits);
  snprintf(form, sizeof form,
           HEAD "WorldBegin LightSource \"infinite\" " BUMP_HEIGHTS
                "%s Material \"diffuse\" \"texture displacement\" \"h\" Shape %%s",
           solid ? "\"string mapping\" \"planar\" \"vector3 v1\" [1 0 0] \"vector3 v2\" [0 1 0]"
                 : "");
  scene_text(text, form, row->name, v->parameters);
  Probe probe = {.ask = ask_bumps, .user = &b};
  probe_world(text, &probe, NORMAL_BATCHES);
  if (b.compared < 50 || b.wrong > b.compared / 50)
    broken("shapes", row->name, "%s: bumps %s: %u of %u normals are not those of moved points",
           v->parameters, solid ? "of space" : "of coordinates", b.wrong, b.compared);
  free(b.rays);
  free(b.hits);
}

static void laws_of_bumps(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int solid = 0; solid < 2 && !shape_cases[k]->variants[0].faces_rays; solid++)
      check_bumps(family->rows[k], &shape_cases[k]->variants[0], solid);
  check_bumped_triangle();
  expect_no_failures();
}

#endif
