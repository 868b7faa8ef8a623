/* material/bsdf.hot.h: evaluates and samples BSDFs over batches of one kind. All directions are
 * in the local shading frame, whose z axis is the shading normal; wo and wi point away from the
 * surface. There are 4 channels: 4 wavelengths, or R, G, B and an unused channel. The code is
 * the same for both.
 *
 *   eval:   value[c] = f(wo, wi) |cos wi|, pdf = density of sampling wi (solid angle); specular
 *           (delta) parts are 0
 *   sample: wi; weight[c] = f |cos| / pdf; pdf (for delta parts: the discrete probability, flag
 *           set); flags
 *
 * The BSDFs transport radiance, as on camera paths, so transmission has the factor 1/eta^2
 * (pbrt book 9.5.2). References: pbrt-v4 book chapter 9; Walter et al. 2007; Heitz 2018 / Dupuy
 * and Benyoub 2023 (visible normals). */
#ifndef MATERIAL_BSDF_HOT_H
#define MATERIAL_BSDF_HOT_H

#include "base/isa.h"
#include "material/coat.h"
#include "material/measured_tables.h"
#include "velo/base.h"

/* A kind of BSDF: VL_BSDF_DIFFUSE and so on, in material/kinds.row.h. */
typedef uint32_t vlBsdfKind;

/* Number of parameter rows whose meaning depends on the kind. The enums below name the rows of
 * each kind, such as VL_P_* for the principled kind. A kind that only one file uses may number
 * its rows in that file. */
enum { VL_BSDF_ROWS = 26 };

/* Rows of the principled material. The base colour is in `reflectance`, the roughness in
 * alpha_x and alpha_y (at least 1e-3). F0 is the reflectance of the dielectric at normal
 * incidence. COAT_X, COAT_Y and COAT_Z are the coat's unit normal, with z > 0. */
enum {
  VL_P_METALLIC,
  VL_P_F0,
  VL_P_F90 = VL_P_F0 + 4,
  VL_P_TRANSMISSION,
  VL_P_THIN, /* 1: a thin sheet, or opaque; 0: a transmissive solid, whose index is eta_s */
  VL_P_DIFFUSE_TRANSMISSION,
  VL_P_THROUGH, /* 4 rows: colour of the diffuse transmission */
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

/* Rows of the other kinds: VL_T_ diffuse transmission, VL_L_ layered, VL_H_ hair, VL_S_
 * subsurface. */
enum { VL_T_TRANSMITTANCE }; /* 4 rows */
enum {
  VL_L_METAL,  /* 1: the base is a metal with eta and k, relative to the coat's index; 0: the
                  base is diffuse with `reflectance` */
  VL_L_BASE_X, /* alpha of the metal; the coat has alpha_x, alpha_y */
  VL_L_BASE_Y,
  VL_L_THICKNESS,               /* of the medium between coat and base */
  VL_L_G,                       /* its Henyey-Greenstein asymmetry */
  VL_L_ALBEDO,                  /* its single-scattering albedo, 4 rows */
  VL_L_DEPTH = VL_L_ALBEDO + 4, /* largest number of steps of a random walk */
  VL_L_WALKS                    /* number of random walks whose mean is the value */
};
/* Hair: names and units of the pbrt book, 9.9. */
enum {
  VL_H_SIGMA_A,                   /* 4 rows */
  VL_H_ACROSS = VL_H_SIGMA_A + 4, /* offset of the hit from the hair's axis, -1 to 1 */
  VL_H_BETA_M,
  VL_H_BETA_N,
  VL_H_ALPHA, /* radians */
  VL_H_ROWS
};
enum {
  VL_S_SIGMA,                  /* extinction, 4 rows */
  VL_S_ALBEDO = VL_S_SIGMA + 4 /* 4 rows */
};

enum {
  VL_SAMPLED_SPECULAR = 1,     /* a delta lobe, which eval does not include */
  VL_SAMPLED_TRANSMISSION = 2, /* wi is on the other side of the surface */
  VL_SAMPLED_NONE = 4,         /* no direction: the path ends; weight is 0 */
  VL_SAMPLED_DIFFUSE = 8       /* a diffuse lobe was chosen */
};

/* Parameters of a batch, one array of VL_PAD(n) lanes each. A kind reads only the arrays whose
 * comment names it. */
typedef struct vlBsdfParams {
  float *reflectance[4]; /* diffuse, coated diffuse: albedo of the base, in [0, 1] */
  /* principled: factor on the light that it transmits; null: the reflectance */
  const float *tint[4];
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

/* Uniform numbers in [0, 1): one chooses a lobe, two its direction. */
typedef struct vlBsdfRandom {
  const float *lobe, *u, *v;
} vlBsdfRandom;

/* What sampling writes. eta_scale, for Russian roulette: the squared relative index of a
 * transmission, else 1. */
typedef struct vlBsdfSampled {
  vlBsdfDirections wi;
  float *weight[4], *pdf;
  uint32_t *flags; /* VL_SAMPLED_* */
  float *eta_scale;
} vlBsdfSampled;

/* n lanes of one kind. All arrays have VL_PAD(n) lanes. */
typedef void vlBsdfEval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                        vlBsdfDirections wi, float *const value[4], float *pdf);
typedef void vlBsdfSample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                          vlBsdfRandom random, vlBsdfSampled out);

/* By vlBsdfKind. */
typedef struct vlBsdfKernels {
  vlBsdfEval *const *eval;
  vlBsdfSample *const *sample;
  const char *const *names; /* for records of paths: "diffuse", "coat" */
} vlBsdfKernels;
VL_KERNEL_TABLE(vlBsdfKernels, vl_bsdf)

#endif
