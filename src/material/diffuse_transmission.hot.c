/* material/diffuse_transmission.hot.c: Lambertian reflection and transmission (pbrt's
 * diffusetransmission). Samples choose reflection or transmission in proportion to the largest
 * channel of each. Both sides of the surface have the same values. */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_translucent_eval;
vlBsdfSample vl_bsdf_translucent_sample;

/* Probability of reflection; any value if both are 0. */
static inline float share(float r0, float r1, float r2, float r3, float t0, float t1, float t2,
                          float t3) {
  float r = vl_max(vl_max(r0, r1), vl_max(r2, r3)), t = vl_max(vl_max(t0, t1), vl_max(t2, t3));
  float sum = r + t;
  return sum > 0.0f ? r / sum : 1.0f;
}

void vl_bsdf_translucent_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                              vlBsdfDirections wi, float *const value[4], float *pdf) {
  const float *oz = wo.z, *iz = wi.z;
  const float *r0 = params->reflectance[0], *r1 = params->reflectance[1];
  const float *r2 = params->reflectance[2], *r3 = params->reflectance[3];
  const float *t0 = params->own[VL_T_TRANSMITTANCE], *t1 = params->own[VL_T_TRANSMITTANCE + 1];
  const float *t2 = params->own[VL_T_TRANSMITTANCE + 2],
              *t3 = params->own[VL_T_TRANSMITTANCE + 3];
  float *v0 = value[0], *v1 = value[1], *v2 = value[2], *v3 = value[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = oz[i], zi = iz[i], side = zo * zi;
    float a0 = r0[i], a1 = r1[i], a2 = r2[i], a3 = r3[i], b0 = t0[i], b1 = t1[i], b2 = t2[i],
          b3 = t3[i];
    float p = share(a0, a1, a2, a3, b0, b1, b2, b3);
    float c = side != 0.0f ? vl_abs(zi) * VL_INV_PI : 0.0f;
    float up = side > 0.0f ? 1.0f : 0.0f, down = 1.0f - up;
    v0[i] = (a0 * up + b0 * down) * c;
    v1[i] = (a1 * up + b1 * down) * c;
    v2[i] = (a2 * up + b2 * down) * c;
    v3[i] = (a3 * up + b3 * down) * c;
    pdf[i] = (p * up + (1.0f - p) * down) * c;
  }
}

void vl_bsdf_translucent_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                                const float *u_lobe, const float *u, const float *v,
                                vlBsdfDirections wi, float *const weight[4], float *pdf,
                                uint32_t *flags, float *eta_scale) {
  const float *oz = wo.z;
  const float *r0 = params->reflectance[0], *r1 = params->reflectance[1];
  const float *r2 = params->reflectance[2], *r3 = params->reflectance[3];
  const float *t0 = params->own[VL_T_TRANSMITTANCE], *t1 = params->own[VL_T_TRANSMITTANCE + 1];
  const float *t2 = params->own[VL_T_TRANSMITTANCE + 2],
              *t3 = params->own[VL_T_TRANSMITTANCE + 3];
  float *ix = wi.x, *iy = wi.y, *iz = wi.z;
  float *w0 = weight[0], *w1 = weight[1], *w2 = weight[2], *w3 = weight[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = oz[i];
    float a0 = r0[i], a1 = r1[i], a2 = r2[i], a3 = r3[i], b0 = t0[i], b1 = t1[i], b2 = t2[i],
          b3 = t3[i];
    float p = share(a0, a1, a2, a3, b0, b1, b2, b3);
    vlVec3 d = vl_cosine_direction(u[i], v[i]);
    int reflect = (u_lobe[i] < p), valid = (vl_abs(zo) > 0.0f);
    float up = reflect ? 1.0f : 0.0f, down = 1.0f - up, on = valid ? 1.0f : 0.0f;
    float chosen = p * up + (1.0f - p) * down, scale = on / (chosen > 1e-30f ? chosen : 1e-30f);
    float z = zo < 0.0f ? -d.z : d.z;
    ix[i] = d.x;
    iy[i] = d.y;
    iz[i] = reflect ? z : -z;
    w0[i] = (a0 * up + b0 * down) * scale;
    w1[i] = (a1 * up + b1 * down) * scale;
    w2[i] = (a2 * up + b2 * down) * scale;
    w3[i] = (a3 * up + b3 * down) * scale;
    pdf[i] = chosen * d.z * VL_INV_PI * on;
    uint32_t f = VL_SAMPLED_DIFFUSE | (reflect ? 0u : (uint32_t)VL_SAMPLED_TRANSMISSION);
    flags[i] = valid ? f : (uint32_t)VL_SAMPLED_NONE;
    eta_scale[i] = 1.0f;
  }
}
