/* trace/volume.h: what the files of the tracer through media share: volume.hot.c and volume_shadow.hot.c. */
#ifndef TRACE_VOLUME_H
#define TRACE_VOLUME_H

#include "trace/medium.h"
#include "trace/stages.h"

enum { VL_KEY_FLIGHT = 0, VL_KEY_SHADOW = 1, VL_KEY_HERO = 2 };

static inline bool vl_volume_rgb(const vlTracing *t) {
  return t->world->def.color == VL_COLOR_RGB;
}

/* Random numbers that the sampler does not give. */
static inline uint32_t vl_volume_key(const vlTracing *t, const vlPaths *p, uint32_t i, uint32_t depth,
                                     uint32_t purpose) {
  uint32_t pixel = vl_hash3((uint32_t)p->px[i], (uint32_t)p->py[i], p->index[i]);
  return vl_hash3(pixel, t->def->sampler->seed, 4 * depth + purpose);
}

/* The channel that flights are sampled by: the hero wavelength, which is chance enough; of RGB any, one for a path. */
static inline int vl_volume_hero(const vlTracing *t, const vlPaths *p, uint32_t i) {
  return vl_volume_rgb(t) ? (int)(vl_volume_key(t, p, i, 0, VL_KEY_HERO) % 3) : 0;
}

static inline vlFlight vl_volume_flight(const vlTracing *t, const vlPaths *p, const vlVolumeRows *v, uint32_t i,
                                        uint32_t depth, uint32_t purpose) {
  vlFlight f = {.hero = vl_volume_hero(t, p, i),
                .channels = vl_volume_rgb(t) ? 3 : 4,
                .first = -1.0f,
                .key = vl_volume_key(t, p, i, depth, purpose)};
  for (int c = 0; c < 4; c++) {
    f.lambda[c] = p->lambda[c][i];
    f.beta[c] = p->beta[c][i];
    f.u[c] = v->u[c][i];
    f.l[c] = v->l[c][i];
  }
  return f;
}

/* The medium beyond a surface in direction w. */
static inline uint32_t vl_medium_beyond(const vlWorldShape *s, vlVec3 g, vlVec3 w, uint32_t here) {
  if (s->inside == s->outside) return here;
  return vl_dot(w, g) > 0.0f ? s->outside : s->inside;
}

static inline bool vl_is_interface(const vlWorld *world, uint32_t shape) {
  return world->materials.items[world->shapes.items[shape].material].kind == VL_MATERIAL_INTERFACE;
}

#ifdef VL_ISA_SUFFIX
/* Lane i's light sample as shadow ray `count`, from o; value: what the scattering passes on, pdf its density. Returns
 * the next count. */
uint32_t VL_HOT(vl_volume_push_shadow)(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t i, vlVec3 o,
                                       const float value[4], float pdf, uint32_t medium, uint32_t count);
/* Adds what arrives along them. */
void VL_HOT(vl_volume_shadows)(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t count,
                               uint32_t depth);
#endif

#endif
