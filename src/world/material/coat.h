/* world/material/coat.h: directional transmittance of a dielectric coat with an absorbing layer, tabulated when the
 * world is built.
 *
 * A coat (dielectric interface of roughness alpha, relative index eta) lies over a Lambertian base of albedo rho.
 * Between them is a layer of optical thickness tau that absorbs and does not scatter (pbrt's coateddiffuse with albedo
 * 0). A Lambertian base does not depend on the incident direction, so the random walk between the two (pbrt book 14.3)
 * has a closed form:
 *     f(wo, wi) = f_coat(wo, wi) + T(wo) T(wi) rho / (pi eta^2) * sum_{k < K} (rho R)^k
 * T(w) = int f_t(w, w') |cos w'| exp(-tau/|cos w'|) dw', f_t without radiance's 1/eta^2: share of a beam from w that
 * reaches the base. R: share of the base's cosine-weighted light that the coat reflects back to it, attenuated by
 * the layer twice. K: number of reflections at the base. pbrt's walk of max_depth steps alternates between base and
 * coat, beginning at the base: K = ceil(max_depth / 2). For a rough coat f_t and f_r are those of a rough dielectric
 * with single scattering, as in pbrt: the energy that the microfacets lose is lost here too. */
#ifndef WORLD_MATERIAL_COAT_H
#define WORLD_MATERIAL_COAT_H

#include "base/context.h"

enum { VL_COAT_COS = 96, VL_COAT_ALPHA = 32 };

typedef struct vlCoatTable {
  float eta, tau;
  uint32_t bounces; /* K, at most 255 */
  uint32_t alphas;  /* 1: alpha_min only; else VL_COAT_ALPHA rows in equal steps of sqrt(alpha) */
  float alpha_min, alpha_max;
  float row_start, row_scale; /* row = (sqrt(alpha) - row_start) * row_scale */
  /* T at cos = (i / (VL_COAT_COS - 1))^4; cubic interpolation between */
  float transmittance[VL_COAT_ALPHA][VL_COAT_COS];
  /* A T for wi that reproduces an error of pbrt-v4. pbrt-v4's walk combines two samplers for the exit through a
   * rough coat. The density that it compares one of them with belongs to light in the opposite direction, so that
   * the two MIS weights sum to more than 1: light found by light sampling is too bright (0.3 % at alpha 0.01, 2 % at
   * 0.1, 5 % at 0.2, 8 % at 0.4), light found by BSDF sampling is not. The error is a function of wi alone. The
   * BSDF's evaluation reads this table instead of transmittance if `imitate` is set, for comparisons with pbrt-v4's
   * images; vl_coat_build leaves `imitate` unset. */
  float imitation[VL_COAT_ALPHA][VL_COAT_COS];
  bool imitate;
  bool conserves;              /* see vl_coat_conserve */
  float back[VL_COAT_ALPHA];   /* R */
  float escape[VL_COAT_ALPHA]; /* share of the base's light that leaves directly: int T 2cos dcos / eta^2 */
} vlCoatTable;

/* Builds the tables for isotropic alpha between alpha_min and alpha_max (equal for untextured roughness; for an
 * anisotropic coat, the geometric mean). Below VL_GGX_SMOOTH (math/ggx.h) the interface is smooth. Deterministic
 * quadrature; relative errors of T and R: 1e-4 up to alpha 0.1, 4e-4 up to 1 (eta > 1); between the rows of textured
 * roughness 2e-3 for cos > 0.1, 1e-2 below. Takes 1.5 ms, textured 45 ms. Errors: ARGUMENT (eta <= 0, tau < 0,
 * alpha_min > alpha_max, ...), MEMORY. */
vlResult vl_coat_build(vlContext *context, float eta, float tau, uint32_t max_depth, float alpha_min, float alpha_max,
                       vlCoatTable **table);
/* Makes the coat of a built table keep all light: over a white base and without absorption nothing is lost, at any
 * roughness. What single scattering between microfacets loses goes to the base: T(w) becomes (1 - E(w)) T(w) / T0(w)
 * and R becomes R (1 - mean(1 - E) / eta^2) / R0, with E the coat's own reflectance from outside and T0, R0 those of
 * tau 0; the bounces have no bound but the series' own (255). As T stays a factor for each direction, the BSDF stays
 * reciprocal. Of a coat with eta < 1 the base gets no more than it can give back: a little is lost still. The error of
 * pbrt-v4 is not imitated then. Costs as much as two to three builds. MEMORY: the table is as it was. */
vlResult vl_coat_conserve(vlContext *context, vlCoatTable *table);
/* What the coat of the table's first row gives back of uniform light over a white base, 0 to 1. MEMORY. */
vlResult vl_coat_white_albedo(vlContext *context, const vlCoatTable *table, double *albedo);
void vl_coat_free(vlContext *context, vlCoatTable *table);

/* Position of T(cos) in the table: four nodes from `first` on, at t in [0, 3] among them. */
typedef struct vlCoatPlace {
  int32_t first;
  float t;
} vlCoatPlace;
static inline vlCoatPlace vl_coat_place(float cosine) {
  float c = cosine > 0.0f ? cosine : 0.0f;
  c = c < 1.0f ? c : 1.0f;
  float x = __builtin_sqrtf(__builtin_sqrtf(c)) * (float)(VL_COAT_COS - 1);
  int32_t first = (int32_t)x - 1;
  first = first > 0 ? first : 0;
  first = first < VL_COAT_COS - 4 ? first : VL_COAT_COS - 4;
  return (vlCoatPlace){first, x - (float)first};
}
/* Lagrange's cubic through four equally spaced values. */
static inline float vl_coat_cubic(float q0, float q1, float q2, float q3, float t) {
  float a = t - 1.0f, b = t - 2.0f, c = t - 3.0f;
  return 0.5f * ((q1 * t - q0 * a * (1.0f / 3.0f)) * b * c + (q3 * b * (1.0f / 3.0f) - q2 * c) * t * a);
}

#endif
