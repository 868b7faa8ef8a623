/* material/thin_dielectric.hot.c: the thin dielectric, a pane that includes all internal
 * reflections (pbrt book 9.5.1). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_thin_eval;
vlBsdfSample vl_bsdf_thin_sample;

/* Reflection and transmission of a pane are deltas. */
void vl_bsdf_thin_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                       vlBsdfDirections wi, float *const value[4], float *pdf) {
  (void)params;
  (void)wo;
  (void)wi;
  float *v0 = value[0], *v1 = value[1], *v2 = value[2], *v3 = value[3];
  uint32_t count = VL_PAD(n);
  for (uint32_t i = 0; i < count; i++)
    v0[i] = v1[i] = v2[i] = v3[i] = pdf[i] = 0.0f;
}

void vl_bsdf_thin_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                         const float *u_lobe, const float *u, const float *v,
                         vlBsdfDirections wi, float *const weight[4], float *pdf,
                         uint32_t *flags, float *eta_scale) {
  (void)u;
  (void)v;
  const float *ox = wo.x, *oy = wo.y, *oz = wo.z, *eta = params->eta_s;
  float *ix = wi.x, *iy = wi.y, *iz = wi.z;
  float *w0 = weight[0], *w1 = weight[1], *w2 = weight[2], *w3 = weight[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = oz[i], c = vl_abs(zo);
    float r = vl_fresnel_slab(vl_fresnel_dielectric(c, eta[i]).reflected);
    int reflect = (u_lobe[i] < r), valid = (c > 0.0f);
    float p = reflect ? r : 1.0f - r, w = valid ? 1.0f : 0.0f;
    uint32_t f = reflect ? (uint32_t)VL_SAMPLED_SPECULAR
                         : (uint32_t)(VL_SAMPLED_SPECULAR | VL_SAMPLED_TRANSMISSION);
    ix[i] = -ox[i];
    iy[i] = -oy[i];
    iz[i] = reflect ? zo : -zo;
    w0[i] = w1[i] = w2[i] = w3[i] = w;
    pdf[i] = valid ? p : 0.0f;
    flags[i] = valid ? f : (uint32_t)VL_SAMPLED_NONE;
    eta_scale[i] = 1.0f;
  }
}
