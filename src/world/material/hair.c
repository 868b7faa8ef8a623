/* world/material/hair.c: inputs of the hair material. */
#include "base/error.h"
#include "scene/scene.h"
#include "world/world.h"

vlResult vl_world_hair(vlWorld *world, const vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                       vlError *error) {
  const vlHairDef *d = &def->hair;
  vlWorldHair *h = vl_world_block(world, 1, sizeof *h);
  if (!h) return vl_fail_memory(error);
  m->hair = h;
  h->sigma_a = h->eumelanin = h->pheomelanin = -1;
  vlResult r = VL_OK;
  if (d->color == VL_HAIR_SIGMA_A)
    r = vl_world_spectrum_node(world, scene, d->sigma_a, VL_ROLE_UNBOUNDED, &h->sigma_a, error);
  if (d->color == VL_HAIR_REFLECTANCE)
    r = vl_world_spectrum_node(world, scene, def->reflectance, VL_ROLE_ALBEDO, &m->reflectance, error);
  if (d->color == VL_HAIR_MELANIN) {
    /* absorption of either pigment per unit of concentration (d'Eon, Francois, Hill, Letteri, Aubry 2011) */
    vlSpectrumInput eu = vl_spectrum_input(vl_spectrum_rgb(0.419f, 0.697f, 1.37f));
    vlSpectrumInput pheo = vl_spectrum_input(vl_spectrum_rgb(0.187f, 0.4f, 1.05f));
    r = vl_world_spectrum_node(world, scene, eu, VL_ROLE_UNBOUNDED, &h->eumelanin, error);
    if (r == VL_OK) r = vl_world_spectrum_node(world, scene, pheo, VL_ROLE_UNBOUNDED, &h->pheomelanin, error);
  }
  const struct {
    vlFloatInput input;
    int32_t *node;
  } floats[] = {{d->eumelanin, &h->eumelanin_share},
                {d->pheomelanin, &h->pheomelanin_share},
                {d->eta, &h->eta},
                {d->beta_m, &h->beta_m},
                {d->beta_n, &h->beta_n},
                {d->alpha, &h->alpha}};
  for (size_t i = 0; r == VL_OK && i < sizeof floats / sizeof *floats; i++)
    r = vl_world_float_node(world, scene, floats[i].input, floats[i].node, error);
  return r;
}
