/* material/diffuse.hot.c: Lambertian reflection (pbrt book 9.2). */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_diffuse_eval;
vlBsdfSample vl_bsdf_diffuse_sample;

void vl_bsdf_diffuse_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                          vlBsdfDirections wi, float *const value[4], float *pdf) {
  const float *oz = wo.z, *iz = wi.z;
  const float *r0 = params->reflectance[0], *r1 = params->reflectance[1];
  const float *r2 = params->reflectance[2], *r3 = params->reflectance[3];
  float *v0 = value[0], *v1 = value[1], *v2 = value[2], *v3 = value[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = oz[i], zi = iz[i];
    int same = ((zo > 0.0f) & (zi > 0.0f)) | ((zo < 0.0f) & (zi < 0.0f));
    float p = same ? vl_abs(zi) * VL_INV_PI : 0.0f;
    v0[i] = r0[i] * p;
    v1[i] = r1[i] * p;
    v2[i] = r2[i] * p;
    v3[i] = r3[i] * p;
    pdf[i] = p;
  }
}

void vl_bsdf_diffuse_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                            const float *u_lobe, const float *u, const float *v,
                            vlBsdfDirections wi, float *const weight[4], float *pdf,
                            uint32_t *flags, float *eta_scale) {
  (void)u_lobe;
  const float *oz = wo.z;
  const float *r0 = params->reflectance[0], *r1 = params->reflectance[1];
  const float *r2 = params->reflectance[2], *r3 = params->reflectance[3];
  float *ix = wi.x, *iy = wi.y, *iz = wi.z;
  float *w0 = weight[0], *w1 = weight[1], *w2 = weight[2], *w3 = weight[3];
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = oz[i];
    vlVec3 d = vl_cosine_direction(u[i], v[i]);
    int valid = vl_abs(zo) > 0.0f;
    ix[i] = d.x;
    iy[i] = d.y;
    iz[i] = zo < 0.0f ? -d.z : d.z;
    float on =
        valid ? 1.0f
              : 0.0f; /* a product, because gcc turns a select between loads into a branch */
    w0[i] = r0[i] * on;
    w1[i] = r1[i] * on;
    w2[i] = r2[i] * on;
    w3[i] = r3[i] * on;
    pdf[i] = d.z * VL_INV_PI * on;
    flags[i] = valid ? (uint32_t)VL_SAMPLED_DIFFUSE : (uint32_t)VL_SAMPLED_NONE;
    eta_scale[i] = 1.0f;
  }
}
