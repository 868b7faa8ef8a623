/* world/coat.h: directional transmittance of a dielectric coat with an absorbing layer, tabulated when the world is built.
 *
 * A coat (dielectric interface of roughness alpha, relative index eta) lies over a Lambertian base of albedo rho, between them
 * a layer of optical thickness tau (pbrt's coateddiffuse: thickness times 1, no scattering). Since the base forgets direction, the random
 * walk between the two (pbrt book 14.3) has a closed form:
 *   f(wo, wi) = f_coat(wo, wi) + T(wo) T(wi) rho / (pi eta^2) * sum_{k < K} (rho R)^k
 * T(w): energy that comes down to the base from direction w (transmission times exp(-tau/cos) inside), R: share of the base's
 * cosine-weighted light that the coat sends back to it (twice through the layer), K bounces from max_depth. */
#ifndef WORLD_COAT_H
#define WORLD_COAT_H

#include "base/context.h"

enum { VL_COAT_COS = 64, VL_COAT_ALPHA = 32 };

typedef struct vlCoatTable {
  float eta, tau;
  uint32_t bounces;        /* K */
  uint32_t alphas;         /* 1: alpha_min only; else VL_COAT_ALPHA rows from alpha_min to alpha_max (equal steps in sqrt(alpha)) */
  float alpha_min, alpha_max;
  float transmittance[VL_COAT_ALPHA][VL_COAT_COS]; /* T at cos = (i + 0.5)/64-like nodes, see coat.c */
  float back[VL_COAT_ALPHA];                       /* R */
} vlCoatTable;

/* Isotropic alpha between alpha_min and alpha_max (equal for untextured roughness). Deterministic quadrature. */
vlResult vl_coat_build(vlContext *context, float eta, float tau, uint32_t max_depth, float alpha_min, float alpha_max,
                       vlCoatTable **table);
void vl_coat_free(vlContext *context, vlCoatTable *table);

#endif
