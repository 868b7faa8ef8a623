/* material/dielectric.hot.c: the BSDF of glass and water, smooth or with GGX microfacets,
 * with single scattering (pbrt book 9.5, 9.7; Walter et al. 2007). A sample chooses reflection
 * or transmission in proportion to the Fresnel terms at the sampled microfacet. The sample's
 * weight is therefore G/G1 in both cases. For transmission it is also divided by eta^2, because
 * refraction compresses the solid angle. */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_dielectric_eval;
vlBsdfSample vl_bsdf_dielectric_sample;

void vl_bsdf_dielectric_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                             vlBsdfDirections wi, float *const value[4], float *pdf) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(params->alpha_x[i]), ry = vl_ggx_alpha(params->alpha_y[i]);
    int below = wo.z[i] < 0.0f;
    float forth = params->eta_s[i], back = 1.0f / forth;
    float eta = below ? back : forth, inverse = below ? forth : back;
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i])),
           w = vl_vec3(wi.x[i], wi.y[i], below ? -wi.z[i] : wi.z[i]);
    int reflect = w.z > 0.0f;
    int smooth =
        vl_ggx_is_smooth(params->alpha_x[i], params->alpha_y[i]) | (params->eta_s[i] == 1.0f);
    int valid = (o.z > 0.0f) & (vl_abs(w.z) > 0.0f) & (smooth == 0);
    /* h: the half vector of wo and wi, generalised for transmission, on the upper side. */
    float s = reflect ? 1.0f : eta;
    vlVec3 h = vl_normalize(vl_vec3(o.x + s * w.x, o.y + s * w.y, o.z + s * w.z));
    float up = h.z < 0.0f ? -1.0f : 1.0f;
    h = vl_mul(h, up);
    float oh = vl_dot(o, h), ih = vl_dot(w, h);
    /* The microfacet's front must face wo; for transmission its back must face wi. */
    valid = valid & (oh > 0.0f) & (reflect | (ih < 0.0f));
    float fr = vl_fresnel_dielectric(oh, eta).reflected;
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    /* D_wo(h) / wo.h = 2 D / (Lo + zo). jacobian: the Jacobian of h with respect to wi, times
     * wo.h */
    float visible = vl_ggx_visible(h, rx, ry, o.z, lo);
    float t = ih + oh * inverse;
    float t2 = t * t;
    float jacobian = oh * vl_abs(ih) / (t2 > VL_MIN_POSITIVE ? t2 : VL_MIN_POSITIVE);
    float p = visible * (reflect ? 0.25f * fr : (1.0f - fr) * jacobian);
    float g = vl_ggx_shadowing(o.z, lo, vl_abs(w.z), li);
    g = p * g * (reflect ? 1.0f : inverse * inverse);
    g = valid ? g : 0.0f;
    value[0][i] = value[1][i] = value[2][i] = value[3][i] = g;
    pdf[i] = valid ? p : 0.0f;
  }
}

void vl_bsdf_dielectric_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                               vlBsdfRandom random, vlBsdfSampled out) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float rx = vl_ggx_alpha(params->alpha_x[i]), ry = vl_ggx_alpha(params->alpha_y[i]);
    int smooth =
        vl_ggx_is_smooth(params->alpha_x[i], params->alpha_y[i]) | (params->eta_s[i] == 1.0f);
    int below = wo.z[i] < 0.0f;
    float forth = params->eta_s[i], back = 1.0f / forth;
    float eta = below ? back : forth, inverse = below ? forth : back;
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i]));
    vlVec3 h = vl_microfacet(o, rx, ry, smooth, random.u[i], random.v[i]);
    float oh = vl_dot(o, h);
    vlFresnel f = vl_fresnel_dielectric(oh, eta);
    float fr = params->eta_s[i] == 1.0f ? 0.0f : f.reflected;
    int reflect = random.lobe[i] < fr;
    /* wi = a h - b wo for both: reflection, or refraction by Snell's law */
    float b = reflect ? 1.0f : inverse;
    float cos_t = f.root * inverse, t = oh * inverse - cos_t;
    float a = reflect ? 2.0f * oh : t;
    vlVec3 w = vl_vec3(a * h.x - b * o.x, a * h.y - b * o.y, a * h.z - b * o.z);
    int valid = (o.z > 0.0f) & (oh > 0.0f) & (reflect ? w.z > 0.0f : w.z < 0.0f);
    float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
    float visible = vl_ggx_visible(h, rx, ry, o.z, lo);
    /* wi.h = -cos_t after transmission */
    float t2 = t * t;
    float jacobian = oh * cos_t / (t2 > VL_MIN_POSITIVE ? t2 : VL_MIN_POSITIVE);
    float chosen = reflect ? fr : 1.0f - fr;
    float p = chosen * (smooth ? 1.0f : visible * (reflect ? 0.25f : jacobian));
    float g = smooth ? 1.0f : vl_ggx_shadowing(o.z, lo, vl_abs(w.z), li);
    g = g * (reflect ? 1.0f : inverse * inverse);
    g = valid ? g : 0.0f;
    uint32_t flag = (smooth ? (uint32_t)VL_SAMPLED_SPECULAR : 0u) |
                    (reflect ? 0u : (uint32_t)VL_SAMPLED_TRANSMISSION);
    out.wi.x[i] = w.x;
    out.wi.y[i] = w.y;
    out.wi.z[i] = below ? -w.z : w.z;
    out.weight[0][i] = out.weight[1][i] = out.weight[2][i] = out.weight[3][i] = g;
    out.pdf[i] = valid ? p : 0.0f;
    out.flags[i] = valid ? flag : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = reflect ? 1.0f : eta * eta;
  }
}
