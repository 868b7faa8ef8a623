/* conformance/shapes.h: the laws of shapes: random lines cross a surface as often as its area
 * says (Cauchy and Crofton: the mean number of crossings of a line through a sphere of radius R
 * is area / (2 pi R^2)); normals are those of the points that rays find; known hits; the laws
 * of light for shapes that emit. */
#ifndef TEST_CONFORMANCE_SHAPES_H
#define TEST_CONFORMANCE_SHAPES_H

#include "conformance.h"
#include "lights.h"
#include "velo/shape.h"

typedef struct ShapeKnown {
  double origin[3], direction[3]; /* a ray */
  double t;                       /* infinity: it hits nothing */
  double u, v;                    /* texture coordinates there; NaN: not known */
} ShapeKnown;

typedef struct ShapeVariant {
  const char *parameters; /* null ends the list */
  double area;
  double reach;    /* the shape is in the ball of this radius around the origin; 0: 1.12 */
  bool faces_rays; /* the surface turns to each ray: no normals of its own */
  ShapeKnown known[3];
  uint32_t known_count;
} ShapeVariant;

enum { SHAPE_VARIANTS = 3 };
typedef struct ShapeCase {
  ShapeVariant variants[SHAPE_VARIANTS];
} ShapeCase;

static const ShapeCase triangles_shape = {{
    {.parameters = "\"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1] \"integer "
                   "indices\" [0 1 2]",
     .area = 0.5,
     .reach = 1.01,
     .known = {{{.2, .3, 1}, {0, 0, -1}, 1, .2, .3},
               {{.6, .6, 1}, {0, 0, -1}, INFINITY, NAN, NAN}},
     .known_count = 2},
    {.parameters = "\"point3 P\" [-.5 -.5 0 .5 -.5 0 .5 .5 .4 -.5 .5 .4] \"integer indices\" "
                   "[0 1 2 0 2 3]",
     .area = 1.0770330,
     .known = {{{.1, 0, 1}, {0, 0, -1}, .8, NAN, NAN}},
     .known_count = 1},
}};
static const ShapeCase bilinear_shape = {{
    {.parameters = "\"point3 P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0]",
     .area = 1,
     .known = {{{-.3, .1, 1}, {0, 0, -1}, 1, .2, .6},
               {{.6, .6, 1}, {0, 0, -1}, INFINITY, NAN, NAN}},
     .known_count = 2},
    /* z = x y over the square: the area is the integral of sqrt(1 + x^2 + y^2) */
    {.parameters = "\"point3 P\" [-.5 -.5 .25 .5 -.5 -.25 -.5 .5 -.25 .5 .5 .25]",
     .area = 1.0790366,
     .known = {{{.25, .5, 1}, {0, 0, -1}, .875, .75, 1}},
     .known_count = 1},
}};
static const ShapeCase sphere_shape = {{
    {.parameters = "\"float radius\" .8",
     .area = 4 * PI * .64,
     .reach = 0.81,
     .known = {{{0, 2, .4}, {0, -1, 0}, 2 - 0.69282032, .25, 1 - 1.0 / 3}},
     .known_count = 1},
    {.parameters =
         "\"float radius\" .8 \"float zmin\" -.4 \"float zmax\" .4 \"float phimax\" 180",
     .area = PI * .8 * .8,
     .reach = 0.81,
     .known = {{{0, 2, 0}, {0, -1, 0}, 1.2, .5, .5},
               {{0, 0, 2}, {0, 0, -1}, INFINITY, NAN, NAN}},
     .known_count = 2},
}};
static const ShapeCase disk_shape = {{
    {.parameters = "\"float radius\" .8 \"float innerradius\" .4 \"float height\" .1",
     .area = PI * (.64 - .16),
     .reach = 0.82,
     .known = {{{0, .6, 1}, {0, 0, -1}, .9, .25, .5},
               {{.1, .2, 1}, {0, 0, -1}, INFINITY, NAN, NAN}},
     .known_count = 2},
    {.parameters = "\"float radius\" .8 \"float phimax\" 90", .area = PI * .16, .reach = 0.81},
}};
static const ShapeCase cylinder_shape = {{
    {.parameters = "\"float radius\" .5 \"float zmin\" -.4 \"float zmax\" .6",
     .area = PI,
     .known = {{{0, 2, 0}, {0, -1, 0}, 1.5, .25, .4},
               {{0, 2, .7}, {0, -1, 0}, INFINITY, NAN, NAN}},
     .known_count = 2},
    {.parameters = "\"float radius\" .5 \"float phimax\" 120", .area = PI / 3 * 2},
}};
/* A straight curve. Flat ones turn to the ray and are seen as wide as they are: 2 w l times the
 * mean sine of the angle between axis and ray, pi / 4. The width of ribbons is also multiplied
 * by the cosine between their normal and the ray, and so is their normal: the mean product is
 * 4 / (3 pi). */
#define STRAIGHT "\"point3 P\" [-.6 0 0 -.2 0 0 .2 0 0 .6 0 0] \"float width\" .1 "
static const ShapeCase curves_shape = {{
    {.parameters = STRAIGHT "\"string type\" \"flat\"",
     .area = 0.12 * PI / 2,
     .reach = 0.61,
     .faces_rays = true,
     .known = {{{.3, .04, 1}, {0, 0, -1}, 1, .75, NAN},
               {{.3, .06, 1}, {0, 0, -1}, INFINITY, NAN, NAN}},
     .known_count = 2},
    {.parameters = STRAIGHT "\"string type\" \"ribbon\" \"normal N\" [0 0 1 0 0 1]",
     .area = 0.12 * 8 / (3 * PI),
     .reach = 0.61,
     .faces_rays = true, /* its points lie across the ray, as in pbrt */
     .known = {{{.3, .04, 1}, {0, 0, -1}, 1, .75, NAN}},
     .known_count = 1},
    {.parameters = STRAIGHT "\"string type\" \"cylinder\"",
     .area = 0.12 * PI / 2,
     .reach = 0.61,
     .faces_rays = true},
}};

#define SHAPE_CASE(NAME, name) &name##_shape,
static const ShapeCase *const shape_cases[] = {VL_SHAPE_KINDS(SHAPE_CASE)};

/* ---- asking ------------------------------------------------------------------------------ */

enum { MAX_CROSSINGS = 8, LINE_BATCHES = 192, NORMAL_BATCHES = 24 };

typedef struct ShapeLaws {
  const char *kind;
  const ShapeVariant *variant;
  double reach; /* of the ball through which the lines go */
  vlTraceRays *rays;
  vlTraceHits *hits;
  Mean crossings;
  uint32_t compared, leaning, backwards;
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

static void count_crossings(ShapeLaws *s, vlTrace *trace, uint32_t batch) {
  double found[VL_OWN_BATCH] = {0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double d[3];
    double a[3];
    double b[3];
    double at[2];
    double origin[3];
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * batch, d);
    across(d, a, b);
    even_disk(i, 0.618034 * batch, at);
    for (int k = 0; k < 3; k++)
      origin[k] = s->reach * (at[0] * a[k] + at[1] * b[k]) - 2 * d[k];
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

static void compare_known(ShapeLaws *s, vlTrace *trace) {
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const ShapeKnown *k =
        &s->variant->known[i % (s->variant->known_count ? s->variant->known_count : 1)];
    const double down[3] = {0, 0, -1};
    set_ray(s->rays, i, k->origin, s->variant->known_count ? k->direction : down);
  }
  vl_world_trace(trace, s->rays, s->hits);
  for (uint32_t i = 0; i < s->variant->known_count; i++) {
    const ShapeKnown *k = &s->variant->known[i];
    double t = (double)s->hits->t[i];
    double u = (double)s->hits->uv[0][i];
    double v = (double)s->hits->uv[1][i];
    bool same_t = isinf(k->t) ? isinf(t) : fabs(t - k->t) < 1e-4;
    if (!same_t || fabs(u - k->u) > 1e-3 || fabs(v - k->v) > 1e-3)
      broken("shapes", s->kind,
             "%s: ray %u hits at %.5f, uv %.4f %.4f; known are %.5f, %.4f %.4f",
             s->variant->parameters, i, t, u, v, k->t, k->u, k->v);
  }
}

static void ask_shape(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  ShapeLaws *s = probe->user;
  count_crossings(s, trace, probe->batch);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    s->rays->t_min[i] = 0;
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
  snprintf(what, sizeof what, "%s: area by crossings", v->parameters);
  check_mean("shapes", row->name, what, &area, v->area,
             (Sight){0.002 * v->area, 0.05 * v->area});
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

static void laws_of_shapes(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const ShapeCase *c = shape_cases[k];
    assert_non_null(c->variants[0].parameters);
    for (int i = 0; i < SHAPE_VARIANTS && c->variants[i].parameters; i++)
      check_shape(family->rows[k], family->rows[k]->name, &c->variants[i]);
  }
  expect_no_failures();
}

#endif
