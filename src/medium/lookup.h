/* medium/lookup.h: coefficients of a medium at a point, and traversal of its
 * majorants by a ray. The functions are inline and take values, for the hot files of trace.
 * pbrt book 11.4. */
#ifndef MEDIUM_LOOKUP_H
#define MEDIUM_LOOKUP_H

#include "medium/grid_lookup.h"
#include "world/world.h"

/* ---- emission ---------------------------------------------------------------------------- */

/* Planck's law divided by its maximum, as for blackbody spectra (color/spectrum.c). lambda in
 * nm, temperature in kelvin. */
static inline float vl_blackbody_at(float lambda, float kelvin) {
  float x = 1.438776877e7f / (lambda * kelvin), r = x * (1.0f / 4.965114231744276f);
  float r2 = r * r;
  return x < 85.0f ? r2 * r2 * r * 142.32492f / (vl_exp(x) - 1.0f) : 0.0f;
}

static inline void vl_medium_blackbody(const vlWorldMedium *m, const float lambda[4],
                                       float value, float scale, float le[4]) {
  float kelvin = (value - m->temperature_offset) * m->temperature_scale;
  if (!(kelvin > 100.0f))
    return;
  if (m->blackbody_rgb) {
    float at = vl_clamp(vl_ln(kelvin * (1.0f / VL_BLACKBODY_LOW)) * (32.0f / 0.69314718f), 0.0f,
                        (float)(VL_BLACKBODY_STEPS - 1));
    int32_t k = (int32_t)at;
    k = k < VL_BLACKBODY_STEPS - 2 ? k : VL_BLACKBODY_STEPS - 2;
    float f = at - (float)k;
    const float *a = m->blackbody_rgb + 3 * k;
    for (int c = 0; c < 3; c++)
      le[c] = scale * (a[c] + f * (a[c + 3] - a[c]));
    return;
  }
  for (int c = 0; c < 4; c++)
    le[c] = scale * vl_blackbody_at(lambda[c], kelvin);
}

/* ---- the medium at a point --------------------------------------------------------------- */

/* Trilinear lookup in a grid of colours, times scale. Each colour is converted to a spectrum
 * before interpolation. */
static inline void vl_rgb_lookup(const vlWorldMedium *m, const vlDenseGrid *g,
                                 const float lambda[4], vlVec3 q, float scale, float out[4]) {
  vlTrilinear at = vl_dense_at_point(g, q);
  bool rgb = m->illuminant.kind == VL_SPECTRAL_RGB;
  for (int c = 0; c < 4; c++)
    out[c] = 0;
  for (int k = 0; k < 8; k++) {
    size_t cell = vl_dense_cell(g, at, k);
    if (cell == (size_t)-1)
      continue;
    const float *v = g->values + 4 * cell;
    float w = vl_trilinear_weight(at, k) * scale;
    vlSigmoid sigmoid = {v[0], v[1], v[2]};
    for (int c = 0; c < 4; c++)
      out[c] += w * (rgb ? (c < 3 ? v[c] : 0.0f) : v[3] * vl_sigmoid(sigmoid, lambda[c]));
  }
}

/* Coefficients at 4 channels. vl_medium_coefficients gives the part that does not depend on
 * position and is called once per flight; vl_medium_at gives the coefficients at a point. */
typedef struct vlMediumLight {
  float a[4], s[4], le[4];
} vlMediumLight;

static inline vlMediumLight vl_medium_coefficients(const vlWorldMedium *m,
                                                   const float lambda[4]) {
  vlMediumLight r;
  for (int c = 0; c < 4; c++) {
    r.a[c] = vl_spectral_at(&m->sigma_a, c, lambda[c]);
    r.s[c] = vl_spectral_at(&m->sigma_s, c, lambda[c]);
    r.le[c] = m->emits ? vl_spectral_at(&m->emission, c, lambda[c]) : 0.0f;
  }
  return r;
}

static inline vlMediumLight vl_rgb_medium_at(const vlWorldMedium *m, const float lambda[4],
                                             vlVec3 q, bool emission) {
  vlMediumLight r;
  for (int c = 0; c < 4; c++) {
    r.a[c] = r.s[c] = m->rgb_scale;
    r.le[c] = 0.0f;
  }
  if (m->rgb_a.values)
    vl_rgb_lookup(m, &m->rgb_a, lambda, q, m->rgb_scale, r.a);
  if (m->rgb_s.values)
    vl_rgb_lookup(m, &m->rgb_s, lambda, q, m->rgb_scale, r.s);
  if (!emission || !m->rgb_emission.values)
    return r;
  vl_rgb_lookup(m, &m->rgb_emission, lambda, q, m->rgb_emission_scale, r.le);
  for (int c = 0; c < 4; c++)
    r.le[c] *= vl_spectral_at(&m->illuminant, c, lambda[c]);
  return r;
}

/* Density at a point, which multiplies the coefficients. p: the point in medium space; q: the
 * point relative to the box, 0 to 1. Each kind has its own function (medium/kinds.row.h). */
typedef float vlMediumDensity(const vlWorldMedium *m, vlVec3 p, vlVec3 q);
vlMediumDensity vl_medium_density;

/* Coefficients at a point (world space) of a medium that is not uniform. whole: result of
 * vl_medium_coefficients. */
static inline vlMediumLight vl_medium_at(const vlWorldMedium *m, const vlMediumLight *whole,
                                         const float lambda[4], vlVec3 world_p, bool emission) {
  vlVec3 p = vl_affine_point(m->medium_from_world, world_p);
  vlVec3 q = vl_vec3((p.x - m->low[0]) / (m->high[0] - m->low[0]),
                     (p.y - m->low[1]) / (m->high[1] - m->low[1]),
                     (p.z - m->low[2]) / (m->high[2] - m->low[2]));
  if (m->own_sigma)
    return vl_rgb_medium_at(m, lambda, q, emission);
  float density = vl_medium_density(m, p, q);
  density = density > 0.0f ? density : 0.0f;
  vlMediumLight r;
  for (int c = 0; c < 4; c++) {
    r.a[c] = density * whole->a[c];
    r.s[c] = density * whole->s[c];
    r.le[c] = 0.0f;
  }
  if (!emission || !m->emits)
    return r;
  float scale = m->emission_scales.values ? vl_dense_lookup(&m->emission_scales, q) : 1.0f;
  if (m->temperature.values)
    vl_medium_blackbody(m, lambda, vl_dense_lookup(&m->temperature, q),
                        scale * m->temperature_emission, r.le);
  else if (m->sparse_temperature)
    vl_medium_blackbody(m, lambda, vl_sparse_lookup(m->sparse_temperature, p),
                        scale * m->temperature_emission, r.le);
  else
    for (int c = 0; c < 4; c++)
      r.le[c] = scale * whole->le[c];
  return r;
}

/* Scalar extinction of a medium at a point (world space), > 0: the mean of sigma_t at three
 * fixed wavelengths, or of R, G, B. It serves for weights that must not depend on a path's
 * wavelengths. It is at least 1e-20, so that its reciprocal, a mean free path, times 1e18 is
 * finite. */
static inline float vl_extinction_of(const vlMediumLight *x) {
  return vl_max((x->a[0] + x->s[0] + x->a[1] + x->s[1] + x->a[2] + x->s[2]) * (1.0f / 3.0f),
                1e-20f);
}
static const float vl_extinction_lambda[4] = {450.0f, 540.0f, 610.0f, 610.0f};
static inline float vl_medium_mean_extinction(const vlWorldMedium *m) {
  vlMediumLight whole = vl_medium_coefficients(m, vl_extinction_lambda);
  return vl_extinction_of(&whole);
}
static inline float vl_medium_extinction(const vlWorldMedium *m, vlVec3 p) {
  if (m->uniform)
    return m->extinction;
  vlMediumLight whole = vl_medium_coefficients(m, vl_extinction_lambda);
  vlMediumLight at = vl_medium_at(m, &whole, vl_extinction_lambda, p, false);
  return vl_extinction_of(&at);
}

/* ---- majorants --------------------------------------------------------------------------- */

/* Traversal of the majorant grid by a ray (Amanatides and Woo 1987; pbrt book 11.4.2). */
typedef struct vlMajorantWalk {
  const vlWorldMedium *medium;
  float t, end;
  float next[3], step[3]; /* t at which the ray leaves its cell along each axis, and the step of
                             t per cell */
  int32_t at[3], way[3];
} vlMajorantWalk;

/* Starts a traversal. o, d: ray in world space. False if the segment [t0, t1] misses the
 * box. */
static inline bool vl_majorant_start(const vlWorldMedium *m, vlVec3 o, vlVec3 d, float t0,
                                     float t1, vlMajorantWalk *w) {
  vlVec3 po = vl_affine_point(m->medium_from_world, o),
         pd = vl_affine_vector(m->medium_from_world, d);
  const float from[3] = {po.x, po.y, po.z}, along[3] = {pd.x, pd.y, pd.z};
  for (int i = 0; i < 3; i++) {
    if (along[i] == 0.0f) {
      if (from[i] < m->low[i] || from[i] > m->high[i])
        return false;
      continue;
    }
    float a = (m->low[i] - from[i]) / along[i], b = (m->high[i] - from[i]) / along[i];
    t0 = vl_max(t0, vl_min(a, b));
    t1 = vl_min(t1, vl_max(a, b));
  }
  if (!(t0 < t1))
    return false;
  w->medium = m;
  w->t = t0;
  w->end = t1;
  for (int i = 0; i < 3; i++) {
    float n = (float)m->cells[i], scale = n / (m->high[i] - m->low[i]);
    float here = (from[i] + t0 * along[i] - m->low[i]) * scale, speed = along[i] * scale;
    int32_t k = (int32_t)vl_clamp(here, 0.0f, n - 1.0f);
    w->at[i] = k;
    w->way[i] = speed < 0.0f ? -1 : 1;
    w->step[i] = speed != 0.0f ? vl_abs(1.0f / speed) : VL_INFINITY;
    w->next[i] =
        speed != 0.0f ? t0 + ((float)(speed > 0.0f ? k + 1 : k) - here) / speed : VL_INFINITY;
  }
  return true;
}

/* Gives the next segment of the ray and its majorant. False at the end of the ray. */
static inline bool vl_majorant_next(vlMajorantWalk *w, float *t0, float *t1, float *majorant) {
  const vlWorldMedium *m = w->medium;
  if (!(w->t < w->end))
    return false;
  *majorant = m->majorants[((size_t)w->at[2] * m->cells[1] + (size_t)w->at[1]) * m->cells[0] +
                           (size_t)w->at[0]];
  int axis = w->next[0] < w->next[1] ? (w->next[0] < w->next[2] ? 0 : 2)
                                     : (w->next[1] < w->next[2] ? 1 : 2);
  *t0 = w->t;
  *t1 = vl_max(vl_min(w->next[axis], w->end), w->t);
  w->t = *t1;
  w->at[axis] += w->way[axis];
  w->next[axis] += w->step[axis];
  if (w->at[axis] < 0 || w->at[axis] >= (int32_t)m->cells[axis]) {
    *t1 = w->end; /* at the last cell rounding may leave a short rest */
    w->t = w->end;
  }
  return true;
}

#endif
