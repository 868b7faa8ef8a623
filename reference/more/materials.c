/* more/materials.c: the materials of more/, by kind. */
#include "coated.h"
#include "more.h"
#include "refuse.h"
#include "texture.h"

bool read_more_material(const world *w, material *m, vlError *error) {
  const vlMaterialDef *def = &m->def;
  (void)w;
  if (def->displacement.texture.index || def->displacement.value != 0) return refuse(error, def->source, "a bump map");
  if (def->normal_map) return refuse(error, def->source, "a normal map");
  switch (def->kind) {
    case VL_MATERIAL_DIFFUSE:
    case VL_MATERIAL_CONDUCTOR:
    case VL_MATERIAL_DIELECTRIC:
    case VL_MATERIAL_MIX:
    case VL_MATERIAL_INTERFACE: return true;
    case VL_MATERIAL_COATED_DIFFUSE: break;
    default: return refuse_kind(error, def->source, "materials", (uint32_t)def->kind);
  }
  vlSpectrum albedo = def->albedo.value;
  bool clear = !def->albedo.texture.index && albedo.value == 0 && albedo.kind == VL_SPECTRUM_CONSTANT;
  if (!clear) return refuse(error, def->source, "a coat that scatters light");
  if (def->conserve_energy) return refuse(error, def->source, "a coat that conserves energy");
  return true;
}

void more_bsdf_at(const world *w, const material *m, const shade_record *at, wavelengths *lambda, bsdf *b) {
  b->reflectance = reflectance_at(w, m, at, lambda);
  wavelengths rgb = {.rgb = true};
  b->ior = ior_of(&m->eta, &rgb);
  b->more.coat_thickness = number_at(w, m->def.thickness, at);
  b->more.coat_depth = m->def.max_depth;
}

spectrum more_bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  return coated_value(b, wo, wi, s, density);
}

bool sample_more_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  return sample_coated(b, wo, s, result);
}

void bend_normal(const world *w, const material *m, shade_record *at) {
  (void)w;
  (void)m;
  (void)at;
}
