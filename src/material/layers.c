/* material/layers.c: inputs of the materials whose layers are evaluated by random walks
 * (material/layered.hot.c). */
#include "material/compile.h"

vlResult vl_material_layers(const vlMaterialBuild *b, bool metal) {
  const vlMaterialDef *def = b->def;
  vlWorldLayers *l = vl_world_block(b->world, 1, sizeof *l);
  if (!l)
    return vl_fail_memory(b->error);
  b->m->bsdf = VL_BSDF_LAYERED;
  b->m->own = l;
  l->metal = metal;
  l->coat_u = l->coat_v = -1;
  /* Limits. No walk takes more steps, because Russian roulette ends it before. More walks per
   * evaluation gain nothing over more samples per pixel. */
  l->depth = def->max_depth < 1000 ? def->max_depth : 1000;
  l->walks = def->samples < 256 ? def->samples : 256;
  const vlMaterialFloat floats[] = {{def->thickness, &l->thickness},
                                    {def->g, &l->g},
                                    {def->coat_u_roughness, &l->coat_u},
                                    {def->coat_v_roughness, &l->coat_v}};
  vlResult r = vl_material_spectrum(b, &def->albedo, &l->albedo);
  return r == VL_OK ? vl_material_floats(b, floats, metal ? 4 : 2) : r;
}

vlResult vl_compile_coated_conductor_material(const vlMaterialBuild *b) {
  vlResult r = vl_material_roughness(b);
  if (r == VL_OK)
    r = vl_material_metal(b);
  if (r == VL_OK)
    r = vl_material_index(b, &b->def->coat_eta, false);
  return r == VL_OK ? vl_material_layers(b, true) : r;
}
