/* trace/bsdf/principled.h: the principled material's chunk of lanes: what its passes hand on. Private to the two hot
 * files bsdf_principled*.hot.c. docs/principled.md has the formulas. */
#ifndef TRACE_BSDF_PRINCIPLED_H
#define TRACE_BSDF_PRINCIPLED_H

#include "trace/bsdf/local.h"
#include "world/material/principled.h"

enum { VL_PRINCIPLED_CHUNK = 64 };

/* Parameters of a chunk, shifted to its first lane. */
typedef struct vlPrincipledSlice {
  const float *row[VL_BSDF_ROWS];
  const float *base[4], *alpha_x, *alpha_y, *eta;
  const float *lambda[4];        /* null in RGB mode */
  uint32_t count;                /* whole vectors */
  bool film, sheen, coat, solid; /* some lane has one; solid: light passes into a body */
} vlPrincipledSlice;

typedef struct vlPrincipledLanes {
  float z[VL_PRINCIPLED_CHUNK], side[VL_PRINCIPLED_CHUNK]; /* |wo.z|; 1 above, -1 below */
  float inside[VL_PRINCIPLED_CHUNK];                       /* 1: wo lies in a solid that light passes */
  float energy_o[4][VL_PRINCIPLED_CHUNK], energy_i[4][VL_PRINCIPLED_CHUNK], energy_mean[4][VL_PRINCIPLED_CHUNK];
  float one_o[VL_PRINCIPLED_CHUNK], one_i[VL_PRINCIPLED_CHUNK], one_mean[VL_PRINCIPLED_CHUNK]; /* with F = 1 */
  /* what the layers above reflect: the coat; the sheen */
  float coat_o[VL_PRINCIPLED_CHUNK], coat_i[VL_PRINCIPLED_CHUNK], coat_mean[VL_PRINCIPLED_CHUNK];
  float sheen_o[VL_PRINCIPLED_CHUNK], sheen_i[VL_PRINCIPLED_CHUNK], sheen_mean[VL_PRINCIPLED_CHUNK];
  float sheen_raw[VL_PRINCIPLED_CHUNK], sheen_value[VL_PRINCIPLED_CHUNK]; /* E(wo) uncapped; f cos_i for white */
  float film[4][VL_PRINCIPLED_CHUNK];                                     /* the film's reflection at the microfacet */
  /* Light between the microfacets of a body that light passes, loss_mean: here and beyond. lost_up, lost_down: shares
   * of it that come back and pass, beside a sheet's; again_up (less the share again_pass of what passes), again_down: f
   * cos_i */
  float loss_o[VL_PRINCIPLED_CHUNK], loss_mean[2][VL_PRINCIPLED_CHUNK];
  float lost_up[VL_PRINCIPLED_CHUNK], lost_down[VL_PRINCIPLED_CHUNK];
  float again_up[VL_PRINCIPLED_CHUNK], again_pass[VL_PRINCIPLED_CHUNK], again_down[VL_PRINCIPLED_CHUNK];
  float specular[VL_PRINCIPLED_CHUNK], diffuse[VL_PRINCIPLED_CHUNK], coat[VL_PRINCIPLED_CHUNK],
      refract[VL_PRINCIPLED_CHUNK], through[VL_PRINCIPLED_CHUNK]; /* chances of the lobes */
} vlPrincipledLanes;

/* Tables at wo, and the lobes' chances; at wi, with the film's and the sheen's values for the pair. z of wi as given
 * (world side), directions of the whole batch shifted by first. */
void vl_principled_view(const vlPrincipledSlice *s, vlBsdfDirections wo, uint32_t first, vlPrincipledLanes *lanes);
void vl_principled_light(const vlPrincipledSlice *s, vlBsdfDirections wo, vlBsdfDirections wi, uint32_t first,
                         vlPrincipledLanes *lanes);

/* The coat's normal as seen from wo's side, where z is up. */
static inline vlVec3 vl_principled_coat(const vlPrincipledSlice *s, uint32_t i, float side) {
  return vl_vec3(s->row[VL_P_COAT_X][i] * side, s->row[VL_P_COAT_Y][i] * side, s->row[VL_P_COAT_Z][i]);
}

/* Cosine outside a solid, from the cosine inside: 0 and total = 1 in total internal reflection. */
typedef struct vlOuterCosine {
  float cosine;
  int total;
} vlOuterCosine;
static inline vlOuterCosine vl_outer_cosine(float inner, float eta) {
  float c2 = 1.0f - eta * eta * (1.0f - inner * inner);
  return (vlOuterCosine){__builtin_sqrtf(c2 > 0.0f ? c2 : 0.0f), c2 <= 0.0f};
}

/* A microfacet inside of a solid is chosen first; the chance that it mirrors then is what it reflects. c: cosine
 * outside; base: the mean of the base colour. */
static inline float vl_principled_mirrors(float c, int total, float f0, float f90, float metal, float clear,
                                          float base) {
  float f = f0 + (f90 - f0) * vl_schlick_weight(c), dielectric = 1.0f - metal;
  f = total ? 1.0f : f;
  float forth = metal * base + dielectric * f + 1e-3f, through = dielectric * clear * base * (1.0f - f);
  return forth / (forth + through);
}

#endif
