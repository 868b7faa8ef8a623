/* conformance/layers.h: laws of materials that are made of others: mixtures with holes, coats
 * over a base, glass whose index depends on the wavelength. */
#ifndef TEST_CONFORMANCE_LAYERS_H
#define TEST_CONFORMANCE_LAYERS_H

#include "conformance.h"
#include "materials.h"
#include "shading.h"
#include "unit.h"

/* ---- mixtures with holes ----------------------------------------------------------------- */

/* What rays find of a square: holes let them pass. */
typedef struct Found {
  Mean hit, red, hidden;
  vlTraceRays *rays;
  vlTraceHits *hits;
} Found;

static void ask_holes(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  static uint8_t hidden[VL_OWN_BATCH];
  Found *f = probe->user;
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const uint32_t n = i + probe->batch * VL_OWN_BATCH;
    const double from[3] = {1.9 * fmod(0.5 + n * 0.7548776662466927, 1.0) - 0.95,
                            1.9 * fmod(0.5 + n * 0.5698402909980532, 1.0) - 0.95, 1};
    const double down[3] = {0.01, 0.02, -1};
    set_ray(f->rays, i, from, down);
  }
  vl_world_trace(trace, f->rays, f->hits);
  vl_world_occluded(trace, f->rays, hidden);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const bool hit = isfinite(f->hits->t[i]);
    const bool red = f->hits->reflectance[0][i] > 2 * f->hits->reflectance[1][i];
    mean_add(&f->hit, hit);
    mean_add(&f->red, hit && red);
    mean_add(&f->hidden, hidden[i]);
  }
}

/* A mixture of grey and of a mixture of nothing and red. Of the surface the share of grey is
 * there, and of the rest the share of red. */
static void check_holes(const char *materials, double amount, double grey) {
  const double red = 0.3;
  const Sight sight = {.slack = 1e-3, .min = 0.04};
  char text[TEXT];
  Found f = {.rays = new_rays(), .hits = calloc(1, sizeof(vlTraceHits))};
  assert_non_null(f.hits);
  snprintf(text, sizeof text,
           HEAD "WorldBegin LightSource \"infinite\" " NAMED
                "MakeNamedMaterial \"air\" \"string type\" \"interface\"\n"
                "MakeNamedMaterial \"holes\" \"string type\" \"mix\" "
                "\"string materials\" [\"air\" \"red\"] \"float amount\" %g\n"
                "Material \"mix\" \"string materials\" [%s] \"float amount\" %g " SQUARE_UP,
           red, materials, amount);
  Probe probe = {.ask = ask_holes, .user = &f};
  probe_world(text, &probe, 16);
  check_mean("materials", "mix", "holes: rays that hit", &f.hit, grey + (1 - grey) * red,
             sight);
  check_mean("materials", "mix", "holes: rays that hit red", &f.red, (1 - grey) * red, sight);
  check_mean("materials", "mix", "holes: rays that are stopped", &f.hidden,
             grey + (1 - grey) * red, sight);
  free(f.rays);
  free(f.hits);
}

/* ---- coats ------------------------------------------------------------------------------- */

/* The mean weight of a material's samples, of green, from four directions around the normal. */
typedef struct Sent {
  Mean light[4];
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceBounce *next;
} Sent;

static void ask_sent(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Sent *s = probe->user;
  const uint32_t side = probe->batch % 4;
  const double azimuth = 0.3 + 0.5 * PI * side;
  const double eye[3] = {sin(0.9) * cos(azimuth), sin(0.9) * sin(azimuth), cos(0.9)};
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    rays_towards(s->rays, i, eye);
  vl_world_trace(trace, s->rays, s->hits);
  vl_trace_bounce(trace, 0, s->next);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    mean_add(&s->light[side], (double)s->next->weight[1][i]);
}

/* Of the last material of a text, on the square. */
static Sent *light_sent(const char *materials, uint32_t batches) {
  char text[TEXT];
  Sent *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->rays = new_rays();
  s->hits = calloc(1, sizeof *s->hits);
  s->next = calloc(1, sizeof *s->next);
  snprintf(text, sizeof text, HEAD "WorldBegin LightSource \"infinite\" %s " SQUARE_UP,
           materials);
  Probe probe = {.ask = ask_sent, .user = s};
  probe_world(text, &probe, batches);
  return s;
}

static void free_sent(Sent *s) {
  free(s->rays);
  free(s->hits);
  free(s->next);
  free(s);
}

/* A coat over a diffuse base, with further parameters. */
#define COATED "Material \"coateddiffuse\" \"rgb reflectance\" [.9 .9 .9] "
/* What scatters so little that its light does not count, but is followed step by step (pbrt
 * book 14.3), not looked up in the table of a coat. */
#define WALKS " \"rgb albedo\" [1e-6 1e-6 1e-6]"

/* Another square with the material so far, which no ray meets. */
#define ELSEWHERE "Translate 0 0 -9 " SQUARE_UP "Translate 0 0 9 "

/* Two descriptions of one coat. */
static const struct {
  const char *name, *looked_up, *other;
} coats[] = {
    {"smooth, by walks", COATED "\"float roughness\" 0", COATED "\"float roughness\" 0" WALKS},
    {"rough, by walks", COATED "\"float roughness\" .2", COATED "\"float roughness\" .2" WALKS},
    {"few bounces, by walks", COATED "\"float roughness\" .2 \"integer maxdepth\" 3",
     COATED "\"float roughness\" .2 \"integer maxdepth\" 3" WALKS},
    {"many bounces, by walks", COATED "\"float roughness\" .2 \"integer maxdepth\" 15",
     COATED "\"float roughness\" .2 \"integer maxdepth\" 15" WALKS},
    {"rough along u, by walks", COATED "\"float uroughness\" .6 \"float vroughness\" .01",
     COATED "\"float uroughness\" .6 \"float vroughness\" .01" WALKS},
    {"rough along v, by walks", COATED "\"float uroughness\" .01 \"float vroughness\" .6",
     COATED "\"float uroughness\" .01 \"float vroughness\" .6" WALKS},
    /* coats of one world share tables, but not with those that differ */
    {"beside one of other axes",
     COATED "\"float uroughness\" .6 \"float vroughness\" .01 " ELSEWHERE COATED
            "\"float uroughness\" .01 \"float vroughness\" .6",
     COATED "\"float uroughness\" .01 \"float vroughness\" .6"},
    {"beside one of more bounces",
     COATED "\"float roughness\" .2 " ELSEWHERE COATED
            "\"float roughness\" .2 \"integer maxdepth\" 1",
     COATED "\"float roughness\" .2 \"integer maxdepth\" 1"},
};

static void check_coats(void) {
  for (size_t i = 0; i < sizeof coats / sizeof *coats; i++) {
    Sent *a = light_sent(coats[i].looked_up, 96);
    Sent *b = light_sent(coats[i].other, 96);
    for (int side = 0; side < 4; side++) {
      char what[100];
      snprintf(what, sizeof what, "a coat %s: light that is sent to side %d", coats[i].name,
               side);
      check_same_mean("materials", "coateddiffuse", what, &a->light[side], &b->light[side],
                      (Sight){.slack = 4e-3, .min = 0.03});
    }
    free_sent(a);
    free_sent(b);
  }
}

/* The integral of green over all directions. */
static double integral_of(const char *material) {
  char text[TEXT];
  double sum = 0;
  snprintf(
      text, sizeof text,
      HEAD
      "WorldBegin LightSource \"infinite\" Texture \"rising\" \"float\" \"bilerp\" "
      "\"float v00\" .05 \"float v10\" .05 \"float v01\" .3 \"float v11\" .3\n%s " SQUARE_UP,
      material);
  Scattering *s = scattering_of(need_scene(text), text);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    sum += (double)s->value[1][i] * 4 * PI / VL_OWN_BATCH;
  free_scattering(s);
  return sum;
}

/* A textured roughness is that number: the square is hit where v is .6 and the texture .2. The
 * table of coats of any roughness is interpolated, which adds .2 %. */
static void check_textured_coat(void) {
  double textured = integral_of(COATED "\"texture roughness\" \"rising\"");
  double plain = integral_of(COATED "\"float roughness\" .2");
  if (!(fabs(textured / plain - 1) < 3e-3))
    broken("materials", "coateddiffuse",
           "a textured roughness sends %.4f of the light, not %.4f", textured, plain);
}

/* A mirror that reflects green alone, below a medium of thickness d that absorbs: e^(-2 d /
 * cos) is left. No other colour tells that there is a mirror. */
static void check_green_mirror(void) {
  Sent *s = light_sent(
      "Material \"coatedconductor\" \"rgb reflectance\" [0 1 0] "
      "\"float conductor.roughness\" 0 \"float interface.roughness\" 0 "
      "\"float interface.eta\" 1 \"float thickness\" .1 "
      "\"rgb albedo\" [.001 .001 .001]",
      16);
  for (int side = 0; side < 4; side++)
    check_mean("materials", "coatedconductor", "a green mirror: light that is sent",
               &s->light[side], exp(-0.2 / cos(0.9)), (Sight){.slack = 4e-3, .min = 0.05});
  free_sent(s);
}

/* ---- by wavelengths ---------------------------------------------------------------------- */

typedef struct Wavelengths {
  Mean off[8];          /* of bands of wavelengths: what is reflected beyond the known */
  double x[2][2], y[2]; /* sums of the regression of the index on 1 / lambda^2 */
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceBounce *next;
} Wavelengths;

enum { BANDS = 8 };
#define FILM_ANGLE 0.6
#define GLASS_ANGLE 1.1
#define FILM_INDEX 1.9
#define FILM_NM 320.0
#define BASE_INDEX 1.5

static void bounce_from(Wavelengths *w, vlTrace *trace, double angle) {
  double eye[3];
  eye_direction(angle, eye);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    rays_towards(w->rays, i, eye);
  vl_world_trace(trace, w->rays, w->hits);
  vl_trace_bounce(trace, 0, w->next);
}

/* Fresnel's amplitude of reflection at an interface, of one polarisation; c: cosines. */
static double amplitude(bool s, double n1, double c1, double n2, double c2) {
  return s ? (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
           : (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
}

/* The reflectance of a film in air on glass (Born and Wolf, "Principles of Optics", 7.6): of
 * the amplitudes a and b of its two sides and the phase p between them it is |a + b e^ip|^2 /
 * |1 + a b e^ip|^2. */
static double film_reflectance(double lambda) {
  const double c1 = cos(FILM_ANGLE);
  const double c2 = sqrt(1 - pow(sin(FILM_ANGLE) / FILM_INDEX, 2));
  const double c3 = sqrt(1 - pow(sin(FILM_ANGLE) / BASE_INDEX, 2));
  const double phase = 4 * PI * FILM_INDEX * FILM_NM * c2 / lambda;
  double sum = 0;
  for (int s = 0; s < 2; s++) {
    const double a = amplitude(s, 1, c1, FILM_INDEX, c2);
    const double b = amplitude(s, FILM_INDEX, c2, BASE_INDEX, c3);
    const double up = pow(a + b * cos(phase), 2) + pow(b * sin(phase), 2);
    const double down = pow(1 + a * b * cos(phase), 2) + pow(a * b * sin(phase), 2);
    sum += 0.5 * up / down;
  }
  return sum;
}

static void ask_film(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Wavelengths *w = probe->user;
  bounce_from(w, trace, FILM_ANGLE);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int c = 0; c < 4; c++) {
      const double lambda = (double)paths->lambda[c][i];
      const int band = (int)((lambda - 400) / 40);
      if (lambda >= 400 && band < BANDS)
        mean_add(&w->off[band], (double)w->next->weight[c][i] - film_reflectance(lambda));
    }
}

/* The index by which the ray was refracted, against 1 / lambda^2 (Cauchy's law). */
static void ask_glass(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Wavelengths *w = probe->user;
  bounce_from(w, trace, GLASS_ANGLE);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double across =
        hypot((double)w->next->rays.direction[0][i], (double)w->next->rays.direction[1][i]);
    if (!(w->next->weight[0][i] > 0 && w->next->rays.direction[2][i] < 0))
      continue;
    const double index = sin(GLASS_ANGLE) / across;
    const double row[2] = {1, 1e5 / pow((double)paths->lambda[0][i], 2)};
    for (int k = 0; k < 2; k++) {
      w->y[k] += row[k] * index;
      for (int j = 0; j < 2; j++)
        w->x[k][j] += row[k] * row[j];
    }
  }
}

/* The square with a principled material, in wavelengths. */
static Wavelengths ask_wavelengths(const vlMaterialDef *def,
                                   void (*ask)(Probe *, vlTrace *, const vlOwnPaths *)) {
  Wavelengths w = {.rays = new_rays(),
                   .hits = calloc(1, sizeof(vlTraceHits)),
                   .next = calloc(1, sizeof(vlTraceBounce))};
  Probe probe = {.ask = ask, .user = &w, .spectral = true};
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  add_square(scene, def);
  probe_scene(scene, "a material of one's own", &probe, 32);
  free(w.rays);
  free(w.hits);
  free(w.next);
  return w;
}

static void check_film(void) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  def.reflectance = vl_spectrum_input(vl_spectrum_constant(0.0f));
  def.principled.metallic.value = 0;
  def.principled.roughness.value = 0;
  def.principled.iridescence.value = 1;
  def.principled.iridescence_ior = (float)FILM_INDEX;
  def.principled.iridescence_thickness.value = (float)FILM_NM;
  const Wavelengths w = ask_wavelengths(&def, ask_film);
  for (int k = 0; k < BANDS; k++) {
    char what[80];
    snprintf(what, sizeof what, "a thin film at %d nm, beyond its reflectance", 420 + 40 * k);
    check_mean("materials", "principled", what, &w.off[k], 0,
               (Sight){.slack = 3e-3, .min = 0.02});
  }
}

/* glTF's KHR_materials_dispersion: 20 over the Abbe number, (n_d - 1) / (n_F - n_C), at the
 * lines d, F and C of helium and hydrogen. */
static void check_dispersion(double dispersion, double index) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  def.principled.metallic.value = 0;
  def.principled.roughness.value = 0;
  def.principled.transmission.value = 1;
  def.principled.thin_walled = false;
  def.principled.dispersion = (float)dispersion;
  def.eta.value = vl_spectrum_constant((float)index);
  const Wavelengths w = ask_wavelengths(&def, ask_glass);
  const double det = w.x[0][0] * w.x[1][1] - w.x[0][1] * w.x[1][0];
  const double a = (w.y[0] * w.x[1][1] - w.y[1] * w.x[0][1]) / det;
  const double b = 1e5 * (w.y[1] * w.x[0][0] - w.y[0] * w.x[1][0]) / det;
  const double d = a + b / pow(587.56, 2);
  const double abbe = (d - 1) / (b / pow(486.13, 2) - b / pow(656.27, 2));
  if (!(fabs(d - index) < 2e-3 && fabs(abbe * dispersion / 20 - 1) < 0.05))
    broken("materials", "principled",
           "dispersion %g: index %.4f and Abbe number %.3f, not %.1f and %.3f", dispersion, d,
           abbe, index, 20 / dispersion);
}

/* ---- white ------------------------------------------------------------------------------- */

/* Layers that absorb nothing over what absorbs nothing send all light back. */
static const char *const whites[] = {
    "\"float metallic\" 0 \"float roughness\" .5",
    "\"float metallic\" 0 \"float roughness\" .5 \"float specular\" 0 "
    "\"float clearcoat\" 1 \"float clearcoatroughness\" .5",
    "\"float metallic\" 0 \"float roughness\" .5 \"float specular\" 0 \"float clearcoat\" 1",
    "\"float metallic\" 0 \"float roughness\" .5 \"float specular\" 0 \"rgb sheencolor\" [1 1 1] "
    "\"float sheenroughness\" .5",
    /* the strongest channel alone */
    "\"float metallic\" 0 \"float roughness\" .5 \"float specular\" 0 "
    "\"rgb sheencolor\" [0 1 0] \"float sheenroughness\" .5",
    "\"float metallic\" 0 \"float roughness\" .5 \"float specular\" 0 "
    "\"rgb sheencolor\" [0 1 0] \"float sheenroughness\" 1",
    "\"float metallic\" 1 \"float roughness\" .6",
};

static void check_whites(void) {
  for (size_t i = 0; i < sizeof whites / sizeof *whites; i++) {
    char material[400];
    snprintf(material, sizeof material, "Material \"principled\" \"rgb basecolor\" [1 1 1] %s",
             whites[i]);
    Sent *s = light_sent(material, 64);
    char what[300];
    snprintf(what, sizeof what, "white, %s: light that is sent", whites[i]);
    for (int side = 0; side < 4; side++)
      check_mean("materials", "principled", what, &s->light[side], 1,
                 (Sight){.slack = 5e-3, .min = 0.03});
    free_sent(s);
  }
}

static void laws_of_layers(void **state) {
  (void)state;
  check_holes("\"grey\" \"holes\"", 0.6, 0.4);
  check_holes("\"holes\" \"grey\"", 0.4, 0.4);
  check_coats();
  check_textured_coat();
  check_green_mirror();
  check_film();
  check_dispersion(1, BASE_INDEX);
  check_dispersion(2, 1.9);
  check_whites();
  expect_no_failures();
}

#endif
