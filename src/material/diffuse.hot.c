/* material/diffuse.hot.c: Lambertian reflection (pbrt book 9.2). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_diffuse_eval;
vlBsdfSample vl_bsdf_diffuse_sample;

void vl_bsdf_diffuse_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                          vlBsdfDirections wi, float *const value[4], float *pdf) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = wo.z[i], zi = wi.z[i];
    int same = ((zo > 0.0f) & (zi > 0.0f)) | ((zo < 0.0f) & (zi < 0.0f));
    float p = same ? vl_abs(zi) * VL_INV_PI : 0.0f;
    for (int c = 0; c < 4; c++)
      value[c][i] = params->reflectance[c][i] * p;
    pdf[i] = p;
  }
}

void vl_bsdf_diffuse_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                            vlBsdfRandom random, vlBsdfSampled out) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = wo.z[i];
    vlVec3 d = vl_cosine_direction(random.u[i], random.v[i]);
    int valid = vl_abs(zo) > 0.0f;
    out.wi.x[i] = d.x;
    out.wi.y[i] = d.y;
    out.wi.z[i] = zo < 0.0f ? -d.z : d.z;
    /* a product, because gcc turns a select between loads into a branch */
    float on = valid ? 1.0f : 0.0f;
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = params->reflectance[c][i] * on;
    out.pdf[i] = d.z * VL_INV_PI * on;
    out.flags[i] = valid ? (uint32_t)VL_SAMPLED_DIFFUSE : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}
