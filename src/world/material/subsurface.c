/* world/material/subsurface.c: inputs of the subsurface material; its profile is shared by those of the same index and
 * g. */
#include "base/error.h"
#include "scene/scene.h"
#include "world/material/bssrdf.h"
#include "world/world.h"

static const vlBssrdfTable *table_of(vlWorld *world, float eta, float g) {
  for (size_t i = 0; i < world->materials.count; i++) {
    const vlWorldSubsurface *other = world->materials.items[i].subsurface;
    if (other && other->table->eta == eta && other->table->g == g) return other->table;
  }
  vlBssrdfTable *table = vl_world_block(world, 1, sizeof *table);
  if (table) vl_bssrdf_build(world->context, eta, g, table);
  return table;
}

vlResult vl_world_subsurface(vlWorld *world, const vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                             vlError *error) {
  const vlSubsurfaceDef *d = &def->subsurface;
  vlWorldSubsurface *b = vl_world_block(world, 1, sizeof *b);
  if (!b) return vl_fail_memory(error);
  b->sigma_a = b->sigma_s = b->mfp = -1;
  m->scale = def->scale;
  m->eta_s = def->eta.value.value * def->eta.value.scale;
  if (!(b->table = table_of(world, m->eta_s, def->g.value))) return vl_fail_memory(error);
  vlResult r;
  if (d->from_reflectance) {
    r = vl_world_spectrum_node(world, scene, def->reflectance, VL_ROLE_ALBEDO, &m->reflectance, error);
    if (r == VL_OK) r = vl_world_spectrum_node(world, scene, d->mfp, VL_ROLE_UNBOUNDED, &b->mfp, error);
  } else {
    r = vl_world_spectrum_node(world, scene, d->sigma_a, VL_ROLE_UNBOUNDED, &b->sigma_a, error);
    if (r == VL_OK) r = vl_world_spectrum_node(world, scene, d->sigma_s, VL_ROLE_UNBOUNDED, &b->sigma_s, error);
  }
  m->subsurface = b;
  m->has_subsurface = true;
  return r;
}
