/* trace/medium/medium.h: free flights and transmittance in one medium, for one lane. The path integral with null
 * collisions, sampled by the hero wavelength and weighted over all (pbrt book 14.2). */
#ifndef TRACE_MEDIUM_MEDIUM_H
#define TRACE_MEDIUM_MEDIUM_H

#include "base/isa.h"
#include "math/hash.h"
#include "world/medium/medium_lookup.h"

/* The state of a ray: beta, the throughput over the density of the path (sampled by channel `hero`); u, the densities
 * with which the other channels would have sampled the path, and l, those with which light sampling would have, both
 * over the same density. */
typedef struct vlFlight {
  float beta[4], u[4], l[4], lambda[4];
  int hero, channels;  /* channels: 4 wavelengths, or 3 in RGB mode */
  float first;         /* the first random number; -1: hashed like the others */
  uint32_t key, count; /* random numbers are hashes of both */
  float passed[3];     /* vlVolumeRows.passed */
  float odds;          /* probability of passing by a flight, over that by light sampling; the same for all channels */
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

/* A flight along o + t d (d of unit length), t in [t0, t1]: passed, or scattered at *t. emission: adds the medium's
 * emission to radiance. */
vlFlightEnd vl_fly(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, bool emission, vlFlight *f,
                   float radiance[4], float *t);
/* Multiplies f->beta by the transmittance; f->u: density of passing by a flight, f->l: of passing by this function,
 * both over the latter. */
void vl_attenuate(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, vlFlight *f);

#endif
