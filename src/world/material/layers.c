/* world/material/layers.c: inputs of the materials whose layers are looked at by random walks
 * (trace/bsdf/layered.hot.c). */
#include <math.h>

#include "base/error.h"
#include "scene/scene.h"
#include "world/world.h"

vlResult vl_world_layers(vlWorld *world, const vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                         vlError *error) {
  vlWorldLayers *l = vl_world_block(world, 1, sizeof *l);
  if (!l) return vl_fail_memory(error);
  m->layers = l;
  l->metal = def->kind == VL_MATERIAL_COATED_CONDUCTOR;
  l->coat_u = l->coat_v = -1;
  /* More steps than a walk ever takes (it ends by roulette), more walks than an image's samples are worth. */
  l->depth = def->max_depth < 1000 ? def->max_depth : 1000;
  l->walks = def->samples < 256 ? def->samples : 256;
  vlResult r = vl_world_spectrum_node(world, scene, def->albedo, VL_ROLE_ALBEDO, &l->albedo, error);
  if (r == VL_OK) r = vl_world_float_node(world, scene, def->thickness, &l->thickness, error);
  if (r == VL_OK) r = vl_world_float_node(world, scene, def->g, &l->g, error);
  if (r == VL_OK && l->metal) r = vl_world_float_node(world, scene, def->coat_u_roughness, &l->coat_u, error);
  if (r == VL_OK && l->metal) r = vl_world_float_node(world, scene, def->coat_v_roughness, &l->coat_v, error);
  return r;
}
