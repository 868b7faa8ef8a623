/* trace/bsdf/local.h: what the BSDF files share: their entry points, one pair a kind and instruction set, gathered in
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
#include "math/warp.h"
#include "trace/bsdf/bsdf.h"

/* A count of whole vectors, so that the compiler sees it and makes no remainder loop. */
#ifndef VL_SCALAR
#define VL_WHOLE(count) ((count) & ~15u)
#else
#define VL_WHOLE(count) (count)
#endif

#define VL_BSDF_DECLARE(kind)                                                                                    \
  void vl_bsdf_##kind##_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, vlBsdfDirections wi,   \
                             float *const value[4], float *pdf);                                                 \
  void vl_bsdf_##kind##_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, const float *u_lobe, \
                               const float *u, const float *v, vlBsdfDirections wi, float *const weight[4],      \
                               float *pdf, uint32_t *flags, float *eta_scale)
VL_BSDF_DECLARE(diffuse);
VL_BSDF_DECLARE(conductor);
VL_BSDF_DECLARE(dielectric);
VL_BSDF_DECLARE(thin);
VL_BSDF_DECLARE(coat);
VL_BSDF_DECLARE(principled);
VL_BSDF_DECLARE(translucent);
VL_BSDF_DECLARE(layered);
VL_BSDF_DECLARE(hair);
VL_BSDF_DECLARE(measured);

/* Cosine-weighted direction about +z. u, v in [0, 1). z > 0 always, so that no sample is lost. */
static inline vlVec3 vl_cosine_direction(float u, float v) {
  vlDiskPoint d = vl_warp_disk(u, v);
  float z2 = (1.0f - d.r) * (1.0f + d.r);
  return vl_vec3(d.x, d.y, __builtin_sqrtf(z2 > 1e-12f ? z2 : 1e-12f));
}

/* wo mirrored at the normal h; oh = wo.h */
static inline vlVec3 vl_reflect(vlVec3 wo, vlVec3 h, float oh) {
  float s = 2.0f * oh;
  return vl_vec3(s * h.x - wo.x, s * h.y - wo.y, s * h.z - wo.z);
}

#endif
