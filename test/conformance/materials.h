/* conformance/materials.h: the laws of materials, asked at a point of a square: a sample's
 * weight is the BSDF times the cosine over the density; the density integrates to the share of
 * samples that have one; the BSDF integrates to the mean weight; reciprocity; at most the light
 * that arrives leaves. */
#ifndef TEST_CONFORMANCE_MATERIALS_H
#define TEST_CONFORMANCE_MATERIALS_H

#include "conformance.h"
#include "velo/material.h"

typedef struct MaterialVariant {
  const char *parameters; /* null ends the list */
  double albedo[3];       /* known mean weight at the first angle; 0: not known */
  double
      reflected; /* known share of the weight that stays on the side of the eye; 0: not known */
  bool refracts; /* radiance changes with the square of the index: no law of energy, none of
                    reciprocity */
  bool both_sides; /* light from below is scattered, too: reciprocity over the whole sphere */
  bool one_way;    /* not reciprocal */
  bool
      walks; /* the BSDF is estimated by random walks: its means are compared, not its values */
} MaterialVariant;

enum { MATERIAL_VARIANTS = 5 };
typedef struct MaterialCase {
  MaterialVariant variants[MATERIAL_VARIANTS];
} MaterialCase;

static const MaterialCase diffuse_material = {{
    {.parameters = "\"rgb reflectance\" [.5 .3 .8]", .albedo = {.5, .3, .8}, .reflected = 1},
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"rgb reflectance\" [0 0 1]", .albedo = {0, 0, 1}, .reflected = 1},
}};
static const MaterialCase coated_diffuse_material = {{
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" 0", .reflected = 1},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" .25", .reflected = 1},
    {.parameters =
         "\"rgb reflectance\" [1 1 1] \"float uroughness\" .1 \"float vroughness\" .5",
     .reflected = 1},
    {.parameters =
         "\"rgb reflectance\" [.5 .5 .5] \"float thickness\" .5 \"rgb albedo\" [.9 .5 "
         ".1] \"float g\" .3",
     .reflected = 1,
     .walks = true},
}};
static const MaterialCase conductor_material = {{
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"float roughness\" .2", .reflected = 1},
    {.parameters = "\"float uroughness\" .6 \"float vroughness\" .1", .reflected = 1},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" 1", .reflected = 1},
}};
/* Fresnel at 0.2 radians for an index of 1.5: 0.0400; of a pane 2 r / (1 + r) = 0.0769. */
static const MaterialCase dielectric_material = {{
    {.parameters = "\"float eta\" 1.5", .refracts = true},
    {.parameters = "\"float eta\" 1.5 \"float roughness\" .2", .refracts = true},
    {.parameters = "\"float eta\" 2.2 \"float uroughness\" .3 \"float vroughness\" .6",
     .refracts = true},
    {.parameters = "\"float eta\" .7 \"float roughness\" .3", .refracts = true},
}};
static const MaterialCase thin_dielectric_material = {{
    {.parameters = "\"float eta\" 1.5", .albedo = {1, 1, 1}, .reflected = 0.0769},
    {.parameters = "\"float eta\" 1.000001", .albedo = {1, 1, 1}},
}};
static const MaterialCase mix_material = {{
    {.parameters = "\"string materials\" [\"grey\" \"red\"] \"float amount\" .25",
     .albedo = {.75 * .5 + .25 * .8, .75 * .5 + .25 * .1, .75 * .5 + .25 * .1},
     .reflected = 1,
     .one_way = true}, /* each ray chooses one of the two */
    {.parameters = "\"string materials\" [\"grey\" \"red\"] \"float amount\" 1",
     .albedo = {.8, .1, .1},
     .reflected = 1},
}};
static const MaterialCase principled_material = {{
    {.parameters = "\"rgb basecolor\" [.9 .5 .2] \"float metallic\" 0 \"float roughness\" .5",
     .reflected = 1},
    {.parameters = "\"rgb basecolor\" [.9 .5 .2] \"float metallic\" 1 \"float roughness\" .7 "
                   "\"float anisotropy\" .5",
     .reflected = 1},
    {.parameters = "\"float metallic\" 0 \"float roughness\" .6 \"float clearcoat\" 1 \"float "
                   "clearcoatroughness\" .5 "
                   "\"rgb sheencolor\" [.5 .3 .2] \"float sheenroughness\" .4",
     .reflected = 1,
     .one_way = true},
    {.parameters =
         "\"float metallic\" 0 \"float roughness\" .6 \"float transmission\" .7 \"bool "
         "thinwalled\" true",
     .one_way = true},
    {.parameters =
         "\"float metallic\" 0 \"float roughness\" .6 \"float diffusetransmission\" .5 \"rgb "
         "diffusetransmissioncolor\" [.3 .5 .9]",
     .one_way = true},
}};
static const MaterialCase diffuse_transmission_material = {{
    {.parameters = "\"rgb reflectance\" [.3 .4 .1] \"rgb transmittance\" [.5 .2 .6]",
     .albedo = {.8, .6, .7},
     .both_sides = true},
    {.parameters = "\"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]",
     .albedo = {1, 1, 1},
     .both_sides = true},
    {.parameters =
         "\"rgb reflectance\" [.2 .2 .2] \"rgb transmittance\" [.4 .4 .4] \"float scale\" .5",
     .albedo = {.3, .3, .3},
     .reflected = 1.0 / 3,
     .both_sides = true},
}};
static const MaterialCase coated_conductor_material = {{
    {.parameters = "", .reflected = 1},
    {.parameters = "\"float conductor.roughness\" .3 \"float interface.roughness\" .1",
     .reflected = 1,
     .walks = true},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float conductor.roughness\" .5 \"float "
                   "interface.roughness\" .4",
     .reflected = 1,
     .walks = true},
}};
static const MaterialCase hair_material = {{
    {.parameters = "", .one_way = true},
    {.parameters = "\"rgb reflectance\" [.8 .5 .3] \"float beta_m\" .6 \"float beta_n\" .7",
     .one_way = true},
}};
static const MaterialCase measured_material = {{
    {.parameters = "\"string filename\" \"a.bsdf\"",
     .reflected = 1,
     .one_way = true}, /* a table of one direction */
}};
static const MaterialCase subsurface_material = {{
    {.parameters = "\"float roughness\" 0", .refracts = true},
    {.parameters = "\"float roughness\" .3", .refracts = true},
}};
static const MaterialCase interface_material = {{{.parameters = ""}}};

#define MATERIAL_CASE(NAME, name) &name##_material,
static const MaterialCase *const material_cases[] = {VL_MATERIAL_KINDS(MATERIAL_CASE)};

/* ---- asking
 * ------------------------------------------------------------------------------------------------------
 */

/* Directions of the eye: angles from the normal; those above pi / 2 are below the square. */
static const double material_angles[] = {0.2, 1.1, PI - 0.6};
enum { MATERIAL_ANGLES = 3 };

typedef struct MaterialLaws {
  const char *kind;
  const MaterialVariant *variant;
  double angle;
  vlTraceRays *rays, *back;
  vlTraceHits *hits;
  vlTraceBounce *next;
  Mean weight[3],
      value[3]; /* the mean weight of samples with a density; the integral of the BSDF */
  Mean all[3],
      stays; /* the mean weight of all samples; the share of it that stays on the eye's side */
  Mean density, has_density;
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
    mean_add(&m->has_density, dense);
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
    if (fabs(w[2]) < 0.02 || (!m->variant->both_sides && w[2] * eye[2] < 0))
      continue;
    m->both_ways++;
    m->unequal +=
        !close_to((double)there[1][i] * fabs(eye[2]), (double)back[1][i] * fabs(w[2]), 0.01);
  }
}

static void ask_material(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  MaterialLaws *m = probe->user;
  double eye[3];
  eye_direction(m->angle, eye);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    rays_towards(m->rays, i, eye);
  vl_world_trace(trace, m->rays, m->hits);
  assert_true(isfinite(m->hits->t[0]));
  ask_samples(m, trace, eye[2] > 0);
  ask_integrals(m, trace, probe->batch);
  if (!m->variant->one_way && !m->variant->refracts && !m->variant->walks)
    ask_reciprocity(m, trace, probe->batch, eye);
}

/* ---- the laws
 * ----------------------------------------------------------------------------------------------------
 */

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
  if (!mean_agrees(&m->density, &m->has_density, 0.01))
    broken("materials", m->kind,
           "%s, %.1f: the density integrates to %.4f, %.4f of the samples have one", p, a,
           mean_of(&m->density), mean_of(&m->has_density));
  for (int c = 0; c < 3; c++) {
    if (!mean_agrees(&m->value[c], &m->weight[c], 0.01))
      broken("materials", m->kind,
             "%s, %.1f: channel %d integrates to %.4f, the mean weight is %.4f", p, a, c,
             mean_of(&m->value[c]), mean_of(&m->weight[c]));
    double more = mean_of(&m->all[c]) - 1 - 5 * sqrt(variance_of_mean(&m->all[c]));
    if (!v->refracts && !(more < 1e-3))
      broken("materials", m->kind, "%s, %.1f: channel %d sends %.4f of the light", p, a, c,
             mean_of(&m->all[c]));
    if (v->albedo[c] > 0 && a == material_angles[0] && !mean_is(&m->all[c], v->albedo[c], 2e-3))
      broken("materials", m->kind, "%s, %.1f: channel %d sends %.4f of the light, not %.4f", p,
             a, c, mean_of(&m->all[c]), v->albedo[c]);
  }
  double all = (mean_of(&m->all[0]) + mean_of(&m->all[1]) + mean_of(&m->all[2])) / 3;
  if (v->reflected > 0 && a == material_angles[0] &&
      !mean_is(&m->stays, v->reflected * all, 2e-3))
    broken("materials", m->kind, "%s, %.1f: %.4f of the light is reflected, not %.4f", p, a,
           mean_of(&m->stays) / all, v->reflected);
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
    probe_world(text, &probe, 16);
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
  eye_direction(material_angles[0], eye);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    rays_towards(m->rays, i, eye);
  vl_world_trace(trace, m->rays, m->hits);
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
