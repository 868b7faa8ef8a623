/* material/local.hot.h: small inline functions and the entry points that the BSDF files share.
 * Each kind has one pair of entry points per instruction set; table.hot.c collects them.
 *
 * Every kernel is one loop over the padded batch. To vectorise, it computes both outcomes of
 * each choice and selects one. It reads and writes arrays in the loop itself, not in a
 * called function, or clang would not vectorise it. Padding lanes may hold any values. If wo
 * lies in the surface (z = 0), the value is 0 and there is no sample. For a wo from below, wo
 * and wi are mirrored at the surface, z -> -z: each BSDF here is symmetric in z, dielectrics
 * with eta -> 1/eta. */
#ifndef MATERIAL_LOCAL_HOT_H
#define MATERIAL_LOCAL_HOT_H

#include "material/bsdf.hot.h"
#include "math/fresnel.h"
#include "math/ggx.h"
#include "math/warp.h"

/* The count of a padded batch, written so that the compiler sees a multiple of the vector width
 * and makes no remainder loop. */
#ifndef VL_SCALAR
#define VL_WHOLE(count) ((count) & ~15u)
#else
#define VL_WHOLE(count) (count)
#endif

/* The arrays from lane `first` on. */
static inline vlBsdfDirections vl_directions_from(vlBsdfDirections d, uint32_t first) {
  return (vlBsdfDirections){d.x + first, d.y + first, d.z + first};
}
static inline vlBsdfRandom vl_random_from(vlBsdfRandom r, uint32_t first) {
  return (vlBsdfRandom){r.lobe + first, r.u + first, r.v + first};
}
static inline vlBsdfSampled vl_sampled_from(vlBsdfSampled s, uint32_t first) {
  s.wi = vl_directions_from(s.wi, first);
  for (int c = 0; c < 4; c++)
    s.weight[c] += first;
  s.pdf += first;
  s.flags += first;
  s.eta_scale += first;
  return s;
}

/* Samples a cosine-weighted direction around +z. u, v: uniform in [0, 1). z is always above 0,
 * so that no sample is lost. */
static inline vlVec3 vl_cosine_direction(float u, float v) {
  vlDiskPoint d = vl_warp_disk(u, v);
  float z2 = (1.0f - d.r) * (1.0f + d.r);
  /* z is at least VL_MIN_FRACTION */
  return vl_vec3(d.x, d.y, __builtin_sqrtf(z2 > 1e-12f ? z2 : 1e-12f));
}

/* A sample of the normals that are visible from o (vl_ggx_sample); of a smooth lane the
 * surface's. */
static inline vlVec3 vl_microfacet(vlVec3 o, float alpha_x, float alpha_y, int smooth, float u,
                                   float v) {
  vlVec3 h = vl_ggx_sample(o, alpha_x, alpha_y, u, v);
  return vl_vec3(smooth ? 0.0f : h.x, smooth ? 0.0f : h.y, smooth ? 1.0f : h.z);
}

/* Reflects wo about the normal h; oh: the dot product of wo and h. */
static inline vlVec3 vl_reflect(vlVec3 wo, vlVec3 h, float oh) {
  float s = 2.0f * oh;
  return vl_vec3(s * h.x - wo.x, s * h.y - wo.y, s * h.z - wo.z);
}

#endif
