/* trace/medium/delta_tracking.hot.c: flights in media that are not uniform
 * (trace/medium/medium.h): delta tracking for flights and ratio tracking for transmittance,
 * with majorants (pbrt book 11.2, 11.4, 14.2) and null scattering (Miller, Georgiev and Jarosz
 * 2019). Absorption without scattering ends no path. The code is scalar because flights
 * diverge. */
#include "trace/medium/medium.h"

/* The largest number of collisions of a flight; a bound for media whose majorants are far too
 * large. */
enum { MAX_COLLISIONS = 1 << 16 };
/* Russian roulette, for flights whose collisions only weaken them: below this weight a flight
 * ends with the probability roulette_ends; otherwise its weight grows by the factor. */
static const float roulette_below = 0.05f, roulette_ends = 0.75f, roulette_factor = 4.0f;

/* An exponentially distributed number of mean 1. u: uniform in [0, 1). */
static inline float exponential(float u) {
  return -vl_ln(1.0f - u);
}

/* exp(-(sigma_c - sigma_hero) length): transmittance relative to the hero's channel. */
static inline void relative_transmittance(const float sigma[4], int hero, float length,
                                          float factor[4]) {
  for (int c = 0; c < 4; c++)
    factor[c] = vl_exp(-(sigma[c] - sigma[hero]) * length);
}

/* The state of tracking along the majorants. Distances are in the unit of the ray. */
typedef struct Tracking {
  vlMajorantWalk walk;
  float unit[4];       /* majorant coefficients for a majorant of 1 */
  float t, end, depth; /* position, end of this cell, optical depth of the hero channel to the
                          next collision */
  float majorant[4];   /* majorants in this cell */
  uint32_t collisions;
} Tracking;

/* Passes `length` without a collision: changes what the flight carries in the channels other
 * than the hero. */
static void pass(const vlWorldMedium *m, const float majorant[4], float length, vlFlight *f) {
  if (m->grey)
    return;
  float factor[4];
  relative_transmittance(majorant, f->hero, length, factor);
  for (int c = 0; c < 4; c++) {
    f->beta[c] *= factor[c];
    f->u[c] *= factor[c];
    f->l[c] *= factor[c];
  }
}

/* Factor of the odds at a null collision. The null probability is the same for all channels
 * except in RGB grids, where it is left out of the odds. */
static inline float null_odds(const vlWorldMedium *m, float none, float majorant) {
  return m->own_sigma ? 1.0f : none / majorant;
}

/* Begins tracking the part of the ray from t0 to t1. False: the medium is not there. */
static bool start_tracking(const vlWorldMedium *m, const vlMediumLight *whole, vlVec3 o,
                           vlVec3 d, float t0, float t1, vlFlight *f, Tracking *k) {
  if (!vl_majorant_start(m, o, d, t0, t1, &k->walk))
    return false;
  for (int c = 0; c < 4; c++)
    k->unit[c] = m->own_sigma ? 1.0f : whole->a[c] + whole->s[c];
  k->t = k->end = t0;
  k->collisions = 0;
  k->depth = exponential(vl_flight_random(f));
  return true;
}

/* Moves to the next collision. Returns false at the end of the segment. */
static bool next_collision(const vlWorldMedium *m, vlFlight *f, Tracking *k) {
  for (;;) {
    float max = k->majorant[f->hero], length = k->end - k->t;
    if (length > 0.0f) {
      if (max * length > k->depth) {
        float distance = vl_min(k->depth / max, length);
        pass(m, k->majorant, distance, f);
        k->t += distance;
        k->depth = 0.0f;
        k->collisions++;
        return true;
      }
      pass(m, k->majorant, length, f);
      k->depth -= max * length;
    }
    float majorant;
    if (!vl_majorant_next(&k->walk, &k->t, &k->end, &majorant))
      return false;
    for (int c = 0; c < 4; c++)
      k->majorant[c] = majorant * k->unit[c];
  }
}

vlFlightEnd vl_track(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1,
                     bool emission, vlFlight *f, float radiance[4], float *t) {
  vlMediumLight whole = vl_medium_coefficients(m, f->lambda);
  Tracking k = {0};
  int h = f->hero;
  if (!start_tracking(m, &whole, o, d, t0, t1, f, &k))
    return VL_FLIGHT_PASSED;
  while (next_collision(m, f, &k)) {
    if (k.collisions > MAX_COLLISIONS)
      return VL_FLIGHT_ENDED;
    bool gives = emission && m->emits;
    vlMediumLight at = vl_medium_at(m, &whole, f->lambda, vl_add(o, vl_mul(d, k.t)), gives);
    if (gives) {
      float density[4];
      for (int c = 0; c < 4; c++)
        density[c] = f->u[c] * k.majorant[c];
      float inv = 1.0f / vl_flight_mean(density, f->channels);
      for (int c = 0; c < 4; c++)
        radiance[c] += f->beta[c] * at.a[c] * at.le[c] * inv;
    }
    float none[4]; /* coefficients of null collisions */
    for (int c = 0; c < 4; c++)
      none[c] = vl_max(0.0f, k.majorant[c] - at.a[c] - at.s[c]);
    if (!m->scatters) {
      for (int c = 0; c < 4; c++) {
        f->beta[c] *= none[c] / k.majorant[h];
        f->u[c] *= k.majorant[c] / k.majorant[h];
        f->l[c] *= k.majorant[c] / k.majorant[h];
      }
      float carried = vl_largest_of4(f->beta) / vl_flight_mean(f->u, f->channels);
      if (!(carried > 0.0f))
        return VL_FLIGHT_ENDED;
      if (carried < roulette_below) {
        if (vl_flight_random(f) < roulette_ends)
          return VL_FLIGHT_ENDED;
        for (int c = 0; c < 4; c++)
          f->beta[c] *= roulette_factor;
      }
      k.depth = exponential(vl_flight_random(f));
      continue;
    }
    float real = at.a[h] + at.s[h];
    if (vl_flight_random(f) * k.majorant[h] < real) {
      for (int c = 0; c < 4; c++) {
        f->beta[c] *= at.s[c] / real;
        f->u[c] *= (at.a[c] + at.s[c]) / real;
      }
      *t = k.t;
      return vl_largest_of4(f->beta) > 0.0f ? VL_FLIGHT_SCATTERED : VL_FLIGHT_ENDED;
    }
    if (!(none[h] > 0.0f))
      return VL_FLIGHT_ENDED; /* happens only by rounding */
    f->odds *= null_odds(m, none[h], k.majorant[h]);
    for (int c = 0; c < 4; c++) {
      f->beta[c] *= none[c] / none[h];
      f->u[c] *= none[c] / none[h];
      f->l[c] = vl_min(f->l[c] * (k.majorant[c] / none[h]), 1e30f);
    }
    k.depth = exponential(vl_flight_random(f));
  }
  return VL_FLIGHT_PASSED;
}

void vl_track_through(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1,
                      vlFlight *f) {
  vlMediumLight whole = vl_medium_coefficients(m, f->lambda);
  Tracking k = {0};
  int h = f->hero;
  if (!start_tracking(m, &whole, o, d, t0, t1, f, &k))
    return;
  while (next_collision(m, f, &k)) {
    vlMediumLight at = vl_medium_at(m, &whole, f->lambda, vl_add(o, vl_mul(d, k.t)), false);
    float both[4];
    if (m->scatters)
      f->odds *= null_odds(m, vl_max(0.0f, k.majorant[h] - at.a[h] - at.s[h]), k.majorant[h]);
    for (int c = 0; c < 4; c++) {
      float none = vl_max(0.0f, k.majorant[c] - at.a[c] - at.s[c]) / k.majorant[h];
      float any = k.majorant[c] / k.majorant[h];
      f->beta[c] *= none;
      f->u[c] *= m->scatters ? none : any;
      f->l[c] *= any;
      both[c] = f->u[c] + f->l[c];
    }
    float carried = vl_largest_of4(f->beta) / vl_flight_mean(both, f->channels);
    if (carried < roulette_below) {
      bool ends = !(carried > 0.0f) || k.collisions > MAX_COLLISIONS ||
                  vl_flight_random(f) < roulette_ends;
      for (int c = 0; c < 4; c++)
        f->beta[c] *= ends ? 0.0f : roulette_factor;
      if (ends)
        return;
    }
    k.depth = exponential(vl_flight_random(f));
  }
}
