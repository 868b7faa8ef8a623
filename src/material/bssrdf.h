/* material/bssrdf.h: subsurface scattering in a homogeneous solid: a radially symmetric
 * profile over the surface, tabulated over albedo and optical radius, as in pbrt-v4's
 * subsurface material. The model is photon beam diffusion (Habel, Christensen and Jarosz 2013;
 * pbrt book, 3rd edition, 11.4, 15.4, 15.5): a beam enters the solid perpendicularly. Multiple
 * scattering is the integral over the beam of a dipole at each point; single scattering is an
 * integral along the beam too.
 *
 * Radii are in units of the mean free path, 1 / (sigma_a + sigma_s). Catmull-Rom splines
 * interpolate between the table's nodes in both directions. The lookups are inlined by the hot
 * files. */
#ifndef MATERIAL_BSSRDF_H
#define MATERIAL_BSSRDF_H

#include "base/context.h"
#include "math/approx.h"
#include "math/warp.h"

enum { VL_BSSRDF_ALBEDOS = 100, VL_BSSRDF_RADII = 64 };

typedef struct vlBssrdfTable {
  float eta, g;
  float leaves; /* share of diffuse light that the surface transmits: 1 - 2 int Fr cos dcos */
  float albedo[VL_BSSRDF_ALBEDOS], radius[VL_BSSRDF_RADII];
  /* 2 pi r R(r). R(r) is the light that leaves per unit of area at distance r from the beam,
   * per unit of light that entered. */
  float profile[VL_BSSRDF_ALBEDOS][VL_BSSRDF_RADII];
  /* integral of profile from 0 to the node's radius */
  float cdf[VL_BSSRDF_ALBEDOS][VL_BSSRDF_RADII];
  /* integral of profile over all radii: share of the light that leaves again */
  float effective[VL_BSSRDF_ALBEDOS];
} vlBssrdfTable;

/* Fills a table, on all workers. eta > 0: index inside over index outside. -1 < g < 1: mean
 * cosine of scattering. */
void vl_bssrdf_build(vlContext *context, float eta, float g, vlBssrdfTable *table);

/* ---- splines ----------------------------------------------------------------------------- */

/* Weights of the four nodes from `first` on. Nodes outside the table have weight zero. */
typedef struct vlSpline {
  uint32_t first;
  float w[4];
} vlSpline;

/* The spline's weights at x, which lies in interval i of the n nodes. */
static inline vlSpline vl_spline_in(const float *nodes, uint32_t n, uint32_t i, float x) {
  float x0 = nodes[i], x1 = nodes[i + 1], width = x1 - x0;
  float t = (x - x0) / width, t2 = t * t, t3 = t2 * t;
  /* Cubic Hermite basis. The slope at each node is a central difference; at the border of the
   * table it is one-sided. */
  float begin = t3 - 2 * t2 + t, end = t3 - t2, w0 = 0, w1 = 2 * t3 - 3 * t2 + 1,
        w2 = 3 * t2 - 2 * t3, w3 = 0;
  if (i > 0) {
    float s = begin * width / (x1 - nodes[i - 1]);
    w0 = -s;
    w2 += s;
  } else {
    w1 -= begin;
    w2 += begin;
  }
  if (i + 2 < n) {
    float s = end * width / (nodes[i + 2] - x0);
    w1 -= s;
    w3 = s;
  } else {
    w1 -= end;
    w2 += end;
  }
  if (i == 0)
    return (vlSpline){0, {w1, w2, w3, 0}};
  if (i + 2 == n)
    return (vlSpline){i - 2, {0, w0, w1, w2}};
  return (vlSpline){i - 1, {w0, w1, w2, w3}};
}

/* The cubic between two nodes at distance `width`, as a function of t from 0 to 1: f is its
 * value, F its integral divided by width. */
typedef struct vlSplinePiece {
  float f0, f1, d0, d1;
} vlSplinePiece;
static inline float vl_spline_value(vlSplinePiece p, float t) {
  return p.f0 + t * (p.d0 + t * (3 * (p.f1 - p.f0) - 2 * p.d0 - p.d1 +
                                 t * (p.d0 + p.d1 + 2 * (p.f0 - p.f1))));
}
static inline float vl_spline_slope(vlSplinePiece p, float t) {
  return p.d0 + t * (2 * (3 * (p.f1 - p.f0) - 2 * p.d0 - p.d1) +
                     3 * t * (p.d0 + p.d1 + 2 * (p.f0 - p.f1)));
}
static inline float vl_spline_integral(vlSplinePiece p, float t) {
  return t *
         (p.f0 + t * (0.5f * p.d0 + t * ((p.f1 - p.f0 - (2 * p.d0 + p.d1) * (1.0f / 3.0f)) +
                                         t * (0.25f * (p.d0 + p.d1) + 0.5f * (p.f0 - p.f1)))));
}
/* Makes the cubic of interval i, with the same slopes as vl_spline_in. f: values at the nodes i
 * - 1 to i + 2; values outside the table are not read. */
static inline vlSplinePiece vl_spline_piece(const float *nodes, uint32_t n, uint32_t i,
                                            const float f[4]) {
  float width = nodes[i + 1] - nodes[i];
  vlSplinePiece p = {f[1], f[2], f[2] - f[1], f[2] - f[1]};
  if (i > 0)
    p.d0 = width * (f[2] - f[0]) / (nodes[i + 1] - nodes[i - 1]);
  if (i + 2 < n)
    p.d1 = width * (f[3] - f[1]) / (nodes[i + 2] - nodes[i]);
  return p;
}
/* Finds t in [0, 1] where the value (or the integral) equals u; u lies between its values at
 * both ends. It uses Newton's method, and bisects if a step leaves the bracket. */
static inline float vl_spline_solve(vlSplinePiece p, float u, int integral, float tolerance) {
  float low = 0, high = 1, t = 0.5f;
  for (int k = 0; k < 40; k++) {
    float f = (integral ? vl_spline_integral(p, t) : vl_spline_value(p, t)) - u;
    if ((f < 0 ? -f : f) <= tolerance || high - low < 1e-6f)
      break; /* tolerance: a few rounding errors */
    if (f < 0)
      low = t;
    else
      high = t;
    float slope = integral ? vl_spline_value(p, t) : vl_spline_slope(p, t),
          next = t - f / slope;
    t = next > low && next < high ? next : 0.5f * (low + high);
  }
  return t;
}

/* ---- lookups ----------------------------------------------------------------------------- */

static inline vlSpline vl_bssrdf_albedo(const vlBssrdfTable *table, float albedo) {
  const float *nodes = table->albedo;
  const uint32_t last = VL_BSSRDF_ALBEDOS - 1;
  if (!(albedo >= nodes[0] && albedo <= nodes[last]))
    return (vlSpline){0, {0, 0, 0, 0}};
  return vl_spline_in(nodes, last + 1, vl_find_interval(nodes, last, albedo), albedo);
}
static inline float vl_bssrdf_mix(const vlSpline *a, const float *row0, uint32_t stride) {
  const float *row = row0 + (size_t)a->first * stride;
  return a->w[0] * row[0] + a->w[1] * row[stride] + a->w[2] * row[2 * stride] +
         a->w[3] * row[3 * stride];
}
static inline float vl_bssrdf_effective(const vlBssrdfTable *table, const vlSpline *albedo) {
  return vl_bssrdf_mix(albedo, table->effective, 1);
}
/* Finds the interval of a radius. Radii grow by a factor of 1.2 per node, so a logarithm
 * estimates the interval; comparison with the nodes corrects it. */
static inline uint32_t vl_bssrdf_cell(const vlBssrdfTable *table, float r) {
  float guess = 1.0f + vl_ln(r * 400.0f + VL_MIN_POSITIVE) * 5.48481494f;
  uint32_t i = guess > 1.0f ? (uint32_t)guess : 0;
  i = i < VL_BSSRDF_RADII - 2 ? i : VL_BSSRDF_RADII - 2;
  i -= i > 0 && r < table->radius[i];
  i += i < VL_BSSRDF_RADII - 2 && r >= table->radius[i + 1];
  return i;
}
/* 2 pi r R(r); 0 for radii beyond the table. */
static inline float vl_bssrdf_ring(const vlBssrdfTable *table, const vlSpline *albedo,
                                   float r) {
  if (!(r >= 0 && r <= table->radius[VL_BSSRDF_RADII - 1]))
    return 0;
  vlSpline s = vl_spline_in(table->radius, VL_BSSRDF_RADII, vl_bssrdf_cell(table, r), r);
  float sum = 0;
  for (uint32_t k = 0; k < 4; k++)
    sum += s.w[k] * vl_bssrdf_mix(albedo, &table->profile[0][s.first + k], VL_BSSRDF_RADII);
  return sum > 0 ? sum : 0;
}
/* R(r). 2 pi r R(r) is linear near r = 0, so the value at a small radius is used there. */
static inline float vl_bssrdf_at(const vlBssrdfTable *table, const vlSpline *albedo, float r) {
  const float near = 1e-4f;
  float x = r > near ? r : near;
  return vl_bssrdf_ring(table, albedo, x) / (6.28318530717958648f * x);
}
/* Samples a radius from u in [0, 1), with density 2 pi r R(r) / effective. Negative if no light
 * leaves. */
static inline float vl_bssrdf_sample(const vlBssrdfTable *table, const vlSpline *albedo,
                                     float u) {
  float whole = vl_bssrdf_effective(table, albedo);
  if (!(whole > 0))
    return -1;
  u *= whole;
  uint32_t low = 0, high = VL_BSSRDF_RADII - 1;
  while (high - low > 1) {
    uint32_t middle = (low + high) / 2;
    if (vl_bssrdf_mix(albedo, &table->cdf[0][middle], VL_BSSRDF_RADII) <= u)
      low = middle;
    else
      high = middle;
  }
  float f[4] = {0, 0, 0, 0};
  for (uint32_t k = 0; k < 4; k++)
    if (low + k >= 1 && low + k <= VL_BSSRDF_RADII)
      f[k] = vl_bssrdf_mix(albedo, &table->profile[0][low + k - 1], VL_BSSRDF_RADII);
  float x0 = table->radius[low], width = table->radius[low + 1] - x0;
  float within = (u - vl_bssrdf_mix(albedo, &table->cdf[0][low], VL_BSSRDF_RADII)) / width;
  vlSplinePiece p = vl_spline_piece(table->radius, VL_BSSRDF_RADII, low, f);
  return x0 + width * vl_spline_solve(p, within, 1, 1e-6f * vl_spline_integral(p, 1));
}
/* Gives the single-scattering albedo for a given reflectance of the solid: the inverse of
 * `effective`. */
static inline float vl_bssrdf_invert(const vlBssrdfTable *table, float effective) {
  const uint32_t n = VL_BSSRDF_ALBEDOS;
  if (!(effective > table->effective[0]))
    return table->albedo[0];
  if (!(effective < table->effective[n - 1]))
    return table->albedo[n - 1];
  uint32_t i = vl_find_interval(table->effective, n - 1, effective);
  float f[4];
  for (uint32_t k = 0; k < 4; k++) {
    uint32_t j = i + k;
    f[k] = table->effective[j < 1 ? 0 : j > n ? n - 1 : j - 1];
  }
  float x0 = table->albedo[i], width = table->albedo[i + 1] - x0;
  return x0 +
         width * vl_spline_solve(vl_spline_piece(table->albedo, n, i, f), effective, 0, 1e-6f);
}

#endif
