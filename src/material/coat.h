/* material/coat.h: directional transmittance of a dielectric coat with an absorbing
 * layer, tabulated when the world is built.
 *
 * A coat (dielectric interface of roughness alpha, relative index eta) lies over a Lambertian
 * base of albedo rho. Between them is a layer of optical thickness tau that absorbs and does
 * not scatter (pbrt's coateddiffuse with albedo 0). A Lambertian base does not depend on the
 * incident direction, so the random walk between coat and base (pbrt book 14.3) has a closed
 * form:
 *
 *   f(wo, wi) = f_coat(wo, wi) + T(wo) T(wi) rho / (pi eta^2) sum_{k < K} (rho R)^k
 *   T(w) = int f_t(w, w') |cos w'| exp(-tau / |cos w'|) dw'
 *
 * T(w) is the share of a beam from w that reaches the base; f_t is the BTDF of the interface
 * without the factor 1/eta^2 of radiance. R is the share of the diffuse light from the base
 * that the coat reflects back to the base; the layer attenuates it twice. K is the number of
 * reflections at the base. pbrt's walk of max_depth steps alternates between base and coat and
 * begins at the base, so K = ceil(max_depth / 2). For a rough coat, f_t and the BRDF are those
 * of a rough dielectric with single scattering, as in pbrt: the energy of multiple scattering
 * between microfacets is lost.
 */
#ifndef MATERIAL_COAT_H
#define MATERIAL_COAT_H

#include "base/context.h"

enum { VL_COAT_COS = 96, VL_COAT_ALPHA = 32, VL_COAT_AZIMUTHS = 25 };

typedef struct vlCoatTable {
  float eta, tau;
  uint32_t bounces; /* K, at most 255 */
  uint32_t rows;    /* 1 for alpha_min only; VL_COAT_ALPHA in equal steps of sqrt(alpha); or
                       VL_COAT_AZIMUTHS */
  float alpha_min, alpha_max;
  /* Anisotropic: alpha_min and alpha_max are those of the two axes, and T depends on the
   * azimuth of w. It is even in w.x and in w.y, so the rows are equal steps of sqrt(r), from 0
   * to 1, with r = |w.y| / sqrt(w.x^2 + w.y^2) if rough_y is set, else |w.x| / ...: densest
   * near the axis of alpha_min, where T changes fastest. */
  bool anisotropic, rough_y;
  float row_start, row_scale; /* row = (sqrt(alpha) - row_start) * row_scale */
  /* T at cos = (i / (VL_COAT_COS - 1))^4; lookups interpolate by cubics */
  float transmittance[VL_COAT_ALPHA][VL_COAT_COS];
  /* A variant of T(wi) that reproduces an error of pbrt-v4. pbrt-v4's walk combines two
   * samplers for the exit through a rough coat. The MIS weight of one sampler uses a density
   * for light in the opposite direction, so that the two weights sum to more than 1. Light
   * found by light sampling is therefore too bright (by 0.3 % at alpha 0.01, 2 % at 0.1, 5 % at
   * 0.2, 8 % at 0.4); light found by BSDF sampling is correct. The error is a function of wi
   * alone. The BSDF's evaluation reads this table instead of transmittance if `imitate` is set,
   * for comparisons with pbrt-v4's images; vl_coat_build leaves `imitate` unset. */
  float imitation[VL_COAT_ALPHA][VL_COAT_COS];
  bool imitate;
  bool conserves;              /* vl_coat_conserve has changed the table */
  float back[VL_COAT_ALPHA];   /* R; anisotropic: the same in each row, as is escape */
  float escape[VL_COAT_ALPHA]; /* share of the light from the base that leaves without
                                  reflection at the coat: int T 2cos dcos / eta^2 */
} vlCoatTable;

/* Builds the tables for isotropic alpha between alpha_min and alpha_max (equal for untextured
 * roughness). Below VL_GGX_SMOOTH (math/ggx.h) the interface is smooth. The quadrature is
 * deterministic. Relative errors of T and R for eta > 1: 1e-4 up to alpha 0.1, 4e-4 up to alpha
 * 1. Interpolation between rows adds up to 2e-3 for cos > 0.1 and 1e-2 below. A build takes 1.5
 * ms for one roughness, 45 ms for a range. Errors: ARGUMENT (eta <= 0, tau < 0, alpha_min >
 * alpha_max, ...), MEMORY. */
vlResult vl_coat_build(vlContext *context, float eta, float tau, uint32_t max_depth,
                       float alpha_min, float alpha_max, vlCoatTable **table);
/* The same for an interface of two alphas, along x and along y. Interpolation between azimuths
 * adds up to 2e-3 for alphas of 0.05 and more, and 1e-2 below. A build takes 100 ms. Errors:
 * ARGUMENT, MEMORY. */
vlResult vl_coat_build_anisotropic(vlContext *context, float eta, float tau, uint32_t max_depth,
                                   float alpha_x, float alpha_y, vlCoatTable **table);
/* Makes the coat of a built table keep all light: over a white base and without absorption
 * nothing is lost, at any roughness. The base receives the light that single scattering between
 * microfacets loses: T(w) becomes (1 - E(w)) T(w) / T0(w) and R becomes R (1 - mean(1 - E) /
 * eta^2) / R0, where E is the reflectance of the coat alone from outside, and T0, R0 are T, R
 * for tau = 0. The number of bounces K becomes 255, the largest possible. The BSDF stays
 * reciprocal, because T remains a factor for each direction. If eta < 1, the base receives at
 * most as much light as it can return, so that a little light is still lost. The error of
 * pbrt-v4 is not imitated for such a table. The call takes two to three times as long as a
 * build. Error: MEMORY; the table is then unchanged. */
vlResult vl_coat_conserve(vlContext *context, vlCoatTable *table);
/* Gives the albedo, 0 to 1, of the coat in the table's first row over a white base under
 * uniform light. Error: MEMORY. */
vlResult vl_coat_white_albedo(vlContext *context, const vlCoatTable *table, double *albedo);
void vl_coat_free(vlContext *context, vlCoatTable *table);

/* Position of T(cos) in the table: four nodes from `first` on, at t in [0, 3] among them. */
typedef struct vlCoatCell {
  int32_t first;
  float t;
} vlCoatCell;
static inline vlCoatCell vl_coat_cell(float cosine) {
  float c = cosine > 0.0f ? cosine : 0.0f;
  c = c < 1.0f ? c : 1.0f;
  float x = __builtin_sqrtf(__builtin_sqrtf(c)) * (float)(VL_COAT_COS - 1);
  int32_t first = (int32_t)x - 1;
  first = first > 0 ? first : 0;
  first = first < VL_COAT_COS - 4 ? first : VL_COAT_COS - 4;
  return (vlCoatCell){first, x - (float)first};
}
/* Lagrange's cubic through four equally spaced values. */
static inline float vl_coat_cubic(float q0, float q1, float q2, float q3, float t) {
  float a = t - 1.0f, b = t - 2.0f, c = t - 3.0f;
  return 0.5f * ((q1 * t - q0 * a * (1.0f / 3.0f)) * b * c +
                 (q3 * b * (1.0f / 3.0f) - q2 * c) * t * a);
}

#endif
