/* trace/medium/medium.h: light on its way through one medium, lane by lane: where it scatters, how much of it passes.
 * The integral over paths with null collisions, sampled by the hero wavelength, weighed over all (pbrt book 14.2). */
#ifndef TRACE_MEDIUM_MEDIUM_H
#define TRACE_MEDIUM_MEDIUM_H

#include "base/isa.h"
#include "math/hash.h"
#include "world/medium/medium_lookup.h"

/* What a ray carries: throughput over the density of the path (sampled by channel `hero`), and the densities by which
 * the other channels (u), and light sampling (l) would have made it, over the same. */
typedef struct vlFlight {
  float beta[4], u[4], l[4], lambda[4];
  int hero, channels;  /* 4 wavelengths, or 3 of RGB */
  float first;         /* the first random number, -1: like the others */
  uint32_t key, count; /* of random numbers: they depend on both alone */
  float odds; /* of coming through by flight against by what light sampling does, one number for all channels */
} vlFlight;

static inline float vl_flight_random(vlFlight *f) {
  float first = f->first;
  f->first = -1.0f;
  return first >= 0.0f ? first : vl_unit_float(vl_hash2(f->key, f->count++));
}
static inline float vl_flight_mean(const float v[4], int channels) {
  return channels == 4 ? 0.25f * ((v[0] + v[1]) + (v[2] + v[3])) : (v[0] + v[1] + v[2]) * (1.0f / 3.0f);
}

typedef enum vlFlightEnd { VL_FLIGHT_PASSED, VL_FLIGHT_SCATTERED, VL_FLIGHT_ENDED } vlFlightEnd;

/* Along o + t d (d of unit length), t in [t0, t1]: passed, or scattered at *t. emission: adds what the medium gives out
 * to radiance. */
vlFlightEnd vl_fly(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, bool emission, vlFlight *f,
                   float radiance[4], float *t);
/* Transmittance to f->beta; f->u, f->l: densities of flying through and of this, over that of this. */
void vl_attenuate(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, vlFlight *f);

#endif
