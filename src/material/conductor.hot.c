/* material/conductor.hot.c: the BSDF of metals, smooth or with GGX microfacets, with single
 * scattering (pbrt book 9.3.6, 9.6.5). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_conductor_eval;
vlBsdfSample vl_bsdf_conductor_sample;

/* g times the reflectance at the cosine c of a metal of index eta + i k; 0 unless valid. */
static inline float tinted(int valid, float g, float c, float eta, float k) {
  float f = vl_fresnel_conductor(c, eta, k);
  return valid ? f * g : 0.0f;
}

void vl_bsdf_conductor_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                            vlBsdfDirections wi, float *const value[4], float *pdf) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(params->alpha_x[i]), ry = vl_ggx_alpha(params->alpha_y[i]);
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i])),
           w = vl_vec3(wi.x[i], wi.y[i], vl_abs(wi.z[i]));
    int same = ((wo.z[i] > 0.0f) & (wi.z[i] > 0.0f)) | ((wo.z[i] < 0.0f) & (wi.z[i] < 0.0f));
    int valid = same & (vl_ggx_is_smooth(params->alpha_x[i], params->alpha_y[i]) == 0);
    vlVec3 h = vl_normalize(vl_add(o, w));
    float c = vl_dot(o, h);
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    float p = 0.25f * vl_ggx_visible(h, rx, ry, o.z, lo);
    float g = p * vl_ggx_shadowing(o.z, lo, w.z, li);
    for (int k = 0; k < 4; k++)
      value[k][i] = tinted(valid, g, c, params->eta[k][i], params->k[k][i]);
    pdf[i] = valid ? p : 0.0f;
  }
}

void vl_bsdf_conductor_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                              vlBsdfRandom random, vlBsdfSampled out) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(params->alpha_x[i]), ry = vl_ggx_alpha(params->alpha_y[i]);
    int smooth = vl_ggx_is_smooth(params->alpha_x[i], params->alpha_y[i]);
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i]));
    vlVec3 h = vl_microfacet(o, rx, ry, smooth, random.u[i], random.v[i]);
    float c = vl_dot(o, h);
    vlVec3 w = vl_reflect(o, h, c);
    int valid = (o.z > 0.0f) & (w.z > 0.0f) & (c > 0.0f);
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    float p = 0.25f * vl_ggx_visible(h, rx, ry, o.z, lo);
    float g = vl_ggx_shadowing(o.z, lo, w.z, li);
    g = valid ? (smooth ? 1.0f : g) : 0.0f;
    out.wi.x[i] = w.x;
    out.wi.y[i] = w.y;
    out.wi.z[i] = wo.z[i] < 0.0f ? -w.z : w.z;
    for (int k = 0; k < 4; k++)
      out.weight[k][i] = tinted(valid, g, c, params->eta[k][i], params->k[k][i]);
    out.pdf[i] = valid ? (smooth ? 1.0f : p) : 0.0f;
    out.flags[i] =
        valid ? (smooth ? (uint32_t)VL_SAMPLED_SPECULAR : 0u) : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}
