/* trace/surface/footprint.hot.c: the footprint of a pixel on a surface. The cone around a ray
 * intersects the surface in an ellipse, as wide as the cone across the plane of incidence and
 * longer along it at grazing angles. Its two axes in uv select the filtering of images
 * (texture/lookup.h). */
#include "trace/stages.h"

void vl_stage_footprints(uint32_t n, const vlPaths *paths, vlSurface *f) {
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 d = vl_vec3(paths->d.x[i], paths->d.y[i], paths->d.z[i]),
           g = vl_vec3(f->g.x[i], f->g.y[i], f->g.z[i]);
    vlVec3 u = vl_vec3(f->dpdu.x[i], f->dpdu.y[i], f->dpdu.z[i]),
           v = vl_vec3(f->dpdv.x[i], f->dpdv.y[i], f->dpdv.z[i]);
    vlFootprint r = vl_footprint_of(d, g, f->width[i]);
    /* Solves X = a u + b v by least squares, because u and v lie only approximately in the
     * surface. */
    float uu = vl_dot(u, u), uv = vl_dot(u, v), vv = vl_dot(v, v), det = uu * vv - uv * uv;
    float inv = det > 0.0f && f->uv_scale[i] > 0.0f ? 1.0f / det : 0.0f;
    float au = vl_dot(r.across, u), av = vl_dot(r.across, v), bu = vl_dot(r.along, u),
          bv = vl_dot(r.along, v);
    f->across_u[i] = (vv * au - uv * av) * inv;
    f->across_v[i] = (uu * av - uv * au) * inv;
    f->along_u[i] = (vv * bu - uv * bv) * inv;
    f->along_v[i] = (uu * bv - uv * bu) * inv;
  }
}
