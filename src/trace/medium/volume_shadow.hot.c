/* trace/medium/volume_shadow.hot.c: shadow rays through participating media and interfaces: the
 * radiance of light samples, with MIS weights against BSDF and phase-function sampling (pbrt
 * book 14.2.3). */
#include "trace/medium/volume.h"

/* The block of `n` shadow rays from `first` on. Those that are not occluded and do not leave
 * the world through vacuum are open. */
static void begin_block(const vlTracing *t, const vlPaths *p, const vlShadowRays *q,
                        vlShadowFlights *v, vlTravel *k, uint32_t first, uint32_t n,
                        float *lambda[4]) {
  vlFlights *f = &k->f;
  f->n = n;
  f->rays =
      vl_rays_of(&q->o, &q->d, first, NULL, q->t_max + first, p->time ? q->time + first : NULL);
  f->odds = v->odds + first;
  for (int c = 0; c < 4; c++) {
    f->beta[c] = v->beta[c] + first;
    f->lambda[c] = lambda[c];
    f->u[c] = v->u[c] + first;
    f->l[c] = v->l[c] + first;
    for (uint32_t i = 0; i < n; i++)
      f->beta[c][i] = f->u[c][i] = f->l[c][i] = 1.0f;
  }
  k->count = 0;
  for (uint32_t i = 0; i < n; i++) {
    f->odds[i] = 1.0f;
    if (q->occluded[first + i] ||
        (v->medium[first + i] == VL_NONE && !t->world->has_interfaces))
      continue;
    k->open[k->count++] = i;
    uint32_t path = f->path[i] = v->from[first + i];
    for (int c = 0; c < 4; c++)
      lambda[c][i] = p->lambda[c][path];
    for (int c = 0; t->world->by_channel && c < 3; c++)
      f->passed[c][i] = v->passed[c][first + i];
    f->from[i] = 0.0f;
    f->first[i] = -1.0f;
    f->count[i] = 0;
  }
}

static void pass_block(vlTracing *t, vlTravel *k, uint32_t *medium) {
  vlFlights *f = &k->f;
  for (int step = 0; step < 1024 && k->count > 0; step++) {
    uint32_t on = 0;
    if (t->world->has_interfaces) {
      vl_travel_closest(t, k);
      t->batch->shadow_rays += k->count;
    }
    vl_travel_aim(t, k, medium);
    vl_attenuate(t, f);
    for (uint32_t j = 0; j < k->count; j++) {
      uint32_t i = k->open[j];
      float max = vl_largest4(f->beta[0][i], f->beta[1][i], f->beta[2][i], f->beta[3][i]);
      if (k->x.shape[i] == VL_NONE || !(max > 0.0f))
        continue;
      if (vl_meets_interface(t->world, &k->x, i)) {
        medium[i] = vl_travel_pass(t, k, i, medium[i]);
        k->open[on++] = i;
      } else { /* cannot happen: the ray is not occluded */
        for (int c = 0; c < 4; c++)
          f->beta[c][i] = 0.0f;
      }
    }
    k->count = on;
  }
  for (uint32_t j = 0; j < k->count; j++)
    for (int c = 0; c < 4; c++)
      f->beta[c][k->open[j]] = 0.0f;
}

void vl_volume_pass_media(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                          const vlShadowRays *q, vlShadowFlights *f) {
  VL_ROW float lambda[4][VL_FLIGHTS] = {{0}};
  VL_ROW uint32_t ids[3][VL_FLIGHTS];
  VL_ROW float hit[VL_FLIGHTS];
  float *rows[4] = {lambda[0], lambda[1], lambda[2], lambda[3]};
  vlTravel k;
  vl_travel_start(&k);
  k.f.paths = p;
  k.f.depth = depth;
  k.f.purpose = VL_KEY_SHADOW;
  k.x.shape = ids[0];
  k.x.prim = ids[1];
  k.x.instance = ids[2];
  k.x.hit = hit;
  for (uint32_t i = 0; i < VL_FLIGHTS; i++)
    ids[0][i] = VL_NONE;
  for (uint32_t first = 0; first < count; first += VL_FLIGHTS) {
    begin_block(t, p, q, f, &k, first, count - first < VL_FLIGHTS ? count - first : VL_FLIGHTS,
                rows);
    pass_block(t, &k, f->medium + first);
  }
  for (uint32_t i = 0; i < count; i++)
    f->odds[i] = vl_some_odds(f->odds[i]);
}

void vl_volume_shadows(vlTracing *t, const vlPaths *p, const vlLightSamples *light,
                       uint32_t count, uint32_t depth, vlShadowRays *q, vlShadowFlights *f) {
  vl_stage_occluded(t, count, p, q);
  t->batch->shadow_rays += count;
  vl_volume_pass_media(t, p, count, depth, q, f);
  if (t->def->fit)
    vl_fit_shadows(t, count, light, q, f);
  if (t->batch->recorder)
    vl_volume_record_shadows(t, count, light, q, f);
  for (uint32_t k = 0; k < count; k++) {
    if (q->occluded[k])
      continue;
    float inv = 1.0f / vl_volume_shadow_density(t, f, k, f->pdf[k]);
    for (int c = 0; c < 4; c++)
      t->batch->radiance[c][q->lane[k]] += q->radiance[c][k] * f->beta[c][k] * inv;
  }
}
