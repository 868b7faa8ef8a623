/* material/thin_dielectric.hot.c: the thin dielectric, a pane that includes all internal
 * reflections (pbrt book 9.5.1). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_thin_eval;
vlBsdfSample vl_bsdf_thin_sample;

/* Reflection and transmission of a pane are deltas. */
void vl_bsdf_thin_eval(uint32_t n, VL_UNUSED const vlBsdfParams *params,
                       VL_UNUSED vlBsdfDirections wo, VL_UNUSED vlBsdfDirections wi,
                       float *const value[4], float *pdf) {
  uint32_t count = VL_PAD(n);
  for (uint32_t i = 0; i < count; i++)
    value[0][i] = value[1][i] = value[2][i] = value[3][i] = pdf[i] = 0.0f;
}

void vl_bsdf_thin_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                         vlBsdfRandom random, vlBsdfSampled out) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = wo.z[i], c = vl_abs(zo);
    float r = vl_fresnel_slab(vl_fresnel_dielectric(c, params->eta_s[i]).reflected);
    int reflect = (random.lobe[i] < r), valid = (c > 0.0f);
    float p = reflect ? r : 1.0f - r, w = valid ? 1.0f : 0.0f;
    uint32_t f = reflect ? (uint32_t)VL_SAMPLED_SPECULAR
                         : (uint32_t)(VL_SAMPLED_SPECULAR | VL_SAMPLED_TRANSMISSION);
    out.wi.x[i] = -wo.x[i];
    out.wi.y[i] = -wo.y[i];
    out.wi.z[i] = reflect ? zo : -zo;
    out.weight[0][i] = out.weight[1][i] = out.weight[2][i] = out.weight[3][i] = w;
    out.pdf[i] = valid ? p : 0.0f;
    out.flags[i] = valid ? f : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}
