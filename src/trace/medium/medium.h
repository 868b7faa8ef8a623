/* trace/medium/medium.h: free flights and transmittance in one medium, for one lane. The hero wavelength samples the
 * path integral with null scattering; the result is weighted over all wavelengths (pbrt book 14.2). */
#ifndef TRACE_MEDIUM_MEDIUM_H
#define TRACE_MEDIUM_MEDIUM_H

#include "base/isa.h"
#include "math/hash.h"
#include "world/medium/medium_lookup.h"

/* The state of a ray. Channel `hero` sampled its path, with some density. beta: throughput over this density. u:
 * densities with which each channel would have sampled the path, over this density. l: densities of the path by light
 * sampling, over this density. */
typedef struct vlFlight {
  float beta[4], u[4], l[4], lambda[4];
  int hero, channels;  /* channels: 4 wavelengths, or 3 in RGB mode */
  float first;         /* first random number; -1: it is a hash like the others */
  uint32_t key, count; /* random numbers are hashes of key and count */
  float passed[3];     /* vlTraceScratch.passed */
  float odds;          /* probability that a flight passes, over that of light sampling; the same for all channels */
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

/* Samples a flight along o + t d (d of unit length) for t in [t0, t1]. It passes, scatters at *t, or ends. emission:
 * add the medium's emission to radiance. */
vlFlightEnd vl_fly(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, bool emission, vlFlight *f,
                   float radiance[4], float *t);
/* Multiplies f->beta by the transmittance. f->u becomes the density that a flight passes, and f->l the density of this
 * function; both are relative to the density of this function. */
void vl_attenuate(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, vlFlight *f);

#endif
