/* material/subsurface.c: inputs of the subsurface material. Materials with the same index
 * and g share a profile. */
#include "material/bssrdf.h"
#include "material/compile.h"

static const vlWorldSubsurface *find(const vlWorld *world, float eta, float g) {
  for (size_t i = 0; i < world->materials.count; i++) {
    const vlWorldSubsurface *other = world->materials.items[i].subsurface;
    if (other && other->table->eta == eta && other->table->g == g)
      return other;
  }
  return NULL;
}

/* False: out of memory. */
static bool set_table(vlWorld *world, float eta, float g, vlWorldSubsurface *s) {
  const vlWorldSubsurface *known = find(world, eta, g);
  if (!known && world->previous && (known = find(world->previous, eta, g)) &&
      !vl_part_share(world, known->part))
    return false;
  if (known) {
    s->table = known->table;
    s->part = known->part;
    return true;
  }
  vlPart *part = s->part = vl_part_add(world);
  if (!part)
    return false;
  world->part = part;
  vlBssrdfTable *table = vl_world_block(world, 1, sizeof *table);
  world->part = NULL;
  if (!table)
    return false;
  vl_bssrdf_build(world->context, eta, g, table);
  s->table = table;
  return true;
}

vlResult vl_compile_subsurface_material(const vlMaterialBuild *b) {
  const vlSubsurfaceDef *d = &b->def->subsurface;
  vlWorldMaterial *m = b->m;
  vlWorldSubsurface *s = vl_world_block(b->world, 1, sizeof *s);
  if (!s)
    return vl_fail_memory(b->error);
  m->bsdf = VL_BSDF_DIELECTRIC;
  m->smooth = VL_SMOOTH_BY_ALPHA_OR_INDEX;
  s->sigma_a = s->sigma_s = s->mfp = -1;
  m->scale = b->def->scale;
  m->eta_s = b->def->eta.value.value * b->def->eta.value.scale;
  vlResult r = vl_material_roughness(b);
  if (r != VL_OK)
    return r;
  if (!set_table(b->world, m->eta_s, b->def->g.value, s))
    return vl_fail_memory(b->error);
  if (d->from_reflectance) {
    r = vl_material_spectrum(b, &b->def->reflectance, &m->reflectance);
    if (r == VL_OK)
      r = vl_material_spectrum(b, &d->mfp, &s->mfp);
  } else {
    r = vl_material_spectrum(b, &d->sigma_a, &s->sigma_a);
    if (r == VL_OK)
      r = vl_material_spectrum(b, &d->sigma_s, &s->sigma_s);
  }
  m->subsurface = s;
  m->has_subsurface = true;
  return r;
}
