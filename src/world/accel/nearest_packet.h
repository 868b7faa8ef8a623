/* world/accel/nearest_packet.h: nearest.h for the rays of a packet: most hits are clearly
 * nearer than what is known, which vectors find out without a branch for each ray. */
#ifndef WORLD_ACCEL_NEAREST_PACKET_H
#define WORLD_ACCEL_NEAREST_PACKET_H

#include <string.h>

#include "base/isa.h"
#include "world/accel/accel.h"
#include "world/accel/nearest.h"
#include "world/world.h"

/* Rays in a packet: as many as fit into the vectors of the widest set without fused
 * multiply-add. */
enum { VL_PACKET = 8 };

/* The nearest hits so far. Rows of VL_PACKET numbers. */
typedef struct vlNearestPacket {
  float t[VL_PACKET]; /* infinity: no hit yet */
  /* Of hits inside instances: the ray in the group's space. */
  float o[3][VL_PACKET], d[3][VL_PACKET], time[VL_PACKET];
  /* Where the accelerator keeps the hits that it was told to keep: the numbers of vlNearest. */
  const float *normal[3];
  const uint32_t *instance, *geometry, *primitive;
} vlNearestPacket;

static inline void vl_packet_clear(vlNearestPacket *p) {
  for (int k = 0; k < VL_PACKET; k++)
    p->t[k] = __builtin_inff();
}

/* Whether all hits are clearly nearer than what is known. t: of the hits; valid: -1 where there
 * is one, else 0. */
static inline bool vl_packet_clearly(const vlNearestPacket *p, const float *t,
                                     const int *valid) {
  int unclear = 0;
  VL_SIMD
  for (int k = 0; k < VL_PACKET; k++)
    unclear |= valid[k] & -(int)!(t[k] * VL_NEAREST_WINDOW < p->t[k]);
  return !unclear;
}

/* Where valid is -1, `to` becomes `from`: rows of numbers of four bytes. */
static inline void vl_packet_blend(float *to, const float *from, const int *valid) {
  uint32_t old[VL_PACKET], new[VL_PACKET];
  memcpy(old, to, sizeof old);
  memcpy(new, from, sizeof new);
  VL_SIMD
  for (int k = 0; k < VL_PACKET; k++)
    old[k] ^= (old[k] ^ new[k]) & (uint32_t)valid[k];
  memcpy(to, old, sizeof old);
}

/* What is known of ray k. instance: as in vlNearest. i: the ray in `rays`, those of the
 * query. */
static inline vlNearest vl_packet_known(const vlNearestPacket *p, const vlWorld *world,
                                        const vlRays *rays, uint32_t instance, uint32_t i,
                                        uint32_t k) {
  vlNearest hit = {.t = p->t[k], .instance = instance};
  if (!(hit.t < __builtin_inff()))
    return hit;
  uint32_t prim = hit.primitive = p->primitive[k];
  hit.geometry = p->geometry[k];
  if (!vl_accel_shape(world, instance, hit.geometry, &prim)->triangles)
    return hit;
  bool inside = instance != VL_NONE;
  const float *const o[3] = {rays->ox, rays->oy, rays->oz};
  const float *const d[3] = {rays->dx, rays->dy, rays->dz};
  hit.world = world;
  for (int j = 0; j < 3; j++) {
    hit.normal[j] = p->normal[j][k];
    hit.o[j] = inside ? p->o[j][k] : o[j][i];
    hit.d[j] = inside ? p->d[j][k] : d[j][i];
  }
  hit.time = inside ? p->time[k] : rays->time ? rays->time[i] : 0.0f;
  return hit;
}

#endif
