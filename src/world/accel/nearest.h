/* world/accel/nearest.h: which of several hits of a ray is the nearest, by velo's own rule: the smallest t; among
 * equal ones the lowest instance, then geometry, then primitive. The rule does not depend on the order in which hits
 * are found, so neither the layout of Embree's BVH nor the other rays of a packet matter. */
#ifndef WORLD_ACCEL_NEAREST_H
#define WORLD_ACCEL_NEAREST_H

#include <stdbool.h>
#include <stdint.h>

typedef struct vlNearest {
  float t; /* infinity: no hit yet */
  uint32_t instance, geometry, primitive;
} vlNearest;

/* Embree computes t as T rcp(D), where velo divides. Its reciprocal (an estimate and one Newton step) differs
 * between processor makers by a few units in the last place, 2^-23 each: hits up to this factor behind the nearest
 * one must still be compared. */
#define VL_NEAREST_WINDOW (1.0f + 0x1p-20f)

/* Takes the hit if it comes before the known one. Returns whether it was taken. */
static inline bool vl_nearest_offer(vlNearest *known, float t, uint32_t instance, uint32_t geometry,
                                    uint32_t primitive) {
  if (!(t <= known->t)) return false;
  if (t == known->t) {
    /* Embree's "no instance" is the largest number: hits inside instances come first. */
    bool before = instance != known->instance   ? instance < known->instance
                  : geometry != known->geometry ? geometry < known->geometry
                                                : primitive < known->primitive;
    if (!before) return false;
  }
  *known = (vlNearest){t, instance, geometry, primitive};
  return true;
}

/* Distance along a ray to the plane through corner with normal n. The order of operations is that of Embree's
 * instruction sets without fused multiply-add (triangle_intersector_pluecker.h), except that it divides. */
static inline float vl_plane_distance(const float corner[3], const float n[3], const float o[3], const float d[3]) {
  float v[3] = {corner[0] - o[0], corner[1] - o[1], corner[2] - o[2]};
  float height = v[0] * n[0] + (v[1] * n[1] + v[2] * n[2]);
  float speed = d[0] * n[0] + (d[1] * n[1] + d[2] * n[2]);
  return height / speed;
}

#endif
