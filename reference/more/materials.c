/* more/materials.c: the materials of more/, by kind. */
#include "bsdfs.h"
#include "more.h"
#include "texture.h"

/* ---- hair -------------------------------------------------------------------------------------------------------- */

/* The absorption of the two pigments: pbrt book 9.9.7. */
static const vlSpectrum eumelanin = {.kind = VL_SPECTRUM_RGB, .scale = 1, .rgb = {0.419f, 0.697f, 1.37f}};
static const vlSpectrum pheomelanin = {.kind = VL_SPECTRUM_RGB, .scale = 1, .rgb = {0.187f, 0.4f, 1.05f}};

static spectrum pigment(const world *w, vlFloatInput amount, const vlSpectrum *one, const shade_record *at,
                        const wavelengths *lambda) {
  spectrum absorption = color_at(find_color(w->colors, one, VL_PARAMETER_UNBOUNDED), lambda);
  return scaled(fmax(0, number_at(w, amount, at)), absorption);
}

static spectrum hair_absorption(const world *w, const vlMaterialDef *m, const shade_record *at, double beta_n,
                                const wavelengths *lambda) {
  const vlHairDef *hair = &m->hair;
  if (hair->color == VL_HAIR_SIGMA_A) return spectrum_at(w, &hair->sigma_a, VL_PARAMETER_UNBOUNDED, at, lambda);
  if (hair->color == VL_HAIR_REFLECTANCE) return absorption_of_hair_color(reflectance_at(w, m, at, lambda), beta_n);
  return plus(pigment(w, hair->eumelanin, &eumelanin, at, lambda),
              pigment(w, hair->pheomelanin, &pheomelanin, at, lambda));
}

static void make_hair(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                      bsdf *b) {
  const vlHairDef *hair = &m->hair;
  b->more.kind = MORE_HAIR;
  b->more.offset = 2 * at->v - 1;
  b->ior = clamp(number_at(w, hair->eta, at), 1.0001, 10);
  b->more.beta_m = clamp(number_at(w, hair->beta_m, at), 0, 1);
  b->more.beta_n = clamp(number_at(w, hair->beta_n, at), 0, 1);
  b->more.tilt = number_at(w, hair->alpha, at) * PI / 180;
  b->more.absorption = hair_absorption(w, m, at, b->more.beta_n, lambda);
}

/* ---- all kinds --------------------------------------------------------------------------------------------------- */

void more_bsdf_at(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda, bsdf *b) {
  if (m->kind == VL_MATERIAL_HAIR) {
    make_hair(w, m, at, lambda, b);
    return;
  }
  b->more.kind = MORE_COATED;
  b->reflectance = reflectance_at(w, m, at, lambda);
  wavelengths rgb = {.rgb = true};
  b->ior = ior_of(w, &m->eta, &rgb);
  b->more.coat_thickness = number_at(w, m->thickness, at);
  b->more.coat_depth = m->max_depth;
}

spectrum more_bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  switch (b->more.kind) {
    case MORE_HAIR: return hair_value(b, wo, wi, density);
    default: return coated_value(b, wo, wi, s, density);
  }
}

bool sample_more_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  switch (b->more.kind) {
    case MORE_HAIR: sample_hair(b, wo, s, result); return true;
    default: return sample_coated(b, wo, s, result);
  }
}

void bend_normal(const world *w, const vlMaterialDef *m, shade_record *at) {
  (void)w;
  (void)m;
  (void)at;
}
