/* world/accel/nearest.h: which of several hits of a ray is the nearest, by velo's own rule: the smallest distance;
 * among equal ones the lowest instance, then geometry, then primitive. The rule does not depend on the order in which
 * hits are found, so neither the layout of Embree's BVH nor the other rays of a packet matter.
 *
 * Distances to triangles are Embree's T / D, with velo's division. They are computed only where Embree's own distances
 * are too close to tell. */
#ifndef WORLD_ACCEL_NEAREST_H
#define WORLD_ACCEL_NEAREST_H

#include <stdbool.h>
#include <stdint.h>

#include "world/shape/moving.h"

/* Embree computes t as T rcp(D), where velo divides. Its reciprocal (an estimate and one Newton step) differs
 * between processor makers by a few units in the last place, 2^-23 each: hits up to this factor behind the nearest
 * one must still be compared. */
#define VL_NEAREST_WINDOW (1.0f + 0x1p-20f)

typedef struct vlNearest {
  float t; /* Embree's distance, of other shapes than triangles velo's; infinity: no hit yet */
  uint32_t instance, geometry, primitive;
  const vlWorldShape *shape;   /* null: t is velo's, and what follows is not set */
  float normal[3], o[3], d[3]; /* in the space of the shape */
  float time;
} vlNearest;

/* Distance along a ray to the plane through corner with normal n. The order of operations is that of Embree's
 * instruction sets without fused multiply-add (triangle_intersector_pluecker.h), except that it divides. */
static inline float vl_plane_distance(const float corner[3], const float n[3], const float o[3], const float d[3]) {
  float v[3] = {corner[0] - o[0], corner[1] - o[1], corner[2] - o[2]};
  float height = v[0] * n[0] + (v[1] * n[1] + v[2] * n[2]);
  float speed = d[0] * n[0] + (d[1] * n[1] + d[2] * n[2]);
  return height / speed;
}

/* velo's own distance. */
static inline float vl_nearest_distance(const vlNearest *h) {
  if (!h->shape) return h->t;
  float room[3];
  const float *corner = vl_vertex_at(h->shape, h->shape->indices[3 * (size_t)h->primitive], h->time, room);
  return vl_plane_distance(corner, h->normal, h->o, h->d);
}

/* Whether hit a comes before hit b, compared in full. */
static inline bool vl_nearest_before(const vlNearest *a, const vlNearest *b) {
  float ta = vl_nearest_distance(a), tb = vl_nearest_distance(b);
  if (ta != tb) return ta < tb;
  /* Embree's "no instance" is the largest number: hits inside instances come first. */
  return a->instance != b->instance   ? a->instance < b->instance
         : a->geometry != b->geometry ? a->geometry < b->geometry
                                      : a->primitive < b->primitive;
}

/* Whether the distances alone tell that a hit at t comes before the known one. */
static inline bool vl_nearest_clearly(const vlNearest *known, float t) {
  return t * VL_NEAREST_WINDOW < known->t;
}

/* Takes the hit if it comes before the known one. Returns whether it was taken. */
static inline bool vl_nearest_offer(vlNearest *known, const vlNearest *hit) {
  if (!vl_nearest_clearly(known, hit->t) &&
      (!(hit->t <= known->t * VL_NEAREST_WINDOW) || !vl_nearest_before(hit, known)))
    return false;
  *known = *hit;
  return true;
}

#endif
