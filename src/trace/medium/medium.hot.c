/* trace/medium/medium.hot.c: free flights and transmittances (trace/medium/medium.h). Homogeneous media in closed form;
 * others by delta tracking (flights) and ratio tracking (transmittances) along their majorants: pbrt
 * book 11.2, 11.4, 14.2; null collisions as in Miller, Georgiev and Jarosz 2019. Media that only absorb are never a
 * matter of chance where they are homogeneous, and end no path where they are not. Scalar: flights diverge. */
#include "trace/medium/medium.h"

/* Collisions after which a flight is given up: a medium so far from its majorants that nothing else would end it. */
enum { MOST_COLLISIONS = 1 << 16 };

static inline float exponential(float u) {
  return -vl_ln(1.0f - u);
}

/* exp(-(sigma_c - sigma_hero) length): how much more of the other channels passes. */
static inline void shift(const float sigma[4], int hero, float length, float factor[4]) {
  for (int c = 0; c < 4; c++) factor[c] = vl_exp(-(sigma[c] - sigma[hero]) * length);
}

static inline float largest(const float v[4]) {
  return vl_max(vl_max(v[0], v[1]), vl_max(v[2], v[3]));
}

/* Absorption by channel of linear sRGB over a length: the path's whole way so far decides how much of each wavelength
 * is left, T = sum_i share_i(lambda) passed_i, so that pieces of a way add up to what it would be in one. */
static void absorb_by_channel(const vlWorldMedium *m, float length, vlFlight *f) {
  float left[3];
  if (!m->by_channel) return;
  for (int i = 0; i < 3; i++) left[i] = f->passed[i] * vl_exp(-m->sigma_rgb[i] * length);
  for (int c = 0; c < 4; c++) {
    float before = vl_channels_at(f->passed, f->lambda[c]), after = vl_channels_at(left, f->lambda[c]);
    f->beta[c] *= before > 0.0f ? after / before : 0.0f;
  }
  for (int i = 0; i < 3; i++) f->passed[i] = left[i];
}

/* ---- homogeneous ------------------------------------------------------------------------------------------------- */

static vlFlightEnd fly_homogeneous(const vlWorldMedium *m, float t0, float t1, bool emission, vlFlight *f,
                                   float radiance[4], float *t) {
  vlMediumLight k = vl_medium_coefficients(m, f->lambda);
  float sigma[4], length = vl_min(t1 - t0, 1e30f), passes[4], factor[4];
  int h = f->hero;
  for (int c = 0; c < 4; c++) sigma[c] = k.a[c] + k.s[c], passes[c] = vl_exp(-sigma[c] * length);
  if (emission && m->emits) { /* all that is given out on the way, whether or not the path goes so far */
    float inv = 1.0f / vl_flight_mean(f->u, f->channels);
    for (int c = 0; c < 4; c++)
      if (sigma[c] > 0.0f) radiance[c] += f->beta[c] * k.le[c] * k.a[c] / sigma[c] * (1.0f - passes[c]) * inv;
  }
  if (!m->scatters) {
    for (int c = 0; c < 4; c++) f->beta[c] *= passes[c];
    absorb_by_channel(m, length, f);
    return largest(f->beta) > 0.0f ? VL_FLIGHT_PASSED : VL_FLIGHT_ENDED;
  }
  float depth = exponential(vl_flight_random(f));
  if (depth < sigma[h] * length) {
    float distance = vl_min(depth / sigma[h], length);
    shift(sigma, h, distance, factor);
    *t = t0 + distance;
    absorb_by_channel(m, distance, f);
    f->odds *= vl_exp(-m->extinction * distance);
    for (int c = 0; c < 4; c++) {
      f->beta[c] *= factor[c] * k.s[c] / sigma[h];
      f->u[c] *= factor[c] * sigma[c] / sigma[h];
    }
    return largest(f->beta) > 0.0f ? VL_FLIGHT_SCATTERED : VL_FLIGHT_ENDED;
  }
  shift(sigma, h, length, factor);
  absorb_by_channel(m, length, f);
  f->odds *= vl_exp(-m->extinction * length);
  for (int c = 0; c < 4; c++) {
    f->beta[c] *= factor[c];
    f->u[c] *= factor[c];
    f->l[c] /= passes[h]; /* light sampling takes the transmittance for granted */
  }
  return VL_FLIGHT_PASSED;
}

static void attenuate_homogeneous(const vlWorldMedium *m, float t0, float t1, vlFlight *f) {
  vlMediumLight k = vl_medium_coefficients(m, f->lambda);
  float length = vl_min(t1 - t0, 1e30f);
  for (int c = 0; c < 4; c++) {
    float passes = vl_exp(-(k.a[c] + k.s[c]) * length);
    f->beta[c] *= passes;
    f->u[c] *= m->scatters ? passes : 1.0f;
  }
  absorb_by_channel(m, length, f);
  if (m->scatters) f->odds *= vl_exp(-m->extinction * length);
}

/* ---- the others -------------------------------------------------------------------------------------------------- */

/* Along the majorants until the next collision. */
typedef struct Tracking {
  vlMajorantWalk walk;
  float unit[4];       /* majorant coefficients where the walk's majorant is 1 */
  float t, end, depth; /* here, end of this cell, optical depth (of the hero) to the next collision */
  float majorant[4];   /* in this cell */
  uint32_t collisions;
} Tracking;

static void pass(const vlWorldMedium *m, const float majorant[4], float length, vlFlight *f) {
  if (m->grey) return;
  float factor[4];
  shift(majorant, f->hero, length, factor);
  for (int c = 0; c < 4; c++) f->beta[c] *= factor[c], f->u[c] *= factor[c], f->l[c] *= factor[c];
}

/* The share of null collisions is the same for all channels but in RGB grids, where it is left out of the odds. */
static inline float null_odds(const vlWorldMedium *m, float none, float majorant) {
  return m->kind == VL_MEDIUM_RGB_GRID ? 1.0f : none / majorant;
}

static bool start_tracking(const vlWorldMedium *m, const vlMediumLight *whole, vlVec3 o, vlVec3 d, float t0, float t1,
                           vlFlight *f, Tracking *k) {
  if (!vl_majorant_start(m, o, d, t0, t1, &k->walk)) return false;
  for (int c = 0; c < 4; c++) k->unit[c] = m->kind == VL_MEDIUM_RGB_GRID ? 1.0f : whole->a[c] + whole->s[c];
  k->t = k->end = t0;
  k->collisions = 0;
  k->depth = exponential(vl_flight_random(f));
  return true;
}

/* false: the end of the way is reached. */
static bool next_collision(const vlWorldMedium *m, vlFlight *f, Tracking *k) {
  for (;;) {
    float most = k->majorant[f->hero], length = k->end - k->t;
    if (length > 0.0f) {
      if (most * length > k->depth) {
        float distance = vl_min(k->depth / most, length);
        pass(m, k->majorant, distance, f);
        k->t += distance;
        k->depth = 0.0f;
        k->collisions++;
        return true;
      }
      pass(m, k->majorant, length, f);
      k->depth -= most * length;
    }
    float majorant;
    if (!vl_majorant_next(&k->walk, &k->t, &k->end, &majorant)) return false;
    for (int c = 0; c < 4; c++) k->majorant[c] = majorant * k->unit[c];
  }
}

static vlFlightEnd sample_heterogeneous(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, bool emission,
                                        vlFlight *f, float radiance[4], float *t) {
  vlMediumLight whole = vl_medium_coefficients(m, f->lambda);
  Tracking k = {0};
  int h = f->hero;
  if (!start_tracking(m, &whole, o, d, t0, t1, f, &k)) return VL_FLIGHT_PASSED;
  while (next_collision(m, f, &k)) {
    if (k.collisions > MOST_COLLISIONS) return VL_FLIGHT_ENDED;
    bool gives = emission && m->emits;
    vlMediumLight at = vl_medium_at(m, &whole, f->lambda, vl_add(o, vl_mul(d, k.t)), gives);
    if (gives) {
      float density[4];
      for (int c = 0; c < 4; c++) density[c] = f->u[c] * k.majorant[c];
      float inv = 1.0f / vl_flight_mean(density, f->channels);
      for (int c = 0; c < 4; c++) radiance[c] += f->beta[c] * at.a[c] * at.le[c] * inv;
    }
    float none[4]; /* coefficients of null collisions */
    for (int c = 0; c < 4; c++) none[c] = vl_max(0.0f, k.majorant[c] - at.a[c] - at.s[c]);
    if (!m->scatters) {
      for (int c = 0; c < 4; c++) {
        f->beta[c] *= none[c] / k.majorant[h];
        f->u[c] *= k.majorant[c] / k.majorant[h];
        f->l[c] *= k.majorant[c] / k.majorant[h];
      }
      float carried = largest(f->beta) / vl_flight_mean(f->u, f->channels);
      if (!(carried > 0.0f)) return VL_FLIGHT_ENDED;
      if (carried < 0.05f) {
        if (vl_flight_random(f) < 0.75f) return VL_FLIGHT_ENDED;
        for (int c = 0; c < 4; c++) f->beta[c] *= 4.0f;
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
      return largest(f->beta) > 0.0f ? VL_FLIGHT_SCATTERED : VL_FLIGHT_ENDED;
    }
    if (!(none[h] > 0.0f)) return VL_FLIGHT_ENDED; /* only rounding comes here */
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

static void attenuate_heterogeneous(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, vlFlight *f) {
  vlMediumLight whole = vl_medium_coefficients(m, f->lambda);
  Tracking k = {0};
  int h = f->hero;
  if (!start_tracking(m, &whole, o, d, t0, t1, f, &k)) return;
  while (next_collision(m, f, &k)) {
    vlMediumLight at = vl_medium_at(m, &whole, f->lambda, vl_add(o, vl_mul(d, k.t)), false);
    float both[4];
    if (m->scatters) f->odds *= null_odds(m, vl_max(0.0f, k.majorant[h] - at.a[h] - at.s[h]), k.majorant[h]);
    for (int c = 0; c < 4; c++) {
      float none = vl_max(0.0f, k.majorant[c] - at.a[c] - at.s[c]) / k.majorant[h];
      float any = k.majorant[c] / k.majorant[h];
      f->beta[c] *= none;
      f->u[c] *= m->scatters ? none : any;
      f->l[c] *= any;
      both[c] = f->u[c] + f->l[c];
    }
    float carried = largest(f->beta) / vl_flight_mean(both, f->channels);
    if (carried < 0.05f) {
      bool ends = !(carried > 0.0f) || k.collisions > MOST_COLLISIONS || vl_flight_random(f) < 0.75f;
      for (int c = 0; c < 4; c++) f->beta[c] *= ends ? 0.0f : 4.0f;
      if (ends) return;
    }
    k.depth = exponential(vl_flight_random(f));
  }
}

/* ---- any --------------------------------------------------------------------------------------------------------- */

vlFlightEnd vl_fly(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, bool emission, vlFlight *f,
                   float radiance[4], float *t) {
  if (!(t1 > t0)) return VL_FLIGHT_PASSED;
  if (m->kind == VL_MEDIUM_HOMOGENEOUS) return fly_homogeneous(m, t0, t1, emission, f, radiance, t);
  return sample_heterogeneous(m, o, d, t0, t1, emission, f, radiance, t);
}

void vl_attenuate(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0, float t1, vlFlight *f) {
  if (!(t1 > t0)) return;
  if (m->kind == VL_MEDIUM_HOMOGENEOUS)
    attenuate_homogeneous(m, t0, t1, f);
  else
    attenuate_heterogeneous(m, o, d, t0, t1, f);
}
