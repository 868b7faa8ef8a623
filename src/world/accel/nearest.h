/* world/accel/nearest.h: which of several hits of a ray is the nearest, by velo's own rule: the
 * smallest distance; among equal distances the lowest instance, then geometry, then primitive.
 * The rule does not depend on the order in which hits are found, so the result does not depend
 * on the layout of Embree's BVH or on the other rays of a packet.
 *
 * The distance to a triangle is the quotient T / D of Embree's intersector, computed with an
 * exact division. It is computed only if Embree's own distances are too close to each other to
 * decide. */
#ifndef WORLD_ACCEL_NEAREST_H
#define WORLD_ACCEL_NEAREST_H

#include <stdbool.h>
#include <stdint.h>

#include "world/accel/bundle.h"
#include "world/moving.h"

/* Embree computes t as T * rcp(D), where velo divides. The reciprocal (an estimate and one
 * Newton step) differs between processor makers by a few units in the last place, 2^-23 each.
 * Hits whose distance is up to this factor larger than the nearest one must therefore be
 * compared in full. */
#define VL_NEAREST_WINDOW (1.0f + 0x1p-20f)

typedef struct vlNearest {
  float t; /* for triangles Embree's distance, for other shapes velo's; infinity: no hit yet */
  uint32_t instance, geometry, primitive;
  const vlWorld *world; /* null: t is velo's own, and the following members are not set */
  /* Normal (not normalised) and ray, in the space of the shape's group. The ray has Embree's
   * layout (RTCRay). */
  float normal[3];
  float o[3], t_min, d[3], time;
} vlNearest;

/* Distance along a ray, in units of d, to the plane through `corner` with normal n. The order
 * of operations is that of Embree's instruction sets without fused multiply-add
 * (triangle_intersector_pluecker.h), except that it divides. */
static inline float vl_plane_distance(const float corner[3], const float n[3], const float o[3],
                                      const float d[3]) {
  float v[3] = {corner[0] - o[0], corner[1] - o[1], corner[2] - o[2]};
  float height = v[0] * n[0] + (v[1] * n[1] + v[2] * n[2]);
  float speed = d[0] * n[0] + (d[1] * n[1] + d[2] * n[2]);
  return height / speed;
}

/* The distance in velo's own arithmetic. */
static inline float vl_nearest_distance(const vlNearest *h) {
  if (!h->world)
    return h->t;
  float room[3];
  uint32_t prim = h->primitive;
  const vlWorldShape *s = vl_accel_shape(h->world, h->instance, h->geometry, &prim);
  const float *corner = vl_vertex_at(s, s->indices[3 * (size_t)prim], h->time, room);
  return vl_plane_distance(corner, h->normal, h->o, h->d);
}

/* Whether hit a comes before hit b by the full rule. */
static inline bool vl_nearest_before(const vlNearest *a, const vlNearest *b) {
  float ta = vl_nearest_distance(a), tb = vl_nearest_distance(b);
  if (ta != tb)
    return ta < tb;
  /* Embree's number for "no instance" is the largest one, so hits inside instances come
   * first. */
  return a->instance != b->instance   ? a->instance < b->instance
         : a->geometry != b->geometry ? a->geometry < b->geometry
                                      : a->primitive < b->primitive;
}

/* Whether a hit at distance t is nearer than the known hit by more than the error of Embree's
 * distances. */
static inline bool vl_nearest_clearly(const vlNearest *known, float t) {
  return t * VL_NEAREST_WINDOW < known->t;
}

/* Replaces *known by *hit if hit comes before it. Returns whether it did. A distance that
 * overflows is no hit. */
static inline bool vl_nearest_offer(vlNearest *known, const vlNearest *hit) {
  if (!vl_nearest_clearly(known, hit->t)) {
    bool close = known->t < __builtin_inff() && hit->t <= known->t * VL_NEAREST_WINDOW;
    if (!close || !vl_nearest_before(hit, known))
      return false;
  }
  *known = *hit;
  return true;
}

#endif
