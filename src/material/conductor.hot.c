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
  const float *ox = wo.x, *oy = wo.y, *oz = wo.z, *ix = wi.x, *iy = wi.y, *iz = wi.z;
  const float *ax = params->alpha_x, *ay = params->alpha_y;
  const float *e0 = params->eta[0], *e1 = params->eta[1], *e2 = params->eta[2],
              *e3 = params->eta[3];
  const float *k0 = params->k[0], *k1 = params->k[1], *k2 = params->k[2], *k3 = params->k[3];
  float *v0 = value[0], *v1 = value[1], *v2 = value[2], *v3 = value[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(ax[i]), ry = vl_ggx_alpha(ay[i]);
    vlVec3 o = vl_vec3(ox[i], oy[i], vl_abs(oz[i])), w = vl_vec3(ix[i], iy[i], vl_abs(iz[i]));
    int same = ((oz[i] > 0.0f) & (iz[i] > 0.0f)) | ((oz[i] < 0.0f) & (iz[i] < 0.0f));
    int valid = same & (vl_ggx_is_smooth(ax[i], ay[i]) == 0);
    vlVec3 h = vl_normalize(vl_add(o, w));
    float c = vl_dot(o, h);
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    float p = 0.25f * vl_ggx_visible(h, rx, ry, o.z, lo);
    float g = p * vl_ggx_shadowing(o.z, lo, w.z, li);
    v0[i] = tinted(valid, g, c, e0[i], k0[i]);
    v1[i] = tinted(valid, g, c, e1[i], k1[i]);
    v2[i] = tinted(valid, g, c, e2[i], k2[i]);
    v3[i] = tinted(valid, g, c, e3[i], k3[i]);
    pdf[i] = valid ? p : 0.0f;
  }
}

void vl_bsdf_conductor_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                              const float *u_lobe, const float *u, const float *v,
                              vlBsdfDirections wi, float *const weight[4], float *pdf,
                              uint32_t *flags, float *eta_scale) {
  (void)u_lobe;
  const float *ox = wo.x, *oy = wo.y, *oz = wo.z, *ax = params->alpha_x, *ay = params->alpha_y;
  const float *e0 = params->eta[0], *e1 = params->eta[1], *e2 = params->eta[2],
              *e3 = params->eta[3];
  const float *k0 = params->k[0], *k1 = params->k[1], *k2 = params->k[2], *k3 = params->k[3];
  float *ix = wi.x, *iy = wi.y, *iz = wi.z;
  float *w0 = weight[0], *w1 = weight[1], *w2 = weight[2], *w3 = weight[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(ax[i]), ry = vl_ggx_alpha(ay[i]);
    int smooth = vl_ggx_is_smooth(ax[i], ay[i]);
    vlVec3 o = vl_vec3(ox[i], oy[i], vl_abs(oz[i]));
    vlVec3 h = vl_microfacet(o, rx, ry, smooth, u[i], v[i]);
    float c = vl_dot(o, h);
    vlVec3 w = vl_reflect(o, h, c);
    int valid = (o.z > 0.0f) & (w.z > 0.0f) & (c > 0.0f);
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    float p = 0.25f * vl_ggx_visible(h, rx, ry, o.z, lo);
    float g = vl_ggx_shadowing(o.z, lo, w.z, li);
    g = valid ? (smooth ? 1.0f : g) : 0.0f;
    ix[i] = w.x;
    iy[i] = w.y;
    iz[i] = oz[i] < 0.0f ? -w.z : w.z;
    w0[i] = tinted(valid, g, c, e0[i], k0[i]);
    w1[i] = tinted(valid, g, c, e1[i], k1[i]);
    w2[i] = tinted(valid, g, c, e2[i], k2[i]);
    w3[i] = tinted(valid, g, c, e3[i], k3[i]);
    pdf[i] = valid ? (smooth ? 1.0f : p) : 0.0f;
    flags[i] =
        valid ? (smooth ? (uint32_t)VL_SAMPLED_SPECULAR : 0u) : (uint32_t)VL_SAMPLED_NONE;
    eta_scale[i] = 1.0f;
  }
}
