/* conformance/saved_lights.h: a law of writers of scenes: of two lights of a kind, each sends
 * what it sends where it is alone in the file, whatever the writer says that it loses. */
#ifndef TEST_CONFORMANCE_SAVED_LIGHTS_H
#define TEST_CONFORMANCE_SAVED_LIGHTS_H

#include "conformance.h"
#include "lights.h"
#include "neighbours.h"
#include "unit.h"

enum { SAVED_BATCHES = 8, LIGHT_TEXT = 1000 };

/* What arrives at the floor, each point of it from a light that is chosen at random. */
typedef struct Arrival {
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *lights;
  Mean light;
} Arrival;

static void ask_arrival(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Arrival *a = probe->user;
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    static const double down[3] = {0, -1, 0};
    const double above[3] = {2 * fmod(0.5 + i * 0.7548776662466927, 1.0) - 1, 0.02,
                             2 * fmod(0.5 + i * 0.5698402909980532, 1.0) - 1};
    set_ray(a->rays, i, above, down);
  }
  vl_world_trace(trace, a->rays, a->hits);
  vl_trace_lights(trace, 0, a->lights);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    mean_add(&a->light, (double)a->lights->radiance[1][i]);
}

/* Of the lights of these statements, read from a file. */
static Mean arrival_through_file(const char *one, const char *other, const char *suffix) {
  char text[3 * LIGHT_TEXT];
  snprintf(text, sizeof text, HEAD "WorldBegin " FLOOR "%.*s%.*s", LIGHT_TEXT, one, LIGHT_TEXT,
           other);
  Arrival a = {.rays = new_rays()};
  a.hits = calloc(1, sizeof *a.hits);
  a.lights = calloc(1, sizeof *a.lights);
  Probe probe = {.ask = ask_arrival, .user = &a};
  vlScene *scene = need_scene(text);
  probe_scene(through_file(scene, suffix), text, &probe, SAVED_BATCHES);
  vl_scene_destroy(scene);
  free(a.rays);
  free(a.hits);
  free(a.lights);
  return a.light;
}

static void light_statement(const char *kind, const LightCase *c, const LightVariant *v,
                            char text[LIGHT_TEXT]) {
  snprintf(text, LIGHT_TEXT, "AttributeBegin %s %s LightSource \"%s\" %s AttributeEnd\n",
           c->before ? c->before : "", v->before ? v->before : "", kind, v->parameters);
}

/* alone: what each of the two sends. */
static void check_pair_of_lights(const char *kind, const LightCase *c, const LightVariant *v,
                                 const Mean alone[2], const char *suffix) {
  char texts[2][LIGHT_TEXT];
  char what[300];
  light_statement(kind, c, &v[0], texts[0]);
  light_statement(kind, c, &v[1], texts[1]);
  const Mean both = arrival_through_file(texts[0], texts[1], suffix);
  const double sum = mean_of(&alone[0]) + mean_of(&alone[1]);
  const double error =
      sqrt(variance_of_mean(&alone[0]) + variance_of_mean(&alone[1]) + variance_of_mean(&both));
  snprintf(what, sizeof what, "%.100s and %.100s, as .%s: both", v[0].parameters,
           v[1].parameters, suffix);
  check_value("lights", kind, what, mean_of(&both), error, sum,
              (Sight){1e-3 * sum, 0.3 * sum + 1e-9});
}

static void check_lights_of_file(const char *kind, const LightCase *c, const char *suffix) {
  Mean alone[LIGHT_VARIANTS];
  for (int i = 0; i < LIGHT_VARIANTS && c->variants[i].parameters; i++) {
    char text[LIGHT_TEXT];
    light_statement(kind, c, &c->variants[i], text);
    alone[i] = arrival_through_file(text, "", suffix);
    if (i > 0)
      check_pair_of_lights(kind, c, &c->variants[i - 1], &alone[i - 1], suffix);
  }
}

static void lights_of_files(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    check_lights_of_file(family->rows[k]->name, light_cases[k], "pbrt");
    if (family->rows[k]->traits & VL_LIGHT_TRAIT_DELTA) /* glTF has one sky */
      check_lights_of_file(family->rows[k]->name, light_cases[k], "gltf");
  }
  expect_no_failures();
}

#endif
