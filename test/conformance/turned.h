/* conformance/turned.h: materials whose roughness differs along u and along v: with the two
 * exchanged they scatter like the first ones turned by 90 degrees about the normal, also where
 * one of them is so small that a surface of both would be a mirror. */
#ifndef TEST_CONFORMANCE_TURNED_H
#define TEST_CONFORMANCE_TURNED_H

#include "conformance.h"
#include "materials.h"
#include "unit.h"
#include "velo/schema.h"

enum { TURNED_BATCHES = 8 };

/* What one of the two materials says. The second is asked about the samples of the first. */
typedef struct Turned {
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceBounce *next;
  struct Turned *first; /* null: this is the first one */
  Mean weight, dense;
  float way[TURNED_BATCHES][3][VL_OWN_BATCH];
  float value[TURNED_BATCHES][VL_OWN_BATCH], pdf[TURNED_BATCHES][VL_OWN_BATCH];
} Turned;

static void turn_by_90(const double w[3], double turned[3]) {
  turned[0] = -w[1];
  turned[1] = w[0];
  turned[2] = w[2];
}

static void ask_turned(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  static float value[4][VL_OWN_BATCH];
  static float way[3][VL_OWN_BATCH];
  (void)paths;
  Turned *t = probe->user;
  const uint32_t batch = probe->batch;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double eye[3];
    double turned[3];
    eye_direction(0.1 + 1.2 * i / VL_OWN_BATCH, eye);
    turn_by_90(eye, turned);
    rays_towards(t->rays, i, t->first ? turned : eye);
  }
  vl_world_trace(trace, t->rays, t->hits);
  vl_trace_bounce(trace, 0, t->next);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    mean_add(&t->weight, (double)t->next->weight[1][i]);
    mean_add(&t->dense, !t->next->specular[i] && t->next->pdf[i] > 0);
    double w[3];
    double turned[3];
    for (int k = 0; k < 3; k++) {
      const float *sampled = t->next->rays.direction[k];
      w[k] = (double)(t->first ? t->first->way[batch][k][i] : sampled[i]);
      t->way[batch][k][i] = (float)w[k];
    }
    turn_by_90(w, turned);
    for (int k = 0; k < 3; k++)
      way[k][i] = (float)(t->first ? turned[k] : w[k]);
  }
  vl_trace_bsdf(trace, way, value, t->pdf[batch]);
  memcpy(t->value[batch], value[1], sizeof value[1]);
}

static Turned *ask_about(const char *kind, const char *layer, const double alpha[2],
                         Turned *first) {
  static char text[TEXT];
  char parameters[200];
  Turned *t = calloc(1, sizeof *t);
  assert_non_null(t);
  t->rays = new_rays();
  t->hits = calloc(1, sizeof *t->hits);
  t->next = calloc(1, sizeof *t->next);
  t->first = first;
  assert_true(t->hits && t->next);
  snprintf(parameters, sizeof parameters,
           "\"float %suroughness\" %g \"float %svroughness\" %g \"bool remaproughness\" false",
           layer, alpha[first ? 1 : 0], layer, alpha[first ? 0 : 1]);
  scene_text(text, material_form, kind, parameters);
  Probe probe = {.ask = ask_turned, .user = t};
  probe_world(text, &probe, TURNED_BATCHES);
  return t;
}

static void free_turned(Turned *t) {
  free(t->rays);
  free(t->hits);
  free(t->next);
  free(t);
}

static void check_turned(const char *kind, const char *layer, const double alpha[2]) {
  Turned *a = ask_about(kind, layer, alpha, NULL);
  Turned *b = ask_about(kind, layer, alpha, a);
  uint32_t differ = 0;
  char what[200];
  for (uint32_t batch = 0; batch < TURNED_BATCHES; batch++)
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      differ += !close_to((double)a->value[batch][i], (double)b->value[batch][i], 0.03) ||
                !close_to((double)a->pdf[batch][i], (double)b->pdf[batch][i], 0.03);
  /* values below a coat are estimated by random walks */
  if (!layer[0] && differ > TURNED_BATCHES * VL_OWN_BATCH / 50)
    broken("materials", kind, "%sroughness %g, %g: %u of %u directions differ when turned",
           layer, alpha[0], alpha[1], differ, TURNED_BATCHES * VL_OWN_BATCH);
  snprintf(what, sizeof what, "%sroughness %g, %g: share of samples with a density", layer,
           alpha[0], alpha[1]);
  check_same_mean("materials", kind, what, &a->dense, &b->dense,
                  (Sight){.slack = 5e-3, .min = 0.1});
  snprintf(what, sizeof what, "%sroughness %g, %g: light that is sent", layer, alpha[0],
           alpha[1]);
  check_same_mean("materials", kind, what, &a->weight, &b->weight,
                  (Sight){.slack = 5e-3, .min = 0.25});
  free_turned(a);
  free_turned(b);
}

static void turned_materials(void **state) {
  static const double alphas[2][2] = {{0.6, 8e-4}, {0.15, 0.5}};
  static const char end[] = "uroughness";
  const vlKindFamily *family = vl_kind_family_find("materials");
  (void)state;
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    for (uint32_t i = 0; i < row->parameter_count; i++) {
      const char *name = row->parameters[i].name;
      const char *at = name ? strstr(name, end) : NULL;
      char layer[40];
      if (!at || at[sizeof end - 1])
        continue;
      snprintf(layer, sizeof layer, "%.*s", (int)(at - name), name);
      for (int a = 0; a < 2; a++)
        check_turned(row->name, layer, alphas[a]);
    }
  }
  expect_no_failures();
}

#endif
