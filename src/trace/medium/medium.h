/* trace/medium/medium.h: free flights and transmittance in media, for a block of lanes. The
 * hero wavelength samples the path integral with null scattering; the result is weighted over
 * all wavelengths (pbrt book 14.2). */
#ifndef TRACE_MEDIUM_MEDIUM_H
#define TRACE_MEDIUM_MEDIUM_H

#include "base/isa.h"
#include "math/hash.h"
#include "medium/lookup.h"
#include "trace/stages.h"

/* The state of one ray. Channel `hero` sampled its path, with some density. beta: throughput
 * over this density. u: densities with which each channel would have sampled the path, over
 * this density. l: densities of the path by light sampling, over this density. */
typedef struct vlFlight {
  float beta[4], u[4], l[4], lambda[4];
  int hero, channels;  /* channels: 4 wavelengths, or 3 in RGB mode */
  float first;         /* first random number; -1: it is a hash like the others */
  uint32_t key, count; /* random numbers are hashes of key and count */
  float odds; /* probability that a flight passes, over that of light sampling; the same for all
                 channels */
} vlFlight;

static inline float vl_flight_random(vlFlight *f) {
  float first = f->first;
  f->first = -1.0f;
  return first >= 0.0f ? first : vl_unit_float(vl_hash2(f->key, f->count++));
}
static inline float vl_flight_mean_of(float v0, float v1, float v2, float v3, int channels) {
  return channels == 4 ? 0.25f * ((v0 + v1) + (v2 + v3)) : (v0 + v1 + v2) * (1.0f / 3.0f);
}
static inline float vl_flight_mean(const float v[4], int channels) {
  return vl_flight_mean_of(v[0], v[1], v[2], v[3], channels);
}

static inline bool vl_volume_rgb(const vlTracing *t) {
  return t->world->def.color == VL_COLOR_RGB;
}

/* Key of the random numbers that do not come from the sampler. */
enum { VL_KEY_FLIGHT = 0, VL_KEY_SHADOW = 1, VL_KEY_HERO = 2, VL_KEY_PROBE = 3 };
static inline uint32_t vl_volume_key(const vlTracing *t, const vlPaths *p, uint32_t i,
                                     uint32_t depth, uint32_t purpose) {
  uint32_t pixel = vl_hash3((uint32_t)p->px[i], (uint32_t)p->py[i], p->index[i]);
  return vl_hash3(pixel, t->def->sampler->seed, 4 * depth + purpose);
}

/* The channel that samples flights. For camera paths it is the hero wavelength, which is random
 * already. In RGB mode and for light paths, a channel is chosen at random per path, because a
 * light path and the camera path that it meets must choose independently. */
static inline int vl_volume_hero(const vlTracing *t, const vlPaths *p, uint32_t i) {
  if (!vl_volume_rgb(t))
    return t->light ? (int)(vl_volume_key(t, p, i, 0, VL_KEY_HERO) % 4) : 0;
  return (int)(vl_volume_key(t, p, i, 0, VL_KEY_HERO) % 3);
}

typedef enum vlFlightEnd { VL_FLIGHT_PASSED, VL_FLIGHT_SCATTERED, VL_FLIGHT_ENDED } vlFlightEnd;

/* The flights of a block of lanes. The pointers lead to rows of the batch, from the block's
 * first lane on; the arrays belong to the block. Elements from n to VL_PAD(n) hold old data. */
enum { VL_FLIGHTS = 64 };
typedef struct vlFlights {
  uint32_t n;
  vlRays rays; /* origins and directions (of unit length) */
  float *beta[4], *u[4], *l[4], *odds;
  const float *lambda[4];
  const vlPaths *paths; /* of which paths[path[i]] is the path of lane i; their random numbers
                           depend on depth and */
  VL_ROW uint32_t path[VL_FLIGHTS]; /* purpose (vl_volume_key) */
  uint32_t depth, purpose;
  VL_ROW float first[VL_FLIGHTS];
  VL_ROW uint32_t count[VL_FLIGHTS];
  VL_ROW float passed[3][VL_FLIGHTS]; /* only if vlWorld.by_channel */
  /* The next flight: along o + t d for t in [from, to] in a medium; VL_NONE: the lane does not
   * fly. */
  VL_ROW uint32_t medium[VL_FLIGHTS];
  VL_ROW float from[VL_FLIGHTS], to[VL_FLIGHTS];
  /* The result of vl_fly. given: radiance, to which the emission of media is added. */
  VL_ROW uint32_t end[VL_FLIGHTS]; /* vlFlightEnd */
  VL_ROW float t[VL_FLIGHTS];      /* distance at which the flight scatters */
  VL_ROW float given[4][VL_FLIGHTS];
} vlFlights;

/* Samples the next flight of each lane that has a medium. It passes, scatters at t, or ends.
 * emission: add the media's emission to `given`. Afterwards no lane has a medium. */
void vl_fly(const vlTracing *t, vlFlights *f, bool emission);
/* Multiplies beta by the transmittance. u becomes the density that a flight passes, and l the
 * density of this function; both are relative to the density of this function. Afterwards no
 * lane has a medium. */
void vl_attenuate(const vlTracing *t, vlFlights *f);

/* The same in one medium that is not uniform, for one lane (delta_tracking.hot.c). */
vlFlightEnd vl_track(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1,
                     bool emission, vlFlight *f, float radiance[4], float *t);
void vl_track_through(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1,
                      vlFlight *f);

#endif
