/* material/conductor.hot.c: the BSDF of metals, smooth or with GGX microfacets, with single
 * scattering (pbrt book 9.3.6, 9.6.5). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_conductor_eval;
vlBsdfSample vl_bsdf_conductor_sample;

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
    float f0 = vl_fresnel_conductor(c, e0[i], k0[i]),
          f1 = vl_fresnel_conductor(c, e1[i], k1[i]);
    float f2 = vl_fresnel_conductor(c, e2[i], k2[i]),
          f3 = vl_fresnel_conductor(c, e3[i], k3[i]);
    v0[i] = valid ? f0 * g : 0.0f;
    v1[i] = valid ? f1 * g : 0.0f;
    v2[i] = valid ? f2 * g : 0.0f;
    v3[i] = valid ? f3 * g : 0.0f;
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
    vlVec3 h = vl_ggx_sample(o, rx, ry, u[i], v[i]);
    h.x = smooth ? 0.0f : h.x;
    h.y = smooth ? 0.0f : h.y;
    h.z = smooth ? 1.0f : h.z;
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
    float f0 = vl_fresnel_conductor(c, e0[i], k0[i]),
          f1 = vl_fresnel_conductor(c, e1[i], k1[i]);
    float f2 = vl_fresnel_conductor(c, e2[i], k2[i]),
          f3 = vl_fresnel_conductor(c, e3[i], k3[i]);
    w0[i] = valid ? f0 * g : 0.0f;
    w1[i] = valid ? f1 * g : 0.0f;
    w2[i] = valid ? f2 * g : 0.0f;
    w3[i] = valid ? f3 * g : 0.0f;
    pdf[i] = valid ? (smooth ? 1.0f : p) : 0.0f;
    flags[i] =
        valid ? (smooth ? (uint32_t)VL_SAMPLED_SPECULAR : 0u) : (uint32_t)VL_SAMPLED_NONE;
    eta_scale[i] = 1.0f;
  }
}
