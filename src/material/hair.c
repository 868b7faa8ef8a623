/* material/hair.c: inputs of the hair material. */
#include "base/text.h"
#include "material/compile.h"

static vlResult compile_color(const vlMaterialBuild *b, vlWorldHair *h) {
  const vlHairDef *d = &b->def->hair;
  /* absorption of each pigment per unit of concentration (d'Eon, Francois, Hill, Letteri, Aubry
   * 2011) */
  const vlSpectrumInput eu = vl_spectrum_input(vl_spectrum_rgb(0.419f, 0.697f, 1.37f));
  const vlSpectrumInput pheo = vl_spectrum_input(vl_spectrum_rgb(0.187f, 0.4f, 1.05f));
  switch (d->color) {
    case VL_HAIR_SIGMA_A:
      return vl_material_spectrum(b, &d->sigma_a, &h->sigma_a);
    case VL_HAIR_REFLECTANCE:
      return vl_material_spectrum(b, &b->def->reflectance, &b->m->reflectance);
    case VL_HAIR_MELANIN: {
      VL_TRY(vl_world_spectrum_node(b->world, b->scene, eu, VL_ROLE_UNBOUNDED, &h->eumelanin,
                                    b->error));
      return vl_world_spectrum_node(b->world, b->scene, pheo, VL_ROLE_UNBOUNDED,
                                    &h->pheomelanin, b->error);
    }
  }
  return VL_ERROR_ARGUMENT;
}

vlResult vl_compile_hair_material(const vlMaterialBuild *b) {
  const vlHairDef *d = &b->def->hair;
  vlWorldHair *h = vl_world_block(b->world, 1, sizeof *h);
  if (!h)
    return vl_fail_memory(b->error);
  b->m->bsdf = VL_BSDF_HAIR;
  b->m->own = h;
  b->m->no_cosine = true;
  h->sigma_a = h->eumelanin = h->pheomelanin = -1;
  const vlMaterialFloat floats[] = {{d->eumelanin, &h->eumelanin_share},
                                    {d->pheomelanin, &h->pheomelanin_share},
                                    {d->eta, &h->eta},
                                    {d->beta_m, &h->beta_m},
                                    {d->beta_n, &h->beta_n},
                                    {d->alpha, &h->alpha}};
  VL_TRY(compile_color(b, h));
  return vl_material_floats(b, floats, VL_LENGTH(floats));
}
