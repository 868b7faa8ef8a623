/* material.c: diffuse surfaces, metals, glass, interfaces and mixtures. */
#include "material.h"

#include "more/more.h"
#include "refuse.h"
#include "texture.h"

static bool read_material(const world *w, const vlMaterialDef *def, material *m, vlError *error) {
  *m = (material){.def = *def};
  if (!read_color(&def->reflectance.value, VL_PARAMETER_ALBEDO, &m->reflectance, error)) return false;
  if (!read_color(&def->eta.value, VL_PARAMETER_UNBOUNDED, &m->eta, error)) return false;
  if (!read_color(&def->k.value, VL_PARAMETER_UNBOUNDED, &m->k, error)) return false;
  for (int i = 1; i < VL_SPECTRUM_VALUES; i++) m->disperses = m->disperses || m->eta.nm[i] != m->eta.nm[0];
  return read_more_material(w, m, error);
}

/* materials[0] is the material of shapes without one. */
bool read_materials(world *w, vlError *error) {
  vlMaterialDef standard = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  const vlMaterialDef *def = &standard;
  for (; def; def = vl_scene_material(w->scene, (vlMaterialId){w->material_count})) {
    w->materials = resize(w->materials, w->material_count + 1, sizeof *w->materials);
    if (!read_material(w, def, &w->materials[w->material_count++], error)) return false;
  }
  return true;
}

const material *material_at(const world *w, const shade_record *at, sampler *s) {
  const material *m = &w->materials[at->where->def->material.index];
  while (m->def.kind == VL_MATERIAL_MIX) {
    double share = number_at(w, m->def.amount, at);
    int second = next_number(s) < share;
    m = &w->materials[m->def.materials[second].index];
  }
  return m;
}

bool is_interface(const material *m) {
  return m->def.kind == VL_MATERIAL_INTERFACE;
}

/* The roughness of files is perceptual; alpha, the slope of the mirrors, is its root (pbrt book 9.6). */
double alpha_at(const world *w, const material *m, vlFloatInput roughness, const shade_record *at) {
  double r = number_at(w, roughness, at);
  return m->def.remap_roughness ? sqrt(fmax(0, r)) : r;
}

spectrum reflectance_at(const world *w, const material *m, const shade_record *at, const wavelengths *lambda) {
  spectrum r = spectrum_at(w, m->def.reflectance, &m->reflectance, VL_PARAMETER_ALBEDO, at, lambda);
  for (int i = 0; i < CHANNELS; i++) r.c[i] = clamp(r.c[i], 0, 1);
  return r;
}

double ior_of(const color *eta, const wavelengths *lambda) {
  wavelengths sodium = {.nm = {589, 589, 589, 589}};
  double ior = color_at(eta, lambda->rgb ? &sodium : lambda).c[0];
  return ior == 0 ? 1 : ior;
}

/* A metal's index of refraction; for a metal of a given reflectance r at normal incidence eta = 1,
 * k = 2 sqrt(r / (1 - r)). */
static void make_metal(const world *w, const material *m, const shade_record *at, const wavelengths *lambda, bsdf *b) {
  b->eta = gray(1);
  if (!m->def.use_reflectance) {
    b->eta = spectrum_at(w, m->def.eta, &m->eta, VL_PARAMETER_UNBOUNDED, at, lambda);
    b->k = spectrum_at(w, m->def.k, &m->k, VL_PARAMETER_UNBOUNDED, at, lambda);
    return;
  }
  spectrum r = reflectance_at(w, m, at, lambda);
  for (int i = 0; i < CHANNELS; i++) {
    double share = fmin(r.c[i], 0.9999);
    b->k.c[i] = 2 * sqrt(share / (1 - share));
  }
}

bsdf make_bsdf(const world *w, const material *m, const shade_record *at, wavelengths *lambda) {
  shade_record bent = *at;
  bend_normal(w, m, &bent);
  bsdf b = {.frame = make_frame(bent.shading_normal, bent.tangent)};
  b.alpha_x = alpha_at(w, m, m->def.u_roughness, at);
  b.alpha_y = alpha_at(w, m, m->def.v_roughness, at);
  switch (m->def.kind) {
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
      if (m->disperses) keep_first_wavelength(lambda);
      b.ior = ior_of(&m->eta, lambda);
      break;
    default: b.kind = BSDF_MORE; more_bsdf_at(w, m, at, lambda, &b);
  }
  return b;
}
