/* tracer/limits.hot.c: limits of a path's bounces of one kind: vlRenderDef.max_diffuse_depth
 * and the like. */
#include "trace/medium/volume.h"
#include "tracer/record.h"

void vl_limits_start(const vlTracing *t, uint32_t n) {
  for (int k = 0; k < VL_BOUNCE_KINDS; k++)
    for (uint32_t i = 0; i < n; i++)
      t->bounces[k][i] = 0;
}

static vlBounceKind kind_of(const vlWorldMaterial *material, uint32_t flags) {
  if (flags & VL_SAMPLED_TRANSMISSION)
    return material->subsurface ? VL_BOUNCE_DIFFUSE : VL_BOUNCE_TRANSMISSION;
  return flags & VL_SAMPLED_DIFFUSE ? VL_BOUNCE_DIFFUSE : VL_BOUNCE_GLOSSY;
}

void vl_limits_count(const vlTracing *t, uint32_t n, const vlVertices *at,
                     const vlBsdfSamples *samples, const uint32_t *alive) {
  for (uint32_t i = 0; i < n; i++) {
    const vlWorldMaterial *material = &t->world->materials.items[at->hits.material[i]];
    if (alive[i])
      t->bounces[kind_of(material, samples->flags[i])][at->paths.lane[i]]++;
  }
}

void vl_limits_end(const vlTracing *t, uint32_t n, const vlPaths *rays, vlHits *hits,
                   vlFlightEnds *ends) {
  for (uint32_t i = 0; i < n; i++) {
    bool done = false;
    for (int k = 0; k < VL_BOUNCE_KINDS; k++)
      done |= t->bounces[k][rays->lane[i]] >= t->def->max_of_kind[k];
    if (!done)
      continue;
    if (t->batch->recorder)
      vl_record_limit(t, rays->lane[i]);
    hits->shape[i] = VL_NONE;
    if (ends)
      ends->event[i] = VL_AT_END;
  }
}
