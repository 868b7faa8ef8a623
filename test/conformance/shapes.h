/* conformance/shapes.h: the laws of shapes: random lines cross a surface as often as its area
 * says (Cauchy and Crofton: the mean number of crossings of a line through a sphere of radius R
 * is area / (2 pi R^2)); nothing lies before the nearest hit; normals are those of the points
 * that rays find; known hits; the laws of light for shapes that emit. */
#ifndef TEST_CONFORMANCE_SHAPES_H
#define TEST_CONFORMANCE_SHAPES_H

#include "conformance.h"
#include "lights.h"
#include "math/double3.h"
#include "parameter_cases.h"
#include "unit.h"

/* ---- asking ------------------------------------------------------------------------------ */

enum { MAX_CROSSINGS = 8, LINE_BATCHES = 192, NORMAL_BATCHES = 24, NEAREST_BATCHES = 8 };

typedef struct ShapeLaws {
  const char *kind;
  const ShapeVariant *variant;
  double reach; /* of the ball through which the lines go */
  vlTraceRays *rays;
  vlTraceHits *hits;
  Mean crossings;
  uint32_t compared, leaning, backwards, before;
} ShapeLaws;

/* A point of the unit disk, evenly for each batch. */
static void even_disk(uint32_t i, double turn, double at[2]) {
  double r = sqrt(fmod(0.5 + i * 0.7548776662466927 + turn, 1.0));
  double phi = 2 * PI * fmod(i * 0.5698402909980532 + 0.37 * turn, 1.0);
  at[0] = r * cos(phi);
  at[1] = r * sin(phi);
}

/* The frame of a direction: two vectors across it. */
static void across(const double d[3], double a[3], double b[3]) {
  const double helper[3] = {fabs(d[0]) < 0.5, fabs(d[0]) >= 0.5, 0};
  double length = 0;
  for (int k = 0; k < 3; k++)
    a[k] = d[(k + 1) % 3] * helper[(k + 2) % 3] - d[(k + 2) % 3] * helper[(k + 1) % 3];
  for (int k = 0; k < 3; k++)
    length += a[k] * a[k];
  for (int k = 0; k < 3; k++)
    a[k] /= sqrt(length);
  for (int k = 0; k < 3; k++)
    b[k] = d[(k + 1) % 3] * a[(k + 2) % 3] - d[(k + 2) % 3] * a[(k + 1) % 3];
}

/* One of the lines that cross a ball around the origin evenly, from outside of it. */
static void even_line(uint32_t i, uint32_t batch, double reach, double origin[3], double d[3]) {
  double a[3];
  double b[3];
  double at[2];
  even_direction(i, VL_OWN_BATCH, 0.7548776662 * batch, d);
  across(d, a, b);
  even_disk(i, 0.618034 * batch, at);
  for (int k = 0; k < 3; k++)
    origin[k] = reach * (at[0] * a[k] + at[1] * b[k] - 2 * d[k]);
}

/* Nothing is hit before the nearest hit: the rays end just before their hits. */
static void look_before_hits(ShapeLaws *s, vlTrace *trace) {
  static float end[VL_OWN_BATCH];
  memcpy(end, s->hits->t, sizeof end);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    s->rays->t_max[i] = end[i] - 1e-4f;
  vl_world_trace(trace, s->rays, s->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    s->before += isfinite(end[i]) && isfinite(s->hits->t[i]);
    s->rays->t_max[i] = INFINITY;
  }
}

static void count_crossings(ShapeLaws *s, vlTrace *trace, uint32_t batch) {
  double found[VL_OWN_BATCH] = {0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double d[3];
    double origin[3];
    even_line(i, batch, s->reach, origin, d);
    set_ray(s->rays, i, origin, d);
  }
  bool more = true;
  for (int k = 0; k < MAX_CROSSINGS && more; k++) {
    vl_world_trace(trace, s->rays, s->hits);
    more = false;
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
      bool hit = isfinite(s->hits->t[i]);
      double facing = 0;
      for (int c = 0; c < 3; c++)
        facing += (double)s->hits->normal[c][i] * (double)s->rays->direction[c][i];
      found[i] += hit;
      more |= hit;
      s->backwards += hit && facing > 0;
      s->rays->t_min[i] = hit ? s->hits->t[i] + 1e-4f : 9;
    }
  }
  double sum = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    sum += found[i];
  mean_add(&s->crossings, sum / VL_OWN_BATCH); /* its lines are even, not independent */
}

/* Three rays close to each other: the normal is that of their points. */
static void compare_normals(ShapeLaws *s, vlTrace *trace, uint32_t batch) {
  const double step = 2e-3;
  for (uint32_t i = 0; i < VL_OWN_BATCH - 2; i += 3) {
    double d[3];
    double a[3];
    double b[3];
    double at[2];
    even_direction(i, VL_OWN_BATCH, 0.3 + 0.7548776662 * batch, d);
    across(d, a, b);
    even_disk(i, 0.2 + 0.618034 * batch, at);
    for (uint32_t j = 0; j < 3; j++) {
      double origin[3];
      for (int k = 0; k < 3; k++)
        origin[k] = (s->reach * at[0] + (j == 1) * step) * a[k] +
                    (s->reach * at[1] + (j == 2) * step) * b[k] - 2 * d[k];
      set_ray(s->rays, i + j, origin, d);
    }
  }
  for (uint32_t i = VL_OWN_BATCH - 1; i < VL_OWN_BATCH; i++)
    s->rays->t_max[i] = -1;
  vl_world_trace(trace, s->rays, s->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH - 2; i += 3) {
    double e[2][3];
    double n[3];
    double far = 0;
    double length = 0;
    double same = 0;
    if (!isfinite(s->hits->t[i] + s->hits->t[i + 1] + s->hits->t[i + 2]))
      continue;
    for (uint32_t j = 0; j < 2; j++)
      for (int k = 0; k < 3; k++) {
        e[j][k] = (double)s->hits->position[k][i + 1 + j] - (double)s->hits->position[k][i];
        far = fmax(far, fabs(e[j][k]));
      }
    for (int k = 0; k < 3; k++)
      n[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
    for (int k = 0; k < 3; k++)
      length += n[k] * n[k];
    for (int k = 0; k < 3; k++)
      same += n[k] * (double)s->hits->normal[k][i] / sqrt(length);
    if (far > 4 * step)
      continue; /* an edge lies between them, or the view is slant */
    s->compared++;
    s->leaning += !(fabs(same) > 0.995);
  }
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    s->rays->t_max[i] = INFINITY;
}

static uint32_t known_hits(const ShapeVariant *v) {
  uint32_t n = 0;
  while (n < sizeof v->known / sizeof *v->known && vl_norm3(v->known[n].direction) > 0)
    n++;
  return n;
}

static void compare_known(ShapeLaws *s, vlTrace *trace) {
  const uint32_t known = known_hits(s->variant);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const ShapeKnown *k = &s->variant->known[i % (known ? known : 1)];
    const double down[3] = {0, 0, -1};
    set_ray(s->rays, i, k->origin, known ? k->direction : down);
  }
  vl_world_trace(trace, s->rays, s->hits);
  for (uint32_t i = 0; i < known; i++) {
    const ShapeKnown *k = &s->variant->known[i];
    double t = (double)s->hits->t[i];
    double u = (double)s->hits->uv[0][i];
    double v = (double)s->hits->uv[1][i];
    bool same_t = isinf(k->t) ? isinf(t) : fabs(t - k->t) < 1e-4;
    if (!same_t || fabs(u - k->u) > 1e-3 || fabs(v - k->v) > 1e-3)
      broken("shapes", s->kind,
             "%s: ray %u hits at %.5f, uv %.4f %.4f; known are %.5f, %.4f %.4f",
             s->variant->parameters, i, t, u, v, k->t, k->u, k->v);
    double cosine = 0;
    for (int c = 0; c < 3; c++)
      cosine -= (double)s->hits->normal[c][i] * (double)s->rays->direction[c][i];
    if (k->cosine > 0 && !(fabs(cosine - k->cosine) < 1e-3))
      broken("shapes", s->kind, "%s: ray %u: the normal's cosine is %.4f; known is %.4f",
             s->variant->parameters, i, cosine, k->cosine);
  }
}

static void ask_shape(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  ShapeLaws *s = probe->user;
  count_crossings(s, trace, probe->batch);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    s->rays->t_min[i] = 0;
  if (probe->batch < NEAREST_BATCHES) {
    vl_world_trace(trace, s->rays, s->hits);
    look_before_hits(s, trace);
  }
  if (!s->variant->faces_rays && probe->batch < NORMAL_BATCHES)
    compare_normals(s, trace, probe->batch);
  if (probe->batch == 0)
    compare_known(s, trace);
}

static void check_shape(const vlKindRow *row, const char *directive, const ShapeVariant *v) {
  static char text[TEXT];
  char what[400];
  ShapeLaws s = {.kind = row->name, .variant = v, .rays = new_rays()};
  s.hits = calloc(1, sizeof *s.hits);
  s.reach = v->reach > 0 ? v->reach : 1.12;
  Probe probe = {.ask = ask_shape, .user = &s};
  scene_text(text, HEAD "WorldBegin LightSource \"infinite\" Material \"diffuse\" Shape %s",
             directive, v->parameters);
  probe_world(text, &probe, LINE_BATCHES);
  double lines = 2 * PI * s.reach * s.reach;
  Mean area = s.crossings;
  area.sum *= lines;
  area.squares *= lines * lines;
  snprintf(what, sizeof what,
           "%s: area by crossings of lines through a ball of radius %g (`reach`)",
           v->parameters, s.reach);
  check_mean("shapes", row->name, what, &area, v->area,
             (Sight){0.002 * v->area, 0.05 * v->area});
  if (s.before > 0)
    broken("shapes", row->name, "%s: %u rays have a hit before their nearest one",
           v->parameters, s.before);
  if (s.backwards > 0)
    broken("shapes", row->name, "%s: %u normals look away from the ray", v->parameters,
           s.backwards);
  if (!v->faces_rays && s.compared < 200)
    broken("shapes", row->name, "%s: %u normals", v->parameters, s.compared);
  if (s.leaning > s.compared / 50)
    broken("shapes", row->name, "%s: %u of %u normals lean", v->parameters, s.leaning,
           s.compared);
  if (row->traits & VL_SHAPE_TRAIT_EMITS)
    check_emitting_shape("shapes", row->name, directive, v->parameters, emissions[1]);
  free(s.rays);
  free(s.hits);
}

/* The shading normals that rays near the middle find, or 0. */
typedef struct Sides {
  float shading[3][VL_OWN_BATCH];
  vlTraceRays *rays;
  vlTraceHits *hits;
} Sides;

static void ask_sides(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Sides *s = probe->user;
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double d[3];
    double at[2];
    even_direction(i, VL_OWN_BATCH, 0.2, d);
    even_disk(i, 0.2, at);
    const double origin[3] = {0.05 + 0.1 * at[0] - 2 * d[0], 0.02 + 0.1 * at[1] - 2 * d[1],
                              0.03 - 2 * d[2]};
    set_ray(s->rays, i, origin, d);
  }
  vl_world_trace(trace, s->rays, s->hits);
  memcpy(s->shading, s->hits->shading, sizeof s->shading);
}

/* form: a scene with %s for the shape. */
static Sides *sides_of_scene(const char *form, const char *directive, const char *parameters) {
  static char text[TEXT];
  Sides *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->rays = new_rays();
  s->hits = calloc(1, sizeof *s->hits);
  scene_text(text, form, directive, parameters);
  Probe probe = {.ask = ask_sides, .user = s};
  probe_world(text, &probe, 1);
  return s;
}

static Sides *sides_of(const char *before, const char *directive, const char *parameters) {
  char form[400];
  snprintf(form, sizeof form,
           HEAD "WorldBegin LightSource \"infinite\" Material \"diffuse\" %s Shape %%s",
           before);
  return sides_of_scene(form, directive, parameters);
}

static void free_sides(Sides *s) {
  free(s->rays);
  free(s->hits);
  free(s);
}

/* A surface that is turned inside out has its outside on the other side: its normals are the
 * opposite ones. */
static void check_sides(const vlKindRow *row, const ShapeVariant *v) {
  Sides *s = sides_of("", row->name, v->parameters);
  Sides *reversed = sides_of("ReverseOrientation", row->name, v->parameters);
  uint32_t hit = 0;
  uint32_t wrong = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double left = 0;
    if (!isfinite(s->hits->t[i]))
      continue;
    for (int k = 0; k < 3; k++)
      left = fmax(left, fabs((double)s->shading[k][i] + (double)reversed->shading[k][i]));
    hit++;
    wrong += left > 1e-3;
  }
  if (hit < 10 || wrong)
    broken("shapes", row->name, "%s, inside out: %u of %u normals are not the opposite",
           v->parameters, wrong, hit);
  free_sides(s);
  free_sides(reversed);
}

/* Inside out it sends its light to the other side: to a floor below it, and into itself. */
static void check_emission_inside_out(const vlKindRow *row, const ShapeVariant *v) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           HEAD "WorldBegin " FLOOR
                "ReverseOrientation AreaLightSource \"diffuse\" "
                "\"rgb L\" [1 1 1] Translate .3 1.1 .2 Rotate 70 1 .2 .1 Shape \"%s\" %s",
           row->name, v->parameters);
  check_samples_of_light("shapes", row->name, "inside out", text);
}

static void laws_of_shapes(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const ShapeCase *c = shape_cases[k];
    assert_non_null(c->variants[0].parameters);
    for (int i = 0; i < SHAPE_VARIANTS && c->variants[i].parameters; i++)
      check_shape(family->rows[k], family->rows[k]->name, &c->variants[i]);
    check_sides(family->rows[k], &c->variants[0]);
    if (family->rows[k]->traits & VL_SHAPE_TRAIT_EMITS)
      check_emission_inside_out(family->rows[k], &c->variants[0]);
  }
  expect_no_failures();
}

#endif
