/* more/materials.c: the materials of more/, by kind. */
#include "coated.h"
#include "more.h"
#include "texture.h"

void more_bsdf_at(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda, bsdf *b) {
  b->reflectance = reflectance_at(w, m, at, lambda);
  wavelengths rgb = {.rgb = true};
  b->ior = ior_of(w, &m->eta, &rgb);
  b->more.coat_thickness = number_at(w, m->thickness, at);
  b->more.coat_depth = m->max_depth;
}

spectrum more_bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  return coated_value(b, wo, wi, s, density);
}

bool sample_more_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  return sample_coated(b, wo, s, result);
}

void bend_normal(const world *w, const vlMaterialDef *m, shade_record *at) {
  (void)w;
  (void)m;
  (void)at;
}
