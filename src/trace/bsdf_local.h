/* trace/bsdf_local.h: what the BSDF files share: their entry points, one pair a kind and instruction set, gathered in
 * bsdf_table.hot.c, and the small functions all of them inline.
 *
 * Shape of every kernel: one loop over the padded batch, both outcomes of each choice computed and selected, so that
 * it vectorises; local copies of the array pointers, so that the compiler need not reload them. Padding lanes may hold
 * anything. A lane whose wo lies in the surface (z = 0) has no value and no sample. Directions from below are mirrored
 * at the surface, z -> -z, on the way in and out: every kind here is even in z, dielectrics with eta -> 1/eta. */
#ifndef TRACE_BSDF_LOCAL_H
#define TRACE_BSDF_LOCAL_H

#include "math/fresnel.h"
#include "math/ggx.h"
#include "trace/bsdf.h"

/* A count of whole vectors, so that the compiler sees it and makes no remainder loop. */
#ifndef VL_WHOLE
#define VL_WHOLE(count) ((count) & ~15u)
#endif

#define VL_BSDF_DECLARE(kind)                                                                                          \
  void VL_HOT(vl_bsdf_##kind##_eval)(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, vlBsdfDirections wi, \
                                     float *const value[4], float *pdf);                                               \
  void VL_HOT(vl_bsdf_##kind##_sample)(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,                    \
                                       const float *u_lobe, const float *u, const float *v, vlBsdfDirections wi,       \
                                       float *const weight[4], float *pdf, uint32_t *flags, float *eta_scale)
VL_BSDF_DECLARE(diffuse);
VL_BSDF_DECLARE(conductor);
VL_BSDF_DECLARE(dielectric);
VL_BSDF_DECLARE(thin);
VL_BSDF_DECLARE(coat);

/* Cosine-weighted direction about +z: the square goes to the disk by squares onto circles, so that strata stay whole
 * (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square"), then up (Malley). u, v in [0, 1). z > 0. */
static inline vlVec3 vl_cosine_direction(float u, float v) {
  float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  int wide = vl_abs(a) > vl_abs(b);
  float r = wide ? a : b, other = wide ? b : a;
  float q = other / (r != 0.0f ? r : 1.0f);
  vlSinCos t = vl_sincos_kernel(0.785398163397448310f * q);
  float x = r * (wide ? t.cos : t.sin), y = r * (wide ? t.sin : t.cos);
  float z2 = 1.0f - r * r;
  return vl_vec3(x, y, __builtin_sqrtf(z2 > 1e-12f ? z2 : 1e-12f));
}

/* wo mirrored at the normal h; oh = wo.h */
static inline vlVec3 vl_reflect(vlVec3 wo, vlVec3 h, float oh) {
  float s = 2.0f * oh;
  return vl_vec3(s * h.x - wo.x, s * h.y - wo.y, s * h.z - wo.z);
}

#endif
