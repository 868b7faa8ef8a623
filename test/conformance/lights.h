/* conformance/lights.h: the laws of lights, of the emission of shapes and of the shapes that
 * emit, asked at points of a floor: a sample's radiance is the emission along its direction
 * over the density; the density integrates to 1 where there is light, so that the mean of the
 * samples is the integral of the emission; lights that no ray can hit shine as the closed form
 * says. */
#ifndef TEST_CONFORMANCE_LIGHTS_H
#define TEST_CONFORMANCE_LIGHTS_H

#include "conformance.h"
#include "velo/light.h"

/* Radiance times solid angle that arrives at a point of the floor y = 0. */
typedef struct LightKnown {
  double x, z;
  double rgb[3];
} LightKnown;

typedef struct LightVariant {
  const char *parameters; /* null ends the list */
  LightKnown known[4];    /* of delta lights; rgb[1] = 0 ends the list unless x is set */
  uint32_t known_count;
  bool compensated; /* directions darker than the mean are not sampled: BSDF samples find their
                       light */
} LightVariant;

enum { LIGHT_VARIANTS = 4 };
typedef struct LightCase {
  const char *before; /* statements before the light, such as its place; null: none */
  LightVariant variants[LIGHT_VARIANTS];
} LightCase;

static const LightCase point_light = {
    .variants = {
        {.parameters = "\"point3 from\" [0 2 0] \"rgb I\" [4 2 1]",
         .known = {{0, 0, {1, .5, .25}}, {2, 0, {.5, .25, .125}}},
         .known_count = 2},
        {.parameters = "\"point3 from\" [0 1 0] \"rgb I\" [1 1 1] \"float scale\" 3",
         .known = {{0, 0, {3, 3, 3}}},
         .known_count = 1},
        {.parameters = "\"point3 from\" [0 1 0] \"rgb I\" [1 1 1] \"float power\" 25.1327412",
         .known = {{0, 0, {2, 2, 2}}},
         .known_count = 1},
    }};
/* Between the cosines of 40 and of 20 degrees t runs from 0 to 1; the falloff is 3 t^2 - 2 t^3,
 * here of t = .5 and of .1955 (36.87 degrees), over the squared distance. */
static const LightCase spot_light = {
    .variants = {
        {.parameters =
             "\"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb I\" [1 1 1] \"float "
             "coneangle\" 40 \"float "
             "conedeltaangle\" 20",
         .known = {{0, 0, {1, 1, 1}},
                   {.612460, 0, {.363607, .363607, .363607}},
                   {.75, 0, {.063842, .063842, .063842}},
                   {1, 0, {0, 0, 0}}},
         .known_count = 4},
        {.parameters = "\"point3 from\" [0 1 0] \"point3 to\" [1 0 0] \"rgb I\" [1 2 4]",
         .known = {{1, 0, {.5, 1, 2}}},
         .known_count = 1},
    }};
static const LightCase distant_light = {
    .variants = {
        {.parameters = "\"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [3 2 1]",
         .known = {{0, 0, {3, 2, 1}}, {1, 1, {3, 2, 1}}},
         .known_count = 2},
        {.parameters =
             "\"point3 from\" [1 1 0] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1] \"float "
             "illuminance\" 5",
         .known = {{0, 0, {5, 5, 5}}},
         .known_count = 1},
    }};
static const LightCase infinite_light = {
    .variants = {
        {.parameters = "\"rgb L\" [.5 1 2]"},
        {.parameters = "\"string filename\" \"sky.pfm\"", .compensated = true},
        {.parameters = "\"string filename\" \"sky.pfm\" \"point3 portal\" [-2 0 -3 2 0 -3 2 4 "
                       "-3 -2 4 -3]"},
    }};
/* The image has .2, .4, .6, .8 in its quarters: left top, right top, left bottom, right bottom.
 * Its map has y upwards: below the light, u goes with x and v with z. The distance is the root
 * of 1.5. */
static const LightCase goniometric_light = {
    .before = "Translate 0 1 0",
    .variants = {
        {.parameters = "\"string filename\" \"quarters.pfm\" \"rgb I\" [1 1 1]",
         .known = {{.5, .5, {.8 / 1.5, .8 / 1.5, .8 / 1.5}},
                   {-.5, .5, {.6 / 1.5, .6 / 1.5, .6 / 1.5}},
                   {.5, -.5, {.4 / 1.5, .4 / 1.5, .4 / 1.5}},
                   {-.5, -.5, {.2 / 1.5, .2 / 1.5, .2 / 1.5}}},
         .known_count = 4},
    }};
static const LightCase projection_light = {
    .before = "Translate 0 1 0 Rotate 90 1 0 0",
    .variants = {
        {.parameters = "\"string filename\" \"quarters.pfm\" \"float fov\" 90",
         .known = {{.5, .5, {.4 / 1.5, .4 / 1.5, .4 / 1.5}},
                   {-.5, .5, {.2 / 1.5, .2 / 1.5, .2 / 1.5}},
                   {.5, -.5, {.8 / 1.5, .8 / 1.5, .8 / 1.5}},
                   {1.2, 0, {0, 0, 0}}},
         .known_count = 4},
    }};

#define LIGHT_CASE(NAME, name) &name##_light,
static const LightCase *const light_cases[] = {VL_LIGHT_KINDS(LIGHT_CASE)};

/* ---- asking ------------------------------------------------------------------------------ */

typedef struct LightLaws {
  double x, z; /* the point of the floor */
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *lights;
  Mean sampled[3], integral[3];
  uint32_t compared, wrong, deltas;
} LightLaws;

static void ask_light(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static uint8_t hidden[VL_OWN_BATCH];
  LightLaws *l = probe->user;
  const double above[3] = {l->x, 0.02, l->z};
  const double down[3] = {0, -1, 0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    set_ray(l->rays, i, above, down);
  vl_world_trace(trace, l->rays, l->hits);
  assert_true(isfinite(l->hits->t[0]));
  vl_trace_lights(trace, 0, l->lights);
  vl_world_occluded(trace, &l->lights->rays, hidden);
  /* the emission of even directions of the upper half */
  double sum[3] = {0, 0, 0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    const double from[3] = {l->x, 1e-5, l->z};
    even_direction(i, 2 * VL_OWN_BATCH, 0.7548776662 * probe->batch, w);
    double y = w[1];
    w[1] = w[2];
    w[2] = y;
    set_ray(l->rays, i, from, w);
  }
  vl_world_trace(trace, l->rays, l->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int c = 0; c < 3; c++)
      sum[c] += (double)l->hits->emission[c][i];
  for (int c = 0; c < 3; c++)
    mean_add(&l->integral[c], sum[c] * 2 * PI / VL_OWN_BATCH);
  /* the emission along the samples */
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double from[3] = {l->x, 1e-5, l->z};
    const double w[3] = {(double)l->lights->direction[0][i], (double)l->lights->direction[1][i],
                         (double)l->lights->direction[2][i]};
    set_ray(l->rays, i, from, l->lights->pdf[i] > 0 ? w : down);
  }
  vl_world_trace(trace, l->rays, l->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    bool up = l->lights->direction[1][i] > 0;
    bool alike = true;
    for (int c = 0; c < 3; c++) {
      double radiance = (double)l->lights->radiance[c][i];
      double emitted = (double)l->hits->emission[c][i];
      mean_add(&l->sampled[c], up && !hidden[i] ? radiance : 0);
      alike = alike &&
              fabs(radiance * (double)l->lights->pdf[i] - emitted) <= 0.01 * emitted + 1e-5;
    }
    l->deltas += l->lights->delta[i];
    if (l->lights->pdf[i] > 0 && up && !hidden[i] && !l->lights->delta[i]) {
      l->compared++;
      l->wrong += !alike;
    }
  }
}

static LightLaws ask_floor(const char *text, double x, double z, uint32_t batches) {
  LightLaws l = {.x = x, .z = z, .rays = new_rays()};
  l.hits = calloc(1, sizeof *l.hits);
  l.lights = calloc(1, sizeof *l.lights);
  Probe probe = {.ask = ask_light, .user = &l};
  probe_world(text, &probe, batches);
  free(l.rays);
  free(l.hits);
  free(l.lights);
  return l;
}

/* The laws of light that rays can hit, at a few points of the floor. */
static void check_hit_light(const char *family, const char *kind, const char *parameters,
                            const char *text, bool compensated) {
  static const double points[][2] = {{0.1, 0.2}, {-0.2, 0.4}};
  char what[400];
  for (int k = 0; k < 2; k++) {
    LightLaws l = ask_floor(text, points[k][0], points[k][1], 112);
    if (l.compared < 1000)
      broken(family, kind, "%s: %u samples of 16384", parameters, l.compared);
    if (l.wrong > l.compared / 50)
      broken(family, kind, "%s: %u of %u samples are not emission over density", parameters,
             l.wrong, l.compared);
    for (int c = 0; c < 3 && !compensated; c++) {
      double whole = mean_of(&l.integral[c]);
      snprintf(what, sizeof what, "%s: samples, and the emission's integral", parameters);
      check_same_mean(family, kind, what, &l.sampled[c], &l.integral[c],
                      (Sight){0.005 * whole, 0.06 * whole});
    }
  }
}

static void check_delta_light(const char *kind, const LightVariant *v, const char *text) {
  assert_true(v->known_count > 0);
  for (uint32_t k = 0; k < v->known_count; k++) {
    const LightKnown *known = &v->known[k];
    LightLaws l = ask_floor(text, known->x, known->z, 1);
    for (int c = 0; c < 3; c++)
      if (fabs(mean_of(&l.sampled[c]) - known->rgb[c]) > 2e-3 * known->rgb[c] + 2e-4)
        broken("lights", kind, "%s: %.5f arrives at (%g, %g), not %.5f", v->parameters,
               mean_of(&l.sampled[c]), known->x, known->z, known->rgb[c]);
  }
}

#define FLOOR \
  "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9]\n"

static void laws_of_lights(void **state) {
  (void)state;
  static char form[TEXT];
  static char text[TEXT];
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const LightCase *c = light_cases[k];
    assert_non_null(c->variants[0].parameters);
    snprintf(form, sizeof form,
             HEAD "WorldBegin " FLOOR "AttributeBegin %s LightSource %%s AttributeEnd\n",
             c->before ? c->before : "");
    for (int i = 0; i < LIGHT_VARIANTS && c->variants[i].parameters; i++) {
      scene_text(text, form, row->name, c->variants[i].parameters);
      if (row->traits & VL_LIGHT_TRAIT_DELTA)
        check_delta_light(row->name, &c->variants[i], text);
      else
        check_hit_light("lights", row->name, c->variants[i].parameters, text,
                        c->variants[i].compensated);
    }
  }
  expect_no_failures();
}

/* ---- shapes that emit -------------------------------------------------------------------- */

static const char *const emissions[] = {
    "\"rgb L\" [1 2 3] \"float scale\" 2",
    "\"rgb L\" [1 1 1] \"bool twosided\" true",
    "\"rgb L\" [1 1 1] \"float power\" 10",
    "\"string filename\" \"quarters.pfm\"",
};

/* The light of a shape that is placed above the floor. */
static void check_emitting_shape(const char *family, const char *kind, const char *shape,
                                 const char *parameters, const char *emission) {
  static char text[TEXT];
  snprintf(
      text, sizeof text,
      HEAD
      "WorldBegin " FLOOR
      "AttributeBegin AreaLightSource \"diffuse\" %s Translate .3 1.1 .2 Rotate 70 1 .2 .1 "
      "Shape \"%s\" %s AttributeEnd\n",
      emission, shape, parameters);
  check_hit_light(family, kind, emission, text, false);
}

static void laws_of_emission(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("emission");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++)
      check_emitting_shape("emission", family->rows[k]->name, "bilinearmesh",
                           "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3]", emissions[i]);
  expect_no_failures();
}

#endif
