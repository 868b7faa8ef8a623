/* material/diffuse_transmission.hot.c: Lambertian reflection and transmission (pbrt's
 * diffusetransmission). Samples choose reflection or transmission in proportion to the largest
 * channel of each. Both sides of the surface have the same values. */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_translucent_eval;
vlBsdfSample vl_bsdf_translucent_sample;

/* Probability of reflection, of the largest channels of both colours; any value if both are 0.
 */
static inline float share(const vlBsdfParams *params, uint32_t i) {
  float *const *reflectance = params->reflectance;
  float *const *transmittance = params->own + VL_T_TRANSMITTANCE;
  float r =
      vl_largest4(reflectance[0][i], reflectance[1][i], reflectance[2][i], reflectance[3][i]);
  float t = vl_largest4(transmittance[0][i], transmittance[1][i], transmittance[2][i],
                        transmittance[3][i]);
  float sum = r + t;
  return sum > 0.0f ? r / sum : 1.0f;
}

void vl_bsdf_translucent_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                              vlBsdfDirections wi, float *const value[4], float *pdf) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = wo.z[i], zi = wi.z[i], side = zo * zi;
    float p = share(params, i);
    float c = side != 0.0f ? vl_abs(zi) * VL_INV_PI : 0.0f;
    float up = side > 0.0f ? 1.0f : 0.0f, down = 1.0f - up;
    for (int k = 0; k < 4; k++)
      value[k][i] =
          (params->reflectance[k][i] * up + params->own[VL_T_TRANSMITTANCE + k][i] * down) * c;
    pdf[i] = (p * up + (1.0f - p) * down) * c;
  }
}

void vl_bsdf_translucent_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                                vlBsdfRandom random, vlBsdfSampled out) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = wo.z[i];
    float p = share(params, i);
    vlVec3 d = vl_cosine_direction(random.u[i], random.v[i]);
    int reflect = (random.lobe[i] < p), valid = (vl_abs(zo) > 0.0f);
    float up = reflect ? 1.0f : 0.0f, down = 1.0f - up, on = valid ? 1.0f : 0.0f;
    float chosen = p * up + (1.0f - p) * down, scale = on / (chosen > 1e-30f ? chosen : 1e-30f);
    float z = zo < 0.0f ? -d.z : d.z;
    out.wi.x[i] = d.x;
    out.wi.y[i] = d.y;
    out.wi.z[i] = reflect ? z : -z;
    for (int k = 0; k < 4; k++)
      out.weight[k][i] =
          (params->reflectance[k][i] * up + params->own[VL_T_TRANSMITTANCE + k][i] * down) *
          scale;
    out.pdf[i] = chosen * d.z * VL_INV_PI * on;
    uint32_t f = VL_SAMPLED_DIFFUSE | (reflect ? 0u : (uint32_t)VL_SAMPLED_TRANSMISSION);
    out.flags[i] = valid ? f : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}
