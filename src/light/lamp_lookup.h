/* light/lamp_lookup.h: the intensity of a luminaire in a direction, and directions sampled by
 * the flux of the table's cells; inline, for the hot loops. */
#ifndef LIGHT_LAMP_LOOKUP_H
#define LIGHT_LAMP_LOOKUP_H

#include "light/lamp.h"
#include "math/approx.h"
#include "math/vec.h"
#include "math/warp.h"

/* Directions this far outside of the table (radians) are at its edge: rounding. */
#define VL_LAMP_EDGE 1e-5f

/* The cell of a direction and the position in it. */
typedef struct vlLampCell {
  uint32_t azimuth, polar; /* of the cell's first corner */
  float across, down;      /* from 0 to 1 */
  bool inside;             /* false: outside of the table; the rest is not set */
} vlLampCell;

/* d: unit, in the table's own frame. */
static inline vlLampCell vl_lamp_cell(const vlLampTable *t, vlVec3 d) {
  vlLampCell p = {0};
  float polar = vl_atan2(__builtin_sqrtf(d.x * d.x + d.y * d.y), d.z);
  float azimuth = vl_atan2(d.y, d.x);
  if (azimuth < t->azimuth[0] - VL_LAMP_EDGE)
    azimuth += 2.0f * VL_PI;
  if (!(polar >= t->polar[0] - VL_LAMP_EDGE) ||
      !(polar <= t->polar[t->polars - 1] + VL_LAMP_EDGE) ||
      !(azimuth <= t->azimuth[t->azimuths - 1] + VL_LAMP_EDGE))
    return p;
  p.azimuth = vl_find_interval(t->azimuth, t->azimuths - 1, azimuth);
  p.polar = vl_find_interval(t->polar, t->polars - 1, polar);
  const float *a = t->azimuth + p.azimuth, *b = t->polar + p.polar;
  p.across = vl_clamp((azimuth - a[0]) / (a[1] - a[0]), 0.0f, 1.0f);
  p.down = vl_clamp((polar - b[0]) / (b[1] - b[0]), 0.0f, 1.0f);
  p.inside = true;
  return p;
}

/* Candela; d as in vl_lamp_cell. */
static inline float vl_lamp_candela(const vlLampTable *t, vlVec3 d) {
  vlLampCell p = vl_lamp_cell(t, d);
  if (!p.inside)
    return 0.0f;
  const float *left = t->candela + (size_t)p.azimuth * t->polars + p.polar;
  const float *right = left + t->polars;
  float near = left[0] + (left[1] - left[0]) * p.down;
  float far = right[0] + (right[1] - right[0]) * p.down;
  return near + (far - near) * p.across;
}

/* Density per solid angle with which vl_lamp_sample gives d. */
static inline float vl_lamp_density(const vlLampTable *t, vlVec3 d) {
  vlLampCell p = vl_lamp_cell(t, d);
  return p.inside ? t->density[(size_t)p.azimuth * (t->polars - 1) + p.polar] : 0.0f;
}

/* A direction (unit, in the table's frame) with a density proportional to the flux of the
 * cells, even within a cell. u, v: random numbers in [0, 1). The table's flux is above 0. */
static inline vlVec3 vl_lamp_sample(const vlLampTable *t, float u, float v, float *density) {
  uint32_t i = vl_find_cell(t->columns, t->azimuths - 1, u, &u);
  uint32_t j = vl_find_cell(t->below + (size_t)i * t->polars, t->polars - 1, v, &v);
  float azimuth = t->azimuth[i] + (t->azimuth[i + 1] - t->azimuth[i]) * u;
  vlSinCos low = vl_sincos(0.5f * t->polar[j]), high = vl_sincos(0.5f * t->polar[j + 1]);
  /* even in the cosine, which is 1 - 2 s2; s2, the squared sine of half the angle, keeps its
   * digits near the pole */
  float s2 = low.sin * low.sin + (high.sin * high.sin - low.sin * low.sin) * v;
  float across = 2.0f * vl_safe_sqrt(s2 * (1.0f - s2));
  vlSinCos turn = vl_sincos(azimuth);
  *density = t->density[(size_t)i * (t->polars - 1) + j];
  return vl_vec3(across * turn.cos, across * turn.sin, 1.0f - 2.0f * s2);
}

#endif
