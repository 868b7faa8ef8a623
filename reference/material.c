/* material.c: diffuse surfaces, metals, glass, interfaces and mixtures. */
#include "more/more.h"

const vlMaterialDef *material_at(const world *w, const shade_record *at, sampler *s) {
  const vlMaterialDef *m = vl_scene_material(w->scene, at->where->def->material);
  while (m && m->kind == VL_MATERIAL_MIX) {
    int second = next_number(s) < number_at(w, m->amount, at);
    m = vl_scene_material(w->scene, m->materials[second]);
  }
  return m ? m : &w->standard_material;
}

/* alpha is the slope of the small mirrors (pbrt book 9.6), or the root of a roughness that looks even from 0 to 1. */
double alpha_at(const world *w, const vlMaterialDef *m, vlFloatInput roughness, const shade_record *at) {
  double r = number_at(w, roughness, at);
  return m->remap_roughness ? sqrt(fmax(0, r)) : r;
}

spectrum reflectance_at(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda) {
  spectrum r = spectrum_at(w, &m->reflectance, VL_PARAMETER_ALBEDO, at, lambda);
  for (int i = 0; i < CHANNELS; i++) r.c[i] = clamp(r.c[i], 0, 1);
  return r;
}

double ior_of(const vlSpectrumInput *eta, const wavelengths *lambda) {
  static const wavelengths sodium = {.nm = {589}};
  double ior = color_at(find_color(&eta->value, VL_PARAMETER_UNBOUNDED), lambda->rgb ? &sodium : lambda).c[0];
  return ior == 0 ? 1 : ior; /* 0: it is not given */
}

/* A metal's index of refraction, or that of a metal of reflectance r at normal incidence: eta = 1,
 * k = 2 sqrt(r / (1 - r)). */
void make_metal(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda, bsdf *b) {
  spectrum r = reflectance_at(w, m, at, lambda);
  for (int i = 0; i < CHANNELS; i++) b->k.c[i] = 2 * sqrt(fmin(r.c[i], 0.9999) / (1 - fmin(r.c[i], 0.9999)));
  b->eta = gray(1);
  if (m->use_reflectance) return;
  b->eta = spectrum_at(w, &m->eta, VL_PARAMETER_UNBOUNDED, at, lambda);
  b->k = spectrum_at(w, &m->k, VL_PARAMETER_UNBOUNDED, at, lambda);
}

bsdf make_bsdf(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda) {
  shade_record bent = *at;
  bend_normal(w, m, &bent);
  bsdf b = {.kind = BSDF_MORE, .frame = make_frame(bent.shading_normal, bent.tangent)};
  b.alpha_x = alpha_at(w, m, m->u_roughness, at);
  b.alpha_y = alpha_at(w, m, m->v_roughness, at);
  switch (m->kind) {
    case VL_MATERIAL_DIFFUSE:
      b.kind = BSDF_DIFFUSE;
      b.reflectance = reflectance_at(w, m, at, lambda);
      break;
    case VL_MATERIAL_CONDUCTOR:
      b.kind = BSDF_CONDUCTOR;
      make_metal(w, m, at, lambda, &b);
      break;
    case VL_MATERIAL_DIELECTRIC:
      b.kind = BSDF_DIELECTRIC;
      if (find_color(&m->eta.value, VL_PARAMETER_UNBOUNDED)->varies) keep_first_wavelength(lambda);
      b.ior = ior_of(&m->eta, lambda);
      break;
    default: more_bsdf_at(w, m, at, lambda, &b);
  }
  return b;
}
