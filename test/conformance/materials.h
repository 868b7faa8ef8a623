/* conformance/materials.h: the laws of materials, asked at a point of a square: a sample's
 * weight is the BSDF times the cosine over the density; the density integrates to the share of
 * samples that have one; the BSDF integrates to the mean weight; reciprocity; at most the light
 * that arrives leaves. */
#ifndef TEST_CONFORMANCE_MATERIALS_H
#define TEST_CONFORMANCE_MATERIALS_H

#include "conformance.h"
#include "material/material.case.h"
#include "unit.h"
#include "velo/schema.h"

#define MATERIAL_CASE(kind, name, ...) &name##_material,
static const MaterialCase *const material_cases[] = {VL_MATERIAL_KINDS(MATERIAL_CASE)};

/* ---- asking ------------------------------------------------------------------------------ */

/* Directions of the eye: angles from the normal; those above pi / 2 are below the square. */
/* MaterialVariant.albedo: the first */
static const double material_angles[] = {0.2, 1.1, PI - 0.6};
enum { MATERIAL_ANGLES = 3, MATERIAL_BATCHES = 28, GLASS_BATCHES = 80 };

typedef struct MaterialLaws {
  const char *kind;
  const MaterialVariant *variant;
  double angle;
  vlTraceRays *rays, *back;
  vlTraceHits *hits;
  vlTraceBounce *next;
  /* the mean weight of samples with a density; the integral of the BSDF */
  Mean weight[3], value[3];
  /* the mean weight of all samples; the share of it that stays on the eye's side */
  Mean all[3], stays;
  Mean density, has_density;
  /* of specular samples, 1 over the probability of their choice; which there were: back to the
   * eye's side, and across */
  Mean choices;
  bool chosen[2];
  Mean along; /* the samples' directions along x beyond what is known, by their weight */
  uint32_t compared, wrong_density, wrong_weight, both_ways, unequal;
} MaterialLaws;

static void eye_direction(double angle, double w[3]) {
  w[0] = sin(angle) * cos(0.7);
  w[1] = sin(angle) * sin(0.7);
  w[2] = cos(angle);
}

/* A ray that hits the square, each lane's at a point of its own, from the direction w. */
static void rays_towards(vlTraceRays *rays, uint32_t i, const double w[3]) {
  const double point[3] = {0.1 + 1e-4 * i, 0.2, 0};
  double origin[3];
  double direction[3];
  for (int k = 0; k < 3; k++) {
    origin[k] = point[k] + w[k];
    direction[k] = -w[k];
  }
  set_ray(rays, i, origin, direction);
}

/* Finds the points of the square that are seen from an angle to its normal: from *eye. */
static void look_at_square(vlTrace *trace, double angle, double eye[3], vlTraceRays *rays,
                           vlTraceHits *hits) {
  eye_direction(angle, eye);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    rays_towards(rays, i, eye);
  vl_world_trace(trace, rays, hits);
}

static bool close_to(double a, double b, double relative) {
  return fabs(a - b) <= relative * fmax(fabs(a), fabs(b)) + 1e-5;
}

static void ask_samples(MaterialLaws *m, vlTrace *trace, bool above) {
  static float value[4][VL_OWN_BATCH];
  static float pdf[VL_OWN_BATCH];
  vl_trace_bounce(trace, 0, m->next);
  vl_trace_bsdf(trace, m->next->rays.direction, value, pdf);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double sum = 0;
    bool dense = !m->next->specular[i] && m->next->pdf[i] > 0 && m->next->rays.t_max[i] >= 0;
    bool alike = true;
    for (int c = 0; c < 3; c++) {
      double weight = (double)m->next->weight[c][i];
      sum += weight;
      mean_add(&m->all[c], weight);
      mean_add(&m->weight[c], dense ? weight : 0);
      alike = alike && close_to((double)value[c][i], weight * (double)pdf[i], 5e-3);
    }
    bool stays = ((double)m->next->rays.direction[2][i] > 0) == above;
    mean_add(&m->stays, stays ? sum / 3 : 0);
    const bool specular = m->next->specular[i] && m->next->pdf[i] > 0;
    mean_add(&m->choices, specular ? 1 / (double)m->next->pdf[i] : 0);
    m->chosen[stays] = m->chosen[stays] || specular;
    mean_add(&m->has_density, dense);
    mean_add(&m->along, sum / 3 * ((double)m->next->rays.direction[0][i] - m->variant->along));
    if (!dense)
      continue;
    m->compared++;
    m->wrong_density += !close_to((double)pdf[i], (double)m->next->pdf[i], 5e-3);
    m->wrong_weight += !alike;
  }
}

/* The integrals over the sphere, by even directions. */
static void ask_integrals(MaterialLaws *m, vlTrace *trace, uint32_t batch) {
  static float directions[3][VL_OWN_BATCH];
  static float value[4][VL_OWN_BATCH];
  static float pdf[VL_OWN_BATCH];
  double density = 0;
  double sum[3] = {0, 0, 0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * batch, w);
    for (int k = 0; k < 3; k++)
      directions[k][i] = (float)w[k];
  }
  vl_trace_bsdf(trace, directions, value, pdf);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    density += (double)pdf[i];
    for (int c = 0; c < 3; c++)
      sum[c] += (double)value[c][i];
  }
  mean_add(&m->density, density * 4 * PI / VL_OWN_BATCH);
  for (int c = 0; c < 3; c++)
    mean_add(&m->value[c], sum[c] * 4 * PI / VL_OWN_BATCH);
}

static void ask_reciprocity(MaterialLaws *m, vlTrace *trace, uint32_t batch,
                            const double eye[3]) {
  static float directions[3][VL_OWN_BATCH];
  static float there[4][VL_OWN_BATCH];
  static float back[4][VL_OWN_BATCH];
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * batch, w);
    for (int k = 0; k < 3; k++)
      directions[k][i] = (float)w[k];
    rays_towards(m->back, i, w);
  }
  vl_trace_bsdf(trace, directions, there, NULL);
  vl_world_trace(trace, m->back, m->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int k = 0; k < 3; k++)
      directions[k][i] = (float)eye[k];
  vl_trace_bsdf(trace, directions, back, NULL);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.7548776662 * batch, w);
    const double index = m->variant->refracts;
    const bool crosses = w[2] * eye[2] < 0;
    if (fabs(w[2]) < 0.02 || (crosses && !m->variant->both_sides && index == 0))
      continue;
    double by = fabs(w[2]);
    if (crosses && index > 0) /* radiance over the square of the index */
      by *= eye[2] > 0 ? 1 / (index * index) : index * index;
    m->both_ways++;
    m->unequal += !close_to((double)there[1][i] * fabs(eye[2]), (double)back[1][i] * by, 0.01);
  }
}

static void ask_material(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  MaterialLaws *m = probe->user;
  double eye[3];
  look_at_square(trace, m->angle, eye, m->rays, m->hits);
  assert_true(isfinite(m->hits->t[0]));
  ask_samples(m, trace, eye[2] > 0);
  ask_integrals(m, trace, probe->batch);
  if (!m->variant->one_way && !m->variant->walks)
    ask_reciprocity(m, trace, probe->batch, eye);
}

/* ---- the laws ---------------------------------------------------------------------------- */

static void judge_material(const MaterialLaws *m) {
  const MaterialVariant *v = m->variant;
  const char *p = v->parameters;
  double a = m->angle;
  if (m->wrong_density > m->compared / 100)
    broken("materials", m->kind,
           "%s, %.1f: density of %u of %u samples is not that of the BSDF", p, a,
           m->wrong_density, m->compared);
  if (!v->walks && m->wrong_weight > m->compared / 100)
    broken("materials", m->kind,
           "%s, %.1f: weight of %u of %u samples is not BSDF over density", p, a,
           m->wrong_weight, m->compared);
  const Sight sight = {.slack = 5e-3, .min = 0.06};
  const Sight sharp = {.slack = 2e-3, .min = 0.02};
  char what[400];
  snprintf(what, sizeof what, "%s, %.1f: the density, and the share of samples with one", p, a);
  check_same_mean("materials", m->kind, what, &m->density, &m->has_density, sight);
  for (int c = 0; c < 3; c++) {
    snprintf(what, sizeof what, "%s, %.1f: channel %d, integral and mean weight", p, a, c);
    check_same_mean("materials", m->kind, what, &m->value[c], &m->weight[c], sight);
    double more = mean_of(&m->all[c]) - 1 - 5 * sqrt(variance_of_mean(&m->all[c]));
    if (v->refracts == 0 && !(more < 1e-3))
      broken("materials", m->kind, "%s, %.1f: channel %d sends %.4f of the light", p, a, c,
             mean_of(&m->all[c]));
    snprintf(what, sizeof what, "%s, %.1f: channel %d, light that is sent", p, a, c);
    if (v->albedo[c] > 0 && a == material_angles[0])
      check_mean("materials", m->kind, what, &m->all[c], v->albedo[c], sharp);
  }
  snprintf(what, sizeof what, "%s, %.1f: the number of directions, by their probabilities", p,
           a);
  if (!v->walks)
    check_mean("materials", m->kind, what, &m->choices, m->chosen[0] + m->chosen[1],
               (Sight){.slack = 5e-3, .min = 0.25});
  double all = (mean_of(&m->all[0]) + mean_of(&m->all[1]) + mean_of(&m->all[2])) / 3;
  snprintf(what, sizeof what, "%s, %.1f: light that is reflected", p, a);
  if (v->reflected > 0 && a == material_angles[0])
    check_mean("materials", m->kind, what, &m->stays, v->reflected * all, sharp);
  snprintf(what, sizeof what, "%s, %.1f: light along x", p, a);
  if (v->along != 0 && a == material_angles[0])
    check_mean("materials", m->kind, what, &m->along, 0, (Sight){.slack = 1e-3, .min = 0.01});
  if (m->unequal > m->both_ways / 100)
    broken("materials", m->kind, "%s, %.1f: %u of %u directions are not reciprocal", p, a,
           m->unequal, m->both_ways);
}

#define SQUARE_UP "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]\n"
static const char *const material_form =
    HEAD "WorldBegin LightSource \"infinite\" " NAMED "Material %s " SQUARE_UP;

static void check_material(const vlKindRow *row, const MaterialVariant *v) {
  static char text[TEXT];
  scene_text(text, material_form, row->name, v->parameters);
  vlTraceBounce *next = calloc(1, sizeof *next);
  vlTraceHits *hits = calloc(1, sizeof *hits);
  vlTraceRays *rays = new_rays();
  vlTraceRays *back = new_rays();
  for (int a = 0; a < MATERIAL_ANGLES; a++) {
    MaterialLaws m = {.kind = row->name, .variant = v, .angle = material_angles[a]};
    m.rays = rays;
    m.back = back;
    m.hits = hits;
    m.next = next;
    Probe probe = {.ask = ask_material, .user = &m};
    probe_world(text, &probe, v->refracts > 0 ? GLASS_BATCHES : MATERIAL_BATCHES);
    judge_material(&m);
  }
  free(next);
  free(hits);
  free(rays);
  free(back);
}

/* What has no surface is not hit. */
static void ask_absent(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  MaterialLaws *m = probe->user;
  double eye[3];
  look_at_square(trace, material_angles[0], eye, m->rays, m->hits);
  if (isfinite(m->hits->t[0]))
    broken("materials", m->kind, "a ray hits it");
}
static void check_absent(const vlKindRow *row) {
  static char text[TEXT];
  vlTraceHits *hits = calloc(1, sizeof *hits);
  MaterialLaws m = {.kind = row->name, .rays = new_rays(), .hits = hits};
  Probe probe = {.ask = ask_absent, .user = &m};
  scene_text(text, material_form, row->name, "");
  probe_world(text, &probe, 1);
  free(m.rays);
  free(hits);
}

static void laws_of_materials(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("materials");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const MaterialCase *c = material_cases[k];
    assert_non_null(c->variants[0].parameters);
    if (row->traits & VL_MATERIAL_ABSENT) {
      check_absent(row);
      continue;
    }
    for (int i = 0; i < MATERIAL_VARIANTS && c->variants[i].parameters; i++)
      check_material(row, &c->variants[i]);
  }
  expect_no_failures();
}

#endif
