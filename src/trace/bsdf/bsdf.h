/* trace/bsdf/bsdf.h: BSDFs over batches of one kind. All directions are in the local shading frame, z the shading
 * normal; wo and wi point away from the surface. There are 4 channels: 4 wavelengths, or R, G, B and an unused one; the
 * code is the same for both.
 *
 *   eval:   value[c] = f(wo, wi) |cos wi|, pdf = density of sampling wi (solid angle); specular (delta) parts are 0
 *   sample: wi; weight[c] = f |cos| / pdf; pdf (for delta parts: the discrete probability, flag set); flags
 * Radiance is transported (camera paths): transmission into a denser medium has the factor 1/eta^2 (pbrt book 9.5.2).
 * References: pbrt-v4 book chapter 9; Walter et al. 2007; Heitz 2018 / Dupuy and Benyoub 2023 (visible normals). */
#ifndef TRACE_BSDF_BSDF_H
#define TRACE_BSDF_BSDF_H

#include "base/isa.h"
#include "velo/base.h"
#include "world/material/bsdf_kind.h"
#include "world/material/coat.h"
#include "world/material/measured.h"

/* Parameter rows whose meaning depends on the kind: VL_P_ of the principled kind, and so on below. A kind of a single
 * file may number them there. */
enum { VL_BSDF_ROWS = 26 };

/* Rows of the principled material. Its base colour is reflectance, its roughness alpha_x and alpha_y (at least 1e-3).
 * F0 is that of the dielectric. COAT_X, Y, Z: the coat's normal, unit, z > 0. */
enum {
  VL_P_METALLIC,
  VL_P_F0,
  VL_P_F90 = VL_P_F0 + 4,
  VL_P_TRANSMISSION,
  VL_P_THIN, /* 1: a thin sheet, or opaque; 0: a solid of index eta_s */
  VL_P_DIFFUSE_TRANSMISSION,
  VL_P_THROUGH, /* colour of the diffuse transmission */
  VL_P_COAT = VL_P_THROUGH + 4,
  VL_P_COAT_ALPHA,
  VL_P_COAT_X,
  VL_P_COAT_Y,
  VL_P_COAT_Z,
  VL_P_SHEEN,
  VL_P_SHEEN_ALPHA = VL_P_SHEEN + 4,
  VL_P_FILM,
  VL_P_FILM_INDEX,
  VL_P_FILM_NM
};
_Static_assert((int)VL_P_FILM_NM < (int)VL_BSDF_ROWS, "enough rows");

/* Diffuse transmission, layers, hair, subsurface. */
enum { VL_T_TRANSMITTANCE /* 4 */ };
enum {
  VL_L_METAL, /* 1: the base is metal of eta, k (over the coat's index); 0: diffuse, of reflectance */
  VL_L_BASE_X,
  VL_L_BASE_Y, /* alpha of the metal; that of the coat is alpha_x, alpha_y */
  VL_L_THICKNESS,
  VL_L_G,
  VL_L_ALBEDO,
  VL_L_DEPTH = VL_L_ALBEDO + 4, /* largest number of steps of a walk */
  VL_L_WALKS
};
enum {
  VL_H_SIGMA_A,
  VL_H_ACROSS = VL_H_SIGMA_A + 4, /* offset of the hit across the hair, -1 to 1 */
  VL_H_BETA_M,
  VL_H_BETA_N,
  VL_H_ALPHA, /* radians */
  VL_H_ROWS
};
enum { VL_S_SIGMA /* extinction, 4 */, VL_S_ALBEDO = VL_S_SIGMA + 4 /* 4 */ }; /* subsurface */

enum {
  VL_SAMPLED_SPECULAR = 1,     /* a delta: not part of eval */
  VL_SAMPLED_TRANSMISSION = 2, /* wi on the other side of the surface */
  VL_SAMPLED_NONE = 4          /* no direction: the path ends; weight is 0 */
};

/* One array per parameter, VL_PAD(n) lanes; a kind reads only those that name it. */
typedef struct vlBsdfParams {
  float *reflectance[4];    /* diffuse, coated diffuse: albedo of the base in [0,1] */
  float *eta[4], *k[4];     /* conductor */
  float *alpha_x, *alpha_y; /* conductor, dielectric, coat */
  float *eta_s;             /* dielectric, thin, coat */
  const vlCoatTable **coat; /* coated diffuse */
  float *own[VL_BSDF_ROWS]; /* rows of VL_P_, VL_T_, VL_L_, VL_H_, VL_S_ */
  const uint32_t *seed;     /* layered: seeds of the walks' random numbers */
  const vlMeasured *const *measured;
  const float *lambda[4]; /* principled, measured: wavelengths, nm; null in RGB mode */
} vlBsdfParams;

typedef struct vlBsdfDirections {
  float *x, *y, *z;
} vlBsdfDirections;

typedef struct vlBsdfKernels {
  /* by kind: eval and sample */
  void (*eval)(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, vlBsdfDirections wi,
               float *const value[4], float *pdf);
  void (*sample)(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, const float *u_lobe,
                 const float *u, const float *v, vlBsdfDirections wi, float *const weight[4], float *pdf,
                 uint32_t *flags, float *eta_scale /* relative eta of a transmission squared, else 1: for roulette */);
} vlBsdfKernels;
VL_KERNEL_TABLE(vlBsdfKernels, vl_bsdf)

#endif
