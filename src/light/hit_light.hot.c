/* light/hit_light.hot.c: the radiance of lights that rays hit, and the density with which
 * light sampling would have sampled them, for the MIS weights of all tracers. Except for
 * environment maps, the code is scalar, because each lane hits its own light. */
#include "light/kinds.hot.h"
#include "light/spread.h"

/* Infinite light k of the world as seen by ray i. */
static vlHitLight hit_infinite(const vlWorld *world, const vlPaths *p, uint32_t i, size_t k) {
  vlVec3 o = vl_row3(&p->o, i), d = vl_row3(&p->d, i);
  vlHitLight met = {.light = world->infinite_lights.items[k]};
  const vlWorldLight *light = &world->lights.items[met.light];
  float lambda[4];
  vl_path_lambda(p, i, lambda);
  vl_infinite_at(world, light, o, d, lambda, met.radiance);
  if (!p->specular[i])
    met.pdf = vl_infinite_pdf(world, light, o, d) *
              vl_light_pmf(&world->tree, vl_receiver_before(p, i), met.light);
  return met;
}

/* Evaluates infinite light k of the world; out: in the order of lanes. */
static void hit_sky(const vlWorld *world, const vlPaths *p, const uint32_t *lanes,
                    uint32_t count, size_t k, vlSkyHits *out) {
  uint32_t index = world->infinite_lights.items[k];
  const vlWorldLight *light = &world->lights.items[index];
  if (vl_light_is_environment(world, light)) {
    vl_hit_environment(world, light, p, lanes, count, out);
    for (uint32_t j = 0; j < count; j++) {
      uint32_t i = lanes[j];
      if (p->specular[i])
        continue;
      out->pdf[j] *= vl_light_pmf(&world->tree, vl_receiver_before(p, i), index);
    }
    return;
  }
  for (uint32_t j = 0; j < count; j++) {
    vlHitLight met = hit_infinite(world, p, lanes[j], k);
    for (int c = 0; c < 4; c++)
      out->radiance[c][j] = met.radiance[c];
    out->pdf[j] = met.pdf;
  }
}

bool vl_hit_emission(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i,
                     vlHitLight *met) {
  met->light = vl_shape_light(&world->shapes.items[h->shape[i]], h->prim[i]);
  if (met->light == VL_NONE)
    return false;
  const vlWorldLight *light = &world->lights.items[met->light];
  const vlEmitted *e = &world->emitted.items[light->emitted];
  vlVec3 o = vl_row3(&p->o, i), d = vl_row3(&p->d, i);
  met->at = vl_hit_point(world, p, h, i);
  if (!(vl_dot(d, met->at.g) < 0.0f) && !e->two_sided)
    return false;
  float lambda[4];
  vl_path_lambda(p, i, lambda);
  vlVec2 uv = vl_emission_uv(world, light, &met->at);
  vl_emitted_at(world, e, lambda, uv.x, 1.0f - uv.y, false, met->radiance);
  vl_spread_radiance(e, vl_abs(vl_dot(d, met->at.g)), met->radiance);
  met->pdf = 0.0f;
  if (!p->specular[i])
    met->pdf = vl_area_pdf(world, light, o, &met->at) *
               vl_light_pmf(&world->tree, vl_receiver_before(p, i), met->light);
  return true;
}

/* For rays that hit nothing, at most VL_SKY_BLOCK. */
static void sky_hit(vlTracing *t, const vlPaths *rays, const vlVolumeRows *rows,
                    const vlFlightEnds *ends, const uint32_t *lanes, uint32_t count,
                    vlAddLight *add) {
  for (size_t k = 0; count > 0 && k < t->world->infinite_lights.count; k++) {
    vlSkyHits sky;
    vlHitLight met = {.light = t->world->infinite_lights.items[k]};
    hit_sky(t->world, rays, lanes, count, k, &sky);
    for (uint32_t j = 0; j < count; j++) {
      for (int c = 0; c < 4; c++)
        met.radiance[c] = sky.radiance[c][j];
      met.pdf = sky.pdf[j];
      add(t, rays, rows, ends, lanes[j], &met, true);
    }
  }
}

void vl_stage_lights_hit(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits,
                         const vlVolumeRows *rows, const vlFlightEnds *ends, vlAddLight *add) {
  uint32_t missed[VL_SKY_BLOCK], count = 0;
  for (uint32_t i = 0; i < n; i++) {
    vlHitLight met;
    if (hits->shape[i] != VL_NONE) {
      if (t->world->shapes.items[hits->shape[i]].first_light != VL_NONE &&
          vl_hit_emission(t->world, rays, hits, i, &met))
        add(t, rays, rows, ends, i, &met, false);
      continue;
    }
    if (ends && ends->event[i] != VL_IN_SKY)
      continue;
    missed[count++] = i;
    if (count < VL_SKY_BLOCK)
      continue;
    sky_hit(t, rays, rows, ends, missed, count, add);
    count = 0;
  }
  sky_hit(t, rays, rows, ends, missed, count, add);
}
