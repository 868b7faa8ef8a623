/* trace/surface/points.h: the surfaces that rays hit: points of whole batches, of blocks and of
 * single lanes, and where a ray goes on behind one. */
#ifndef TRACE_SURFACE_POINTS_H
#define TRACE_SURFACE_POINTS_H

#include "trace/rows.h"

/* Computes the surface points that the rays hit. Of the hits, it reads only the ids. */
void vl_stage_surface(const vlWorld *world, uint32_t n, const vlPaths *paths,
                      const vlHits *hits, vlCorners *corners, vlSurface *surface);
/* What media need of the surfaces that the rays of a block hit: distance, geometric normal and
 * offset (vlSurface), with the same bits. shape, prim, instance, hit (vlHits.t): rows of the
 * hits' ids. */
enum { VL_CROSSINGS = 64 };
typedef struct vlCrossings {
  uint32_t *shape, *prim, *instance;
  float *hit;
  VL_ROW float t[VL_CROSSINGS], gx[VL_CROSSINGS], gy[VL_CROSSINGS], gz[VL_CROSSINGS],
      offset[VL_CROSSINGS];
  VL_ROW float corner[3][3][VL_CROSSINGS], normal[3][3][VL_CROSSINGS], error[VL_CROSSINGS],
      flip[VL_CROSSINGS];
} vlCrossings;
/* Computes the crossings of `count` lanes of a block of n rays. */
void vl_stage_crossings(const vlWorld *world, uint32_t n, const vlRays *rays,
                        const uint32_t *lanes, uint32_t count, vlCrossings *x);
/* Computes the footprints' axes in uv. The surfaces must be computed already. */
void vl_stage_footprints(uint32_t n, const vlPaths *paths, vlSurface *surface);

/* One surface point, for lanes that are computed one by one (hit lights, mixed materials). t:
 * as in vlHits. */
typedef struct vlPoint {
  vlVec3 p, g, n; /* geometric, shading normal */
  float u, v, t, offset;
} vlPoint;
/* A hit's distance t is a float. When the distance is computed again in double, it lies within
 * t (1 -+ VL_REFIND), which allows 8 float roundings. VL_REFIND_LEAST keeps that interval from
 * being empty at t = 0. */
#define VL_REFIND 0x1p-21
#define VL_MIN_REFIND 1e-37

/* The start of a ray segment past t by a margin. It is larger than t_min even if t_min and
 * margin are 0. */
static inline float vl_past(float t, float margin, float t_min) {
  return vl_max(t, t_min) + vl_max(margin, VL_MIN_POSITIVE);
}
/* Returns the start of a ray segment just past a surface point. The margin comes from the bound
 * of the point's error, and from that of distances from the ray's origin (as in vl_offset_end).
 * The result is larger than t_min. */
static inline float vl_past_crossing(float t, vlVec3 g, float offset, vlVec3 d, float t_min) {
  float error = 2.0f * (offset + 2.0f * VL_GAMMA(5) * vl_abs(t) * vl_dot_of_abs(g, d));
  return vl_past(t, error / vl_max(vl_abs(vl_dot(g, d)), 0.01f) + VL_GAMMA(8) * vl_abs(t),
                 t_min);
}
static inline float vl_past_surface(const vlPoint *at, vlVec3 d, float t_min) {
  return vl_past_crossing(at->t, at->g, at->offset, d, t_min);
}
/* The surface point that lane i's ray meets. */
vlPoint vl_hit_point(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i);
vlPoint vl_point_at_time(const vlWorld *world, float time, vlVec3 o, vlVec3 d, uint32_t shape,
                         uint32_t prim, uint32_t instance, float t);

/* Axes (full widths) of the ellipse in which a cone around a ray of direction d meets a surface
 * with normal g. width: the cone's width there. The axis along the ray is at most 64 times as
 * long as the axis across the ray. */
typedef struct vlFootprint {
  vlVec3 across, along;
} vlFootprint;
static inline vlFootprint vl_footprint_of(vlVec3 d, vlVec3 g, float width) {
  float cosine = vl_abs(vl_dot(d, g));
  vlVec3 a = vl_cross(g, d);
  float l2 = vl_length2(a),
        inv =
            l2 > 1e-12f
                ? /* the sine is above 1e-6, so the cross product is more than rounding error */
                1.0f / __builtin_sqrtf(l2)
                : 0.0f;
  vlFrame any = vl_frame_from_z(g);
  a.x = inv > 0.0f ? a.x * inv : any.x.x;
  a.y = inv > 0.0f ? a.y * inv : any.x.y;
  a.z = inv > 0.0f ? a.z * inv : any.x.z;
  vlFootprint r = {vl_mul(a, width),
                   vl_mul(vl_cross(a, g), width / vl_max(cosine, 1.0f / 64.0f))};
  return r;
}

#endif
