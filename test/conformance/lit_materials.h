/* conformance/lit_materials.h: the law of many lights: a material among point lights on all
 * sides reflects and transmits their sum when one of them is sampled at a time. No light that
 * it scatters may be left out of the choice. */
#ifndef TEST_CONFORMANCE_LIT_MATERIALS_H
#define TEST_CONFORMANCE_LIT_MATERIALS_H

#include "conformance.h"
#include "materials.h"
#include "unit.h"

enum { POINT_LIGHTS = 12, LIT_BATCHES = 32 };

typedef struct LitLaws {
  const MaterialVariant *variant;
  double angle;
  double lights[POINT_LIGHTS][3];
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *sampled;
  Mean one, all; /* by one light; the sum over the lights */
} LitLaws;

static double strength(int light) {
  return 1 + light % 3;
}

/* Adds a light's part to `sum`, of each lane. */
static void add_light_of(LitLaws *m, vlTrace *trace, int light, double sum[VL_OWN_BATCH]) {
  static float direction[3][VL_OWN_BATCH];
  static float value[4][VL_OWN_BATCH];
  static double distance2[VL_OWN_BATCH];
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    distance2[i] = 0;
    for (int k = 0; k < 3; k++) {
      const double to = m->lights[light][k] - (double)m->hits->position[k][i];
      direction[k][i] = (float)to;
      distance2[i] += to * to;
    }
    for (int k = 0; k < 3; k++)
      direction[k][i] /= (float)sqrt(distance2[i]);
  }
  vl_trace_bsdf(trace, direction, value, NULL);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    sum[i] += (double)value[1][i] * strength(light) / distance2[i];
}

static void ask_lit(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static float value[4][VL_OWN_BATCH];
  static double sum[VL_OWN_BATCH];
  LitLaws *m = probe->user;
  double eye[3];
  look_at_square(trace, m->angle, eye, m->rays, m->hits);
  vl_trace_lights(trace, 0, m->sampled);
  vl_trace_bsdf(trace, m->sampled->direction, value, NULL);
  memset(sum, 0, sizeof sum);
  for (int k = 0; k < POINT_LIGHTS; k++)
    add_light_of(m, trace, k, sum);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const bool sampled = m->sampled->pdf[i] > 0;
    mean_add(&m->one, sampled ? (double)value[1][i] * (double)m->sampled->radiance[1][i] : 0);
    mean_add(&m->all, sum[i]);
  }
}

static void check_lit(const vlKindRow *row, const MaterialVariant *v) {
  static char text[TEXT];
  static const char form[] = HEAD "WorldBegin " NAMED "Material %s " SQUARE_UP;
  LitLaws m = {.variant = v,
               .rays = new_rays(),
               .hits = calloc(1, sizeof *m.hits),
               .sampled = calloc(1, sizeof *m.sampled)};
  scene_text(text, form, row->name, v->parameters);
  for (int k = 0; k < POINT_LIGHTS; k++) {
    even_direction(k, POINT_LIGHTS, 0.3, m.lights[k]);
    for (int c = 0; c < 3; c++)
      m.lights[k][c] *= 3;
    snprintf(text + strlen(text), TEXT - strlen(text),
             " LightSource \"point\" \"rgb I\" [%g %g %g] \"point3 from\" [%.9g %.9g %.9g]\n",
             strength(k), strength(k), strength(k), m.lights[k][0], m.lights[k][1],
             m.lights[k][2]);
  }
  for (int a = 0; a < MATERIAL_ANGLES; a++) {
    char what[300];
    m.angle = material_angles[a];
    m.one = m.all = (Mean){0};
    Probe probe = {.ask = ask_lit, .user = &m};
    probe_world(text, &probe, LIT_BATCHES);
    const double whole = mean_of(&m.all);
    snprintf(what, sizeof what, "%s, %.1f: light of twelve points", v->parameters, m.angle);
    if (whole > 0)
      check_same_mean("materials", row->name, what, &m.one, &m.all,
                      (Sight){.slack = 2e-3 * whole, .min = 0.2 * whole});
  }
  free(m.rays);
  free(m.hits);
  free(m.sampled);
}

static void lit_materials(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("materials");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int i = 0; i < MATERIAL_VARIANTS && material_cases[k]->variants[i].parameters; i++)
      if (!(family->rows[k]->traits & VL_MATERIAL_ABSENT))
        check_lit(family->rows[k], &material_cases[k]->variants[i]);
  expect_no_failures();
}

#endif
