/* trace/medium/volume.h: what the files of the tracer through media share: volume.hot.c and volume_shadow.hot.c. */
#ifndef TRACE_MEDIUM_VOLUME_H
#define TRACE_MEDIUM_VOLUME_H

#include "trace/medium/medium.h"
#include "trace/stages.h"

enum { VL_KEY_FLIGHT = 0, VL_KEY_SHADOW = 1, VL_KEY_HERO = 2, VL_KEY_PROBE = 3 };
/* What happens to a ray: vlVolumeScratch.event. */
enum { VL_ON_SURFACE, VL_IN_SKY, VL_IN_MEDIUM, VL_AT_END };
/* Odds that weights can be worked out from. */
static inline float vl_some_odds(float odds) {
  return vl_max(odds, 1e-20f);
}

static inline bool vl_volume_rgb(const vlTracing *t) {
  return t->world->def.color == VL_COLOR_RGB;
}

/* Random numbers that the sampler does not give. */
static inline uint32_t vl_volume_key(const vlTracing *t, const vlPaths *p, uint32_t i, uint32_t depth,
                                     uint32_t purpose) {
  uint32_t pixel = vl_hash3((uint32_t)p->px[i], (uint32_t)p->py[i], p->index[i]);
  return vl_hash3(pixel, t->def->sampler->seed, 4 * depth + purpose);
}

/* The channel that flights are sampled by: the hero wavelength, which is chance enough; of RGB any, one for a path. Of
 * light's paths any, too: where they meet the eye's, neither's choice may tell of the other's. */
static inline int vl_volume_hero(const vlTracing *t, const vlPaths *p, uint32_t i) {
  if (!vl_volume_rgb(t)) return t->from_light ? (int)(vl_volume_key(t, p, i, 0, VL_KEY_HERO) % 4) : 0;
  return (int)(vl_volume_key(t, p, i, 0, VL_KEY_HERO) % 3);
}

static inline vlFlight vl_volume_flight(const vlTracing *t, const vlPaths *p, const vlVolumeRows *v, uint32_t i,
                                        uint32_t depth, uint32_t purpose) {
  vlFlight f = {.hero = vl_volume_hero(t, p, i),
                .channels = vl_volume_rgb(t) ? 3 : 4,
                .first = -1.0f,
                .key = vl_volume_key(t, p, i, depth, purpose),
                .odds = 1.0f};
  for (int c = 0; c < 4; c++) {
    f.lambda[c] = p->lambda[c][i];
    f.beta[c] = p->beta[c][i];
    f.u[c] = v->u[c][i];
    f.l[c] = v->l[c][i];
  }
  return f;
}

static inline void vl_volume_copy(const vlVolumeRows *a, uint32_t i, vlVolumeRows *b, uint32_t k) {
  for (int c = 0; c < 4; c++) b->u[c][k] = a->u[c][i], b->l[c][k] = a->l[c][i];
  b->medium[k] = a->medium[i];
}

/* The medium beyond a surface in direction w. */
static inline uint32_t vl_medium_beyond(const vlWorldShape *s, vlVec3 g, vlVec3 w, uint32_t here) {
  if (s->inside == s->outside) return here;
  return vl_dot(w, g) > 0.0f ? s->outside : s->inside;
}

static inline bool vl_is_interface(const vlWorld *world, uint32_t shape) {
  return world->materials.items[world->shapes.items[shape].material].kind == VL_MATERIAL_INTERFACE;
}

/* The n rays of a through media and interfaces to what happens to them; depth: of it; emission: adds what media on the
 * way give out. Densities in volume.a; origins stay those of the last scattering. */
void vl_volume_travel(vlTracing *t, uint32_t n, uint32_t depth, bool emission);
void vl_volume_permute(const vlVolumeRows *a, vlVolumeRows *b, const uint32_t *order, uint32_t n);
/* beta is the path's weight from here on; the densities' mean is 1. */
void vl_volume_normalise(const vlTracing *t, vlPaths *p, vlVolumeRows *v, uint32_t i);
/* The lanes of a that scatter in media, normalised, at their places, to volume.scattered and .c; the surface's point is
 * theirs, for light sampling. s->order: which lanes of a. Returns how many. */
uint32_t vl_volume_gather(vlTracing *t, uint32_t n);
/* New directions by the phase function, roulette as on surfaces. Returns how many go on; s->order names them. */
uint32_t vl_volume_phase_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension);
/* The n paths of a set out: from these media (by lane), or null: from the camera. */
void vl_volume_start(vlTracing *t, uint32_t n, const uint32_t *medium);
/* volume.b of the n sorted lanes; and, after scattering on surfaces, volume.a of the `count` lanes s->order. Nothing
 * where there are neither media nor bodies. */
void vl_volume_sorted(vlTracing *t, uint32_t n);
void vl_volume_go_on(vlTracing *t, uint32_t count);
/* Paths order[k] of volume.scattered to the end of the n of a. Returns how many there are then. */
uint32_t vl_volume_append(vlTracing *t, const uint32_t *order, uint32_t count, uint32_t n);
/* Shadow ray k's way: transmittance to beta, densities over that of light sampling. */
vlFlight vl_volume_shadow_flight(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t k, uint32_t depth);
/* Lane i's light sample as shadow ray `count`, from o; value: what the scattering passes on, pdf its density. Returns
 * the next count. */
uint32_t vl_volume_push_shadow(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t i, vlVec3 o,
                               const float value[4], float pdf, uint32_t medium, uint32_t count);
/* Adds what arrives along them. */
void vl_volume_shadows(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t count, uint32_t depth);

#endif
