/* material/principled.hot.h: data of a chunk of lanes that the passes of the principled
 * material exchange. Private to principled.hot.c and principled_energy.hot.c.
 * docs/principled.md has the formulas. */
#ifndef MATERIAL_PRINCIPLED_HOT_H
#define MATERIAL_PRINCIPLED_HOT_H

#include "material/local.hot.h"
#include "material/principled.h"

enum { VL_PRINCIPLED_CHUNK = 64 };

/* Parameters of a chunk. Each pointer points to the chunk's first lane. */
typedef struct vlPrincipledSlice {
  const float *row[VL_BSDF_ROWS];
  const float *base[4], *tint[4], *alpha_x, *alpha_y, *eta;
  const float *lambda[4]; /* null in RGB mode */
  uint32_t count;         /* a multiple of the vector width */
  /* true if some lane has a thin film, sheen, coat, or transmissive solid, or is anisotropic */
  bool film, sheen, coat, solid, anisotropic;
} vlPrincipledSlice;

typedef struct vlPrincipledLanes {
  float z[VL_PRINCIPLED_CHUNK], side[VL_PRINCIPLED_CHUNK]; /* |wo.z|; sign of wo.z: 1 or -1 */
  float inside[VL_PRINCIPLED_CHUNK]; /* 1: wo lies inside a transmissive solid */
  float energy_o[4][VL_PRINCIPLED_CHUNK], energy_i[4][VL_PRINCIPLED_CHUNK],
      energy_mean[4][VL_PRINCIPLED_CHUNK];
  /* the three energies above for F = 1 */
  float one_o[VL_PRINCIPLED_CHUNK], one_i[VL_PRINCIPLED_CHUNK], one_mean[VL_PRINCIPLED_CHUNK];
  /* albedo of the layers above the base: coat, then sheen */
  float coat_o[VL_PRINCIPLED_CHUNK], coat_i[VL_PRINCIPLED_CHUNK],
      coat_mean[VL_PRINCIPLED_CHUNK];
  float sheen_o[VL_PRINCIPLED_CHUNK], sheen_i[VL_PRINCIPLED_CHUNK],
      sheen_mean[VL_PRINCIPLED_CHUNK];
  /* E(wo) without the cap; f cos_i of white sheen */
  float sheen_raw[VL_PRINCIPLED_CHUNK], sheen_value[VL_PRINCIPLED_CHUNK];
  float film[4][VL_PRINCIPLED_CHUNK]; /* reflectance of the thin film at the microfacet */
  /* Multiple scattering between the microfacets of a transmissive solid. loss_mean: on this
   * side and on the other side. lost_up, lost_down: shares of the lost energy that are
   * reflected and transmitted, without those of a sheet. again_up, again_down: f cos_i of the
   * reflected and transmitted parts; again_up is reduced by again_pass, the share of the
   * transmitted energy. */
  float loss_o[VL_PRINCIPLED_CHUNK], loss_mean[2][VL_PRINCIPLED_CHUNK];
  float lost_up[VL_PRINCIPLED_CHUNK], lost_down[VL_PRINCIPLED_CHUNK];
  float again_up[VL_PRINCIPLED_CHUNK], again_pass[VL_PRINCIPLED_CHUNK],
      again_down[VL_PRINCIPLED_CHUNK];
  float specular[VL_PRINCIPLED_CHUNK], diffuse[VL_PRINCIPLED_CHUNK], coat[VL_PRINCIPLED_CHUNK],
      refract[VL_PRINCIPLED_CHUNK],
      through[VL_PRINCIPLED_CHUNK]; /* probabilities of the lobes */
} vlPrincipledLanes;

/* vl_principled_view computes the table values at wo and the lobes' probabilities.
 * vl_principled_light computes the table values at wi, and the values of film and sheen for wo
 * and wi. wi.z is relative to the surface. Directions are arrays of the chunk. */
void vl_principled_view(const vlPrincipledSlice *s, vlBsdfDirections wo,
                        vlPrincipledLanes *lanes);
void vl_principled_light(const vlPrincipledSlice *s, vlBsdfDirections wo, vlBsdfDirections wi,
                         vlPrincipledLanes *lanes);

/* The coat's normal on the side of wo. side: sign of wo.z. */
static inline vlVec3 vl_principled_coat(const vlPrincipledSlice *s, uint32_t i, float side) {
  return vl_vec3(s->row[VL_P_COAT_X][i] * side, s->row[VL_P_COAT_Y][i] * side,
                 s->row[VL_P_COAT_Z][i]);
}

/* Computes the cosine outside a solid from the cosine inside. In total internal reflection,
 * cosine is 0 and total is 1. */
typedef struct vlOuterCosine {
  float cosine;
  int total;
} vlOuterCosine;
static inline vlOuterCosine vl_outer_cosine(float inner, float eta) {
  float c2 = 1.0f - eta * eta * (1.0f - inner * inner);
  return (vlOuterCosine){__builtin_sqrtf(c2 > 0.0f ? c2 : 0.0f), c2 <= 0.0f};
}

/* Added to the share of samples of the reflection, so that it is sampled even if its estimated
 * value is 0 and its true value is not. */
#define VL_P_MIN_MIRROR 1e-3f
/* The coat's normal may differ from the surface's. A direction whose cosine to the coat's
 * normal is at most this value (0.06 degrees above the horizon) misses the coat. */
#define VL_P_COAT_HORIZON 1e-3f

static inline float vl_mean4(float a, float b, float c, float d) {
  return 0.25f * ((a + b) + (c + d));
}

/* Probability of sampling reflection inside a solid after a microfacet is sampled: the share
 * that the microfacet reflects. c: cosine outside; base: mean of the base colour's channels. */
static inline float vl_principled_mirrors(float c, int total, float f0, float f90, float metal,
                                          float clear, float base) {
  float f = f0 + (f90 - f0) * vl_schlick_weight(c), dielectric = 1.0f - metal;
  f = total ? 1.0f : f;
  float forth = metal * base + dielectric * f + VL_P_MIN_MIRROR,
        through = dielectric * clear * base * (1.0f - f);
  return forth / (forth + through);
}

#endif
