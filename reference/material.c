/* material.c: diffuse surfaces, metals, glass, interfaces and mixtures. */
#include "material.h"

#include <stdlib.h>

#include "refuse.h"
#include "texture.h"

/* An RGB render has one index of refraction: that of catalogues, at the yellow line of sodium. */
enum { SODIUM_NM = 589 };

static bool is_supported(const vlMaterialDef *def, vlError *error) {
  switch (def->kind) {
    case VL_MATERIAL_DIFFUSE:
    case VL_MATERIAL_CONDUCTOR:
    case VL_MATERIAL_DIELECTRIC:
    case VL_MATERIAL_COATED_DIFFUSE:
    case VL_MATERIAL_MIX:
    case VL_MATERIAL_INTERFACE: break;
    default: return refuse_kind(error, def->source, "materials", (uint32_t)def->kind);
  }
  if (def->displacement.texture.index || def->displacement.value != 0)
    return refuse(error, def->source, "a bump map", NULL);
  if (def->normal_map) return refuse(error, def->source, "a normal map", NULL);
  bool coated = def->kind == VL_MATERIAL_COATED_DIFFUSE;
  vlSpectrum albedo = def->albedo.value;
  bool clear = !def->albedo.texture.index && albedo.value == 0 && albedo.kind == VL_SPECTRUM_CONSTANT;
  if (coated && !clear) return refuse(error, def->source, "a coat that scatters light", NULL);
  if (coated && def->conserve_energy) return refuse(error, def->source, "a coat that conserves energy", NULL);
  return true;
}

static bool read_material(const vlMaterialDef *def, material *m, vlError *error) {
  if (!is_supported(def, error)) return false;
  m->def = *def;
  if (!read_color(&def->reflectance.value, VL_PARAMETER_ALBEDO, &m->reflectance, error)) return false;
  if (!read_color(&def->eta.value, VL_PARAMETER_UNBOUNDED, &m->eta, error)) return false;
  if (!read_color(&def->k.value, VL_PARAMETER_UNBOUNDED, &m->k, error)) return false;
  for (int i = 1; i < VL_SPECTRUM_VALUES; i++) m->disperses = m->disperses || m->eta.nm[i] != m->eta.nm[0];
  return true;
}

/* materials[0] is the material of shapes without one. */
bool read_materials(world *w, vlError *error) {
  while (vl_scene_material(w->scene, (vlMaterialId){w->material_count + 1})) w->material_count++;
  w->materials = calloc(w->material_count + 1, sizeof *w->materials);
  if (!w->materials) return refuse_memory(error);
  vlMaterialDef standard = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  if (!read_material(&standard, &w->materials[0], error)) return false;
  for (uint32_t i = 1; i <= w->material_count; i++) {
    if (!read_material(vl_scene_material(w->scene, (vlMaterialId){i}), &w->materials[i], error)) return false;
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
static double alpha_of(const world *w, const material *m, vlFloatInput roughness, const shade_record *at) {
  double r = number_at(w, roughness, at);
  return m->def.remap_roughness ? sqrt(fmax(0, r)) : r;
}

/* A metal of a given reflectance r at normal incidence: eta = 1, k = 2 sqrt(r / (1 - r)). */
static void metal_of_reflectance(spectrum r, bsdf *b) {
  b->eta = gray(1);
  for (int i = 0; i < CHANNELS; i++) {
    double share = clamp(r.c[i], 0, 0.9999);
    b->k.c[i] = 2 * sqrt(share) / sqrt(1 - share);
  }
}

bsdf make_bsdf(const world *w, const material *m, const shade_record *at, wavelengths *lambda) {
  const vlMaterialDef *def = &m->def;
  bsdf b = {.frame = make_frame(at->shading_normal, at->tangent)};
  bool coated = def->kind == VL_MATERIAL_COATED_DIFFUSE;
  if (def->kind == VL_MATERIAL_DIFFUSE || coated) {
    b.kind = coated ? BSDF_COATED_DIFFUSE : BSDF_DIFFUSE;
    b.reflectance = spectrum_at(w, def->reflectance, &m->reflectance, VL_PARAMETER_ALBEDO, at, lambda);
    for (int i = 0; i < CHANNELS; i++) b.reflectance.c[i] = clamp(b.reflectance.c[i], 0, 1);
    if (!coated) return b;
  }
  b.alpha_x = alpha_of(w, m, def->u_roughness, at);
  b.alpha_y = alpha_of(w, m, def->v_roughness, at);
  if (coated) {
    b.ior = (double)m->eta.nm[SODIUM_NM - VL_SPECTRUM_FIRST_NM];
    b.coat_thickness = number_at(w, def->thickness, at);
    b.coat_depth = def->max_depth;
    return b;
  }
  if (def->kind == VL_MATERIAL_DIELECTRIC) {
    b.kind = BSDF_DIELECTRIC;
    if (m->disperses) keep_first_wavelength(lambda);
    b.ior = lambda->rgb ? (double)m->eta.nm[SODIUM_NM - VL_SPECTRUM_FIRST_NM] : color_at(&m->eta, lambda).c[0];
    if (b.ior == 0) b.ior = 1;
    return b;
  }
  b.kind = BSDF_CONDUCTOR;
  if (def->use_reflectance) {
    metal_of_reflectance(spectrum_at(w, def->reflectance, &m->reflectance, VL_PARAMETER_ALBEDO, at, lambda), &b);
  } else {
    b.eta = spectrum_at(w, def->eta, &m->eta, VL_PARAMETER_UNBOUNDED, at, lambda);
    b.k = spectrum_at(w, def->k, &m->k, VL_PARAMETER_UNBOUNDED, at, lambda);
  }
  return b;
}
