/* conformance/surfaces.h: laws of the surfaces of stretched shapes, asked of the functions of
 * their kinds: the area by which points are sampled is that by which lines cross; a sampled
 * point is the one that a ray finds, with the same density; derivatives by u and v, of points
 * and of normals, are differences; and a displaced mesh lies where its heights are. */
#ifndef TEST_CONFORMANCE_SURFACES_H
#define TEST_CONFORMANCE_SURFACES_H

#include "conformance.h"
#include "parameter_cases.h"
#include "shape/surface_point.h"
#include "shapes.h"
#include "unit.h"
#include "world/world.h"

/* No similarity, and no axis keeps its direction. */
#define STRETCHED "Scale 1.2 .6 .9 Rotate 35 1 2 3 Scale 1 1.3 .8 "

enum { SURFACE_POINTS = 256, AREA_STEPS = 64, SURFACE_BATCHES = 192 };

typedef struct SurfaceLaws {
  const char *kind;
  const vlWorldShape *shape;
  uint32_t compared, other_density, other_point, by_u, by_v, bent_u, bent_v;
} SurfaceLaws;

/* ---- worlds of one shape ----------------------------------------------------------------- */

/* The shape, stretched; before: further statements. Both are to be destroyed. */
static vlWorld *world_of_shape(const char *kind, const char *parameters, const char *before,
                               vlScene **scene) {
  static char text[TEXT];
  char form[TEXT];
  vlError error = {0};
  vlWorld *world;
  snprintf(form, sizeof form,
           HEAD "WorldBegin LightSource \"infinite\" Material \"diffuse\" %s " STRETCHED
                "Shape %%s",
           before);
  scene_text(text, form, kind, parameters);
  *scene = need_scene(text);
  assert_int_equal(vl_world_build(*scene, NULL, &world, &error), VL_OK);
  assert_true(world->shapes.count > 0);
  return world;
}

/* ---- one surface ------------------------------------------------------------------------- */

/* Where a ray along -n from above p meets the surface. */
static bool point_below(const vlWorldShape *s, uint32_t prim, const double p[3],
                        const double n[3], vlSurfacePoint *found) {
  const double height = 0.05;
  vlShapeHit hit;
  double o[3];
  double d[3];
  for (int k = 0; k < 3; k++) {
    o[k] = p[k] + height * n[k];
    d[k] = -n[k];
  }
  if (!vl_shape_intersect(s, prim, o, d, 0, 2 * height, &hit))
    return false;
  vl_shape_point(s, prim, &hit, found);
  return true;
}

static double far_from(const double a[3], const double b[3]) {
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

/* Counts in *moves and *turns whether points and normals beside `at`, along u (axis 0) or v,
 * are elsewhere than its derivatives say. Where one of them is beyond the edge nothing is
 * counted. */
static void check_along(SurfaceLaws *l, uint32_t prim, const vlSurfacePoint *at, int axis,
                        uint32_t *moves, uint32_t *turns) {
  const double step = 5e-3;
  const double *dp = axis ? at->dpdv : at->dpdu;
  const double *dn = axis ? at->dndv : at->dndu;
  vlSurfacePoint side[2];
  for (int i = 0; i < 2; i++) {
    double p[3];
    for (int k = 0; k < 3; k++)
      p[k] = at->p[k] + (i ? step : -step) * dp[k];
    if (!point_below(l->shape, prim, p, at->n, &side[i]))
      return;
  }
  double by[2];
  double turned[3];
  for (int c = 0; c < 2; c++)
    by[c] = ((double)side[1].uv[c] - (double)side[0].uv[c]) / (2 * step);
  for (int k = 0; k < 3; k++)
    turned[k] = (side[1].ns[k] - side[0].ns[k]) / (2 * step);
  static const double still[3] = {0, 0, 0};
  l->compared++;
  *moves += !(fabs(by[axis] - 1) < 0.02 && fabs(by[!axis]) < 0.02);
  *turns += !(far_from(turned, dn) < 0.02 * (0.5 + far_from(dn, still)));
}

/* A point that was sampled, and the same as a ray finds it. Points near the edges, and where
 * the coordinates degenerate, are left out. */
static void check_sampled(SurfaceLaws *l, uint32_t prim, float u, float v) {
  static const double origin[3] = {0, 0, 0};
  vlSurfacePoint at;
  vlSurfacePoint found;
  double density;
  vl_shape_sample(l->shape, prim, u, v, &at, &density);
  double again = vl_shape_pdf(l->shape, prim, &at);
  l->other_density += !(density > 0 && fabs(again - density) < 1e-3 * density);
  bool inside = at.uv[0] > 0.03f && at.uv[0] < 0.97f && at.uv[1] > 0.03f && at.uv[1] < 0.97f;
  if (!inside || far_from(at.dpdu, origin) < 0.2 || far_from(at.dpdv, origin) < 0.2)
    return;
  if (!point_below(l->shape, prim, at.p, at.n, &found)) {
    l->other_point++;
    return;
  }
  l->other_point += far_from(at.p, found.p) > 1e-5 || far_from(at.n, found.n) > 1e-4 ||
                    fabsf(at.uv[0] - found.uv[0]) > 1e-4f ||
                    fabsf(at.uv[1] - found.uv[1]) > 1e-4f;
  check_along(l, prim, &at, 0, &l->by_u, &l->bent_u);
  check_along(l, prim, &at, 1, &l->by_v, &l->bent_v);
}

/* ---- its area ---------------------------------------------------------------------------- */

/* The mean of the reciprocal of the density over its points, all of whose numbers are as
 * likely.
 */
static double area_by_samples(const vlWorldShape *s) {
  double sum = 0;
  for (uint32_t prim = 0; prim < s->faces; prim++)
    for (int i = 0; i < AREA_STEPS * AREA_STEPS; i++) {
      vlSurfacePoint point;
      double density;
      vl_shape_sample(s, prim, (float)((i % AREA_STEPS + 0.5) / AREA_STEPS),
                      (float)((i / AREA_STEPS + 0.5) / AREA_STEPS), &point, &density);
      sum += 1 / density;
    }
  return sum / (AREA_STEPS * AREA_STEPS);
}

/* Lines through a ball of radius `reach`: the mean number of crossings (shapes.h). */
static uint32_t crossings_of_line(const vlWorldShape *s, const double o[3], const double d[3]) {
  uint32_t count = 0;
  for (uint32_t prim = 0; prim < s->faces; prim++) {
    double from = 0;
    vlShapeHit hit;
    while (vl_shape_intersect(s, prim, o, d, from, 100, &hit)) {
      from = hit.t + 1e-6;
      count++;
    }
  }
  return count;
}

static Mean area_by_crossings(const vlWorldShape *s, double reach) {
  Mean area = {0};
  for (uint32_t batch = 0; batch < SURFACE_BATCHES; batch++) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
      double d[3];
      double o[3];
      even_line(i, batch, reach, o, d);
      found += crossings_of_line(s, o, d);
    }
    mean_add(&area, 2 * PI * reach * reach * found / VL_OWN_BATCH);
  }
  return area;
}

/* ---- its bounds -------------------------------------------------------------------------- */

/* What rays meet of a face lies within its bounds, by which trees find it. */
static void check_bounds(const char *kind, const char *parameters) {
  enum { BOUND_BATCHES = 16 };
  vlScene *scene;
  vlWorld *world = world_of_shape(kind, parameters, "Scale 3 3 3", &scene);
  const vlWorldShape *s = &world->shapes.items[0];
  uint32_t hits = 0;
  uint32_t outside = 0;
  for (uint32_t i = 0; i < BOUND_BATCHES * VL_OWN_BATCH; i++) {
    double d[3];
    double o[3];
    even_line(i % VL_OWN_BATCH, i / VL_OWN_BATCH, 4, o, d);
    for (uint32_t prim = 0; prim < s->faces; prim++) {
      vlShapeHit hit;
      float low[3];
      float high[3];
      bool out = false;
      if (!vl_shape_intersect(s, prim, o, d, 0, 100, &hit))
        continue;
      vl_world_prim_bounds(s, prim, low, high);
      for (int k = 0; k < 3; k++) {
        const double p = o[k] + hit.t * d[k];
        out = out || p < (double)low[k] - 1e-5 || p > (double)high[k] + 1e-5;
      }
      hits++;
      outside += out;
    }
  }
  if (hits < 100 || outside)
    broken("shapes", kind, "%s: stretched: %u of %u hits lie outside of its bounds", parameters,
           outside, hits);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

/* ---- all --------------------------------------------------------------------------------- */

static void judge_surface(const SurfaceLaws *l, const char *parameters, double reach) {
  const char *kind = l->kind;
  double area = area_by_samples(l->shape);
  Mean crossed = area_by_crossings(l->shape, reach);
  char what[400];
  snprintf(what, sizeof what, "%s: stretched: area by crossings, and by samples", parameters);
  check_mean("shapes", kind, what, &crossed, area, (Sight){0.004 * area, 0.07 * area});
  if (l->compared < SURFACE_POINTS / 4)
    broken("shapes", kind, "%s: stretched: %u points compared", parameters, l->compared);
  if (l->other_density)
    broken("shapes", kind, "%s: stretched: %u samples have another density", parameters,
           l->other_density);
  if (l->other_point)
    broken("shapes", kind, "%s: stretched: rays find %u samples elsewhere", parameters,
           l->other_point);
  if (l->by_u || l->by_v)
    broken("shapes", kind, "%s: stretched: derivatives of %u points by u, of %u by v",
           parameters, l->by_u, l->by_v);
  if (l->bent_u || l->bent_v)
    broken("shapes", kind, "%s: stretched: derivatives of %u normals by u, of %u by v",
           parameters, l->bent_u, l->bent_v);
}

static void check_surface(const vlKindRow *row, const ShapeVariant *v, const char *before) {
  vlScene *scene;
  vlWorld *world = world_of_shape(row->name, v->parameters, before, &scene);
  SurfaceLaws laws = {.kind = row->name, .shape = &world->shapes.items[0]};
  if (!laws.shape->triangles)
    check_bounds(row->name, v->parameters);
  if (!laws.shape->triangles && row->traits & VL_SHAPE_TRAIT_EMITS) {
    for (uint32_t i = 0; i < SURFACE_POINTS; i++)
      check_sampled(&laws, i % laws.shape->faces,
                    (float)fmod(0.5 + i * 0.7548776662466927, 1.0),
                    (float)fmod(0.5 + i * 0.5698402909980532, 1.0));
    judge_surface(&laws, v->parameters, 1.6 * (v->reach > 0 ? v->reach : 1.12));
  }
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

/* A displaced mesh lies where its heights are, a linear function of u and v. */
static void ask_displaced(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  ShapeLaws *s = probe->user;
  uint32_t wrong = 0;
  set_rays_down(s->rays);
  vl_world_trace(trace, s->rays, s->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double u = 0.5 * ((double)s->rays->origin[0][i] + 1);
    double v = 0.5 * ((double)s->rays->origin[1][i] + 1);
    wrong += !(fabs((double)s->hits->uv[0][i] - u) < 1e-4 &&
               fabs((double)s->hits->uv[1][i] - v) < 1e-4 &&
               fabs((double)s->hits->t[i] - (1 - 0.2 * u - 0.1 * v)) < 1e-4);
  }
  if (wrong)
    broken("shapes", s->kind, "displaced: %u of %u points are elsewhere", wrong, VL_OWN_BATCH);
}

/* Edges are cut until none is longer than asked for, as the world measures it; a half of that
 * is never too long. */
static void edges_of_displaced_mesh(const char *file) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin LightSource \"infinite\" Texture \"h\" \"float\" \"constant\" "
           "\"float value\" .1 Scale 3 .5 2 Shape \"plymesh\" \"string filename\" \"%s\" "
           "\"texture displacement\" \"h\" \"float edgelength\" .3",
           file);
  vlError error = {0};
  vlWorld *world;
  vlScene *scene = need_scene(text);
  assert_int_equal(vl_world_build(scene, &vl_scene_defs(scene)->build, &world, &error), VL_OK);
  const vlWorldShape *s = &world->shapes.items[0];
  double longest = 0;
  for (uint32_t i = 0; i < 3 * s->faces; i++) {
    const float *a = s->positions + 3 * (size_t)s->indices[i];
    const float *b = s->positions + 3 * (size_t)s->indices[i / 3 * 3 + (i + 1) % 3];
    longest = fmax(longest, hypot(hypot((double)(a[0] - b[0]), (double)(a[1] - b[1])),
                                  (double)(a[2] - b[2])));
  }
  if (!(longest > 0.14 && longest < 0.3001))
    broken("shapes", "trianglemesh", "displaced: the longest edge of %s is %.3f, not up to .3",
           file, longest);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

static void displaced_mesh(const char *file) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin LightSource \"infinite\" Texture \"h\" \"float\" \"bilerp\" "
           "\"float v00\" 0 \"float v10\" .2 \"float v01\" .1 \"float v11\" .3 "
           "Material \"diffuse\" Shape \"plymesh\" \"string filename\" \"%s\" "
           "\"texture displacement\" \"h\" \"float edgelength\" .3",
           file);
  ShapeLaws s = {.kind = "trianglemesh", .rays = new_rays()};
  Probe probe = {.ask = ask_displaced, .user = &s};
  s.hits = calloc(1, sizeof *s.hits);
  probe_world(text, &probe, 1);
  free(s.rays);
  free(s.hits);
}

/* Texture coordinates that are equal at all corners, or along a line, give no directions: they
 * change nothing in a patch of brushed metal; all such coordinates of triangles are alike. */
static void degenerate_coordinates(void) {
  static const struct {
    const char *kind, *parameters, *as;
  } shapes[] = {
      {"bilinearmesh", "", ""},
      {"trianglemesh", "\"integer indices\" [0 1 2 2 1 3]", "\"point2 uv\" [0 0 0 0 0 0 0 0]"}};
  static const char *const coordinates[] = {"\"point2 uv\" [.3 .6 .3 .6 .3 .6 .3 .6]",
                                            "\"point2 uv\" [0 0 .25 .5 .5 1 1 2]"};
  static char text[TEXT];
  for (int i = 0; i < 4; i++) {
    float pixels[2][PIXELS];
    vlError error = {0};
    for (int k = 0; k < 2; k++) {
      snprintf(text, sizeof text,
               HEAD "WorldBegin " LIGHTS
                    "Material \"conductor\" \"float uroughness\" .1 \"float vroughness\" .6 "
                    "Shape \"%s\" \"point3 P\" [-1 -1 0 1 -1 .5 -1 1 0 1 1 -.3] %s %s\n",
               shapes[i / 2].kind, shapes[i / 2].parameters,
               k ? coordinates[i % 2] : shapes[i / 2].as);
      assert_true(render_text(text, pixels[k], &error));
    }
    if (memcmp(pixels[0], pixels[1], sizeof pixels[0]) != 0)
      broken("shapes", shapes[i / 2].kind, "brushed metal with %s is another one",
             coordinates[i % 2]);
  }
}

static void laws_of_surfaces(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const ShapeCase *c = shape_cases[k];
    for (int i = 0; i < SHAPE_VARIANTS && c->variants[i].parameters; i++)
      check_surface(family->rows[k], &c->variants[i], i % 2 ? "ReverseOrientation" : "");
  }
  static const char *const files[] = {"a.ply", "quad.ply"};
  for (int i = 0; i < 2; i++) {
    displaced_mesh(files[i]);
    edges_of_displaced_mesh(files[i]);
  }
  degenerate_coordinates();
  expect_no_failures();
}

#endif
