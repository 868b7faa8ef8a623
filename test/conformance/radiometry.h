/* conformance/radiometry.h: laws of the light of whole scenes, for every kind of light and for
 * emission: all that leaves a light crosses a sphere around it (its power); what falls on a
 * surface (its illuminance); what a floor reflects is what falls on it, by the path tracer; and
 * light paths bring as much as it finds. */
#ifndef TEST_CONFORMANCE_RADIOMETRY_H
#define TEST_CONFORMANCE_RADIOMETRY_H

#include "conformance.h"
#include "lights.h"
#include "parameters.h"
#include "transport.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/tracer.h"

static double luminance_of(const float rgb[3]) {
  return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

/* ---- power ------------------------------------------------------------------------------- */

#define AROUND "Material \"diffuse\" Shape \"sphere\" \"float radius\" 6\n"

enum { AROUND_RADIUS = 6 };

typedef struct Received {
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *lights;
  double normal[3]; /* of the surface whose illuminance is asked for */
  Mean light;       /* illuminance, or power */
} Received;

/* Luminance of light sample i, times the cosine to the normal at the hit. */
static double sampled_illuminance(const Received *r, uint32_t i) {
  const float radiance[3] = {r->lights->radiance[0][i], r->lights->radiance[1][i],
                             r->lights->radiance[2][i]};
  double cosine = 0;
  for (int k = 0; k < 3; k++)
    cosine += (double)r->lights->direction[k][i] * (double)r->hits->normal[k][i];
  return r->lights->pdf[i] > 0 && cosine > 0 ? luminance_of(radiance) * cosine : 0;
}

static void ask_around(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  static uint8_t hidden[VL_OWN_BATCH];
  Received *r = probe->user;
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * probe->batch, w);
    const double from[3] = {5.5 * w[0], 5.5 * w[1], 5.5 * w[2]};
    set_ray(r->rays, i, from, w);
  }
  vl_world_trace(trace, r->rays, r->hits);
  vl_trace_lights(trace, 0, r->lights);
  vl_world_occluded(trace, &r->lights->rays, hidden);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    mean_add(
        &r->light,
        hidden[i] ? 0 : sampled_illuminance(r, i) * 4 * PI * AROUND_RADIUS * AROUND_RADIUS);
}

static Mean receive(const char *text, const double normal[3],
                    void (*ask)(Probe *, vlTrace *, const vlOwnPaths *), uint32_t batches) {
  Received r = {.rays = new_rays()};
  r.hits = calloc(1, sizeof *r.hits);
  r.lights = calloc(1, sizeof *r.lights);
  for (int k = 0; k < 3; k++)
    r.normal[k] = normal ? normal[k] : 0;
  Probe probe = {.ask = ask, .user = &r};
  probe_world(text, &probe, batches);
  free(r.rays);
  free(r.hits);
  free(r.lights);
  return r.light;
}

/* A light, given by its power of 10, sends 10 through the sphere around it, and 4 with a scale
 * of .4. form: a scene with the kind and its parameters. */
static void check_power(const char *family, const char *kind, const char *form,
                        const char *parameters) {
  static const char *const scales[2] = {"", " \"float scale\" .4"};
  for (int i = 0; i < 2; i++) {
    static char text[TEXT];
    static char scaled[TEXT];
    char what[200];
    snprintf(scaled, sizeof scaled, "%s%s", parameters, scales[i]);
    scene_text(text, form, kind, scaled);
    const Mean power = receive(text, NULL, ask_around, 72);
    const double known = i ? 4 : 10;
    snprintf(what, sizeof what, "%.100s%s: power", parameters, scales[i]);
    check_mean(family, kind, what, &power, known, (Sight){0.015 * known, 0.1 * known});
  }
}

static void powers(void **state) {
  (void)state;
  static char parameters[TEXT];
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const ParameterCase *c = find_case("lights", row->name, NULL);
    bool given = false;
    for (uint32_t i = 0; i < row->parameter_count; i++)
      given = given || same_name(row->parameters[i].name, "power");
    if (!given)
      continue;
    parameters[0] = 0;
    append_base(parameters, c ? c->base : NULL, NULL);
    strcat(parameters, "\"float power\" 10");
    check_power("lights", row->name, HEAD "WorldBegin " AROUND "LightSource %s", parameters);
  }
  static const char *const emitted[] = {"\"float power\" 10",
                                        "\"float power\" 10 \"bool twosided\" true",
                                        "\"float power\" 10 \"float spread\" 120"};
  for (int i = 0; i < 3; i++)
    check_power("emission", "diffuse",
                HEAD "WorldBegin " AROUND
                     "AreaLightSource %s Shape \"bilinearmesh\" "
                     "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3]",
                emitted[i]);
  expect_no_failures();
}

/* ---- illuminance ------------------------------------------------------------------------- */

/* A ball in the light, asked where its normal is the known one: by samples of lights that no
 * ray hits, else by the emission over even directions. */
static void ask_ball(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  Received *r = probe->user;
  const double *n = r->normal;
  const double above[3] = {3 * n[0], 3 * n[1], 3 * n[2]};
  const double down[3] = {-n[0], -n[1], -n[2]};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    set_ray(r->rays, i, above, down);
  vl_world_trace(trace, r->rays, r->hits);
  vl_trace_lights(trace, 0, r->lights);
  double sum = 0;
  uint32_t deltas = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    deltas += r->lights->delta[i];
    sum += sampled_illuminance(r, i) / VL_OWN_BATCH;
  }
  if (deltas) {
    mean_add(&r->light, sum);
    return;
  }
  double cosines[VL_OWN_BATCH];
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    const double from[3] = {1.0001 * n[0], 1.0001 * n[1], 1.0001 * n[2]};
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * probe->batch, w);
    cosines[i] = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
    set_ray(r->rays, i, from, w);
  }
  vl_world_trace(trace, r->rays, r->hits);
  sum = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const float rgb[3] = {r->hits->emission[0][i], r->hits->emission[1][i],
                          r->hits->emission[2][i]};
    sum += cosines[i] > 0 ? luminance_of(rgb) * cosines[i] : 0;
  }
  mean_add(&r->light, sum * 4 * PI / VL_OWN_BATCH);
}

/* A light of an illuminance of 5 gives that, and 2 with a scale of .4, where the known normal
 * is. parameters: the others. */
static void check_illuminance(const char *kind, const char *parameters,
                              const double normal[3]) {
  static const char *const scales[2] = {"", " \"float scale\" .4"};
  for (int i = 0; i < 2; i++) {
    static char text[TEXT];
    static char all[TEXT];
    const double known = i ? 2 : 5;
    snprintf(all, sizeof all, "%s \"float illuminance\" 5%s", parameters, scales[i]);
    scene_text(text,
               HEAD
               "WorldBegin LightSource %s Material \"diffuse\" Shape \"sphere\" "
               "\"float radius\" 1",
               kind, all);
    Mean light = receive(text, normal, ask_ball, 24);
    /* of an image, it is summed over the centres of its few pixels */
    const bool image = strstr(parameters, "filename") != NULL;
    check_mean(
        "lights", kind,
        i ? "illuminance, scaled: light that arrives" : "illuminance: light that arrives",
        &light, known, (Sight){(image ? 0.09 : 0.004) * known, (image ? 0.12 : 0.01) * known});
  }
}

static void illuminances(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const LightCase *c = light_cases[k];
    for (uint32_t i = 0; i < row->parameter_count; i++)
      if (same_name(row->parameters[i].name, "illuminance") && !c->illuminated[0])
        broken("lights", row->name, "no case of its illuminance");
    for (int i = 0; i < LIGHT_VARIANTS && c->illuminated[i]; i++) {
      double length = sqrt(c->faced[0] * c->faced[0] + c->faced[1] * c->faced[1] +
                           c->faced[2] * c->faced[2]);
      const double normal[3] = {c->faced[0] / length, c->faced[1] / length,
                                c->faced[2] / length};
      check_illuminance(row->name, c->illuminated[i], normal);
    }
  }
  expect_no_failures();
}

/* ---- light paths ------------------------------------------------------------------------- */

/* A square floor and nothing else around a light, seen from just above it: the image is the
 * floor. */
#define SQUARE_FLOOR                                                               \
  "Material \"diffuse\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] " \
  "\"point3 P\" [-1 0 1 1 0 1 -1 0 -1 1 0 -1]\n"

enum { LIGHT_PATH_SPP = 2048, FLOOR_SPP = 256 };

/* The mean difference over a part of the image: one of its quarters, or for 4 the whole. */
static Mean difference_of_part(const vlImage *image, const vlImage *other, int part) {
  Mean mean = {0};
  const uint32_t half = WIDTH / 2;
  for (uint32_t y = 0; y < WIDTH; y++)
    for (uint32_t x = 0; x < WIDTH; x++)
      if (part == 4 || part == (int)(2 * (y / half) + x / half))
        mean_add(&mean,
                 (double)vl_image_get(image, x, y, 1) - (double)vl_image_get(other, x, y, 1));
  return mean;
}

/* The image by another tracer is the path tracer's, in each quarter and the whole. */
static void check_floor(const char *family, const char *kind, const char *parameters,
                        const char *by, const vlImage *image, const vlImage *paths) {
  double whole = mean_of_green(paths);
  for (int part = 0; part <= 4; part++) {
    char what[200];
    Mean off = difference_of_part(image, paths, part);
    snprintf(what, sizeof what, "%.100s: %s, part %d", parameters, by, part);
    check_mean(family, kind, what, &off, 0,
               (Sight){0.004 * whole, (part < 4 ? 0.25 : 0.12) * whole});
  }
}

/* Light paths bring as much light as the path tracer finds. And in the two-way tracer the
 * weights of all ways sum to 1, which they only do if the density that it computes for a ray
 * that leaves a light is the one with which light paths leave it. */
static void check_light_paths(const char *family, const char *kind, const char *parameters,
                              const char *text) {
  vlImage *paths = image_of_floor(text, VL_TRACER_PATH, FLOOR_SPP, 0, 0, 2);
  vlImage *light = image_of_floor(text, VL_TRACER_LIGHT_PATH, LIGHT_PATH_SPP, 0, 0, 2);
  vlImage *both = image_of_floor(text, VL_TRACER_BIDIRECTIONAL, FLOOR_SPP, 0, 0, 2);
  check_floor(family, kind, parameters, "light paths", light, paths);
  check_floor(family, kind, parameters, "both ways", both, paths);
  vl_image_destroy(paths);
  vl_image_destroy(light);
  vl_image_destroy(both);
}

static void check_paths_of_light(const vlKindRow *row, const LightVariant *v,
                                 const char *form) {
  static char text[TEXT];
  scene_text(text, form, row->name, v->parameters);
  check_light_paths("lights", row->name, v->parameters, text);
}

/* A sphere that is not seen shines to the outside alone, whichever side its normals are on. */
static void check_unseen_spheres(void) {
  static const char *const sides[] = {"", "ReverseOrientation"};
  static char text[TEXT];
  for (int i = 0; i < 2; i++) {
    snprintf(
        text, sizeof text,
        HEAD
        "WorldBegin " SQUARE_FLOOR
        "Translate .2 .8 .1 Rotate 50 1 .3 .2 %s AreaLightSource \"diffuse\" \"string filename\" \"halves.pfm\" \"float scale\" 4 "
        "\"bool twosided\" true Shape \"sphere\" \"float radius\" .3 \"float alpha\" 0",
        sides[i]);
    check_light_paths("emission", "diffuse",
                      i ? "an unseen sphere inside out" : "an unseen sphere", text);
  }
}

/* Light paths begin in the bright half of an image alone. */
static void check_half_dark(void) {
  static const char *const text =
      HEAD "WorldBegin " SQUARE_FLOOR
           "Translate 0 1 0 Rotate 90 1 0 0 LightSource \"projection\" "
           "\"string filename\" \"halves.pfm\" \"float fov\" 120";
  check_light_paths("lights", "projection", "an image that is dark on one half", text);
}

static void light_paths(void **state) {
  (void)state;
  static char text[TEXT];
  for_each_light(SQUARE_FLOOR, check_paths_of_light);
  for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++) {
    scene_text(text,
               HEAD "WorldBegin " SQUARE_FLOOR
                    "Translate .3 1.2 .2 Rotate 70 1 .2 .1 AreaLightSource %s",
               "diffuse", emissions[i]);
    const char *const *shape = emitting_shapes[i == 0];
    snprintf(text + strlen(text), sizeof text - strlen(text), " Shape \"%s\" %s", shape[0],
             shape[1]);
    check_light_paths("emission", "diffuse", emissions[i], text);
  }
  check_unseen_spheres();
  check_half_dark();
  expect_no_failures();
}

#endif
