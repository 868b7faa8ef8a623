/* world/accel/embree.h: the functions of accel.h, by Embree. */
#ifndef WORLD_ACCEL_EMBREE_H
#define WORLD_ACCEL_EMBREE_H

#include "world/accel/accel.h"

/* What the callbacks of Embree's scenes read. It lies behind Embree's context, with which a
 * query begins. */
typedef struct vlEmbreeQuery {
  const struct vlWorld *world;
  const vlRays *rays;
  /* The nearest hits so far: of ray `first`, or of the packet that begins there. Both null:
   * Embree decides. */
  struct vlNearest *nearest;
  struct vlNearestPacket *packet;
  uint32_t first;
  vlOccluders *occluders; /* learns the triangles that block the rays; null: nothing does */
} vlEmbreeQuery;

/* Builds Embree's scenes. The bundles of vlAccel are made, and its groups are null. */
vlResult vl_embree_build(struct vlWorld *world, vlError *error);
void vl_embree_destroy(vlAccel *accel);
/* Chooses the instruction set that Embree must use; *name null: Embree's own choice. For
 * VL_BITS_PORTABLE it is the widest set without fused multiply-add. The environment variable
 * VELO_EMBREE overrides both. Errors: ARGUMENT, UNSUPPORTED (of VELO_EMBREE). */
vlResult vl_embree_choose_set(vlBits bits, const char **name, vlError *error);
/* The instruction set for VL_BITS_FAST (vl_accel_fast_set). */
const char *vl_embree_fast_set(void);
void vl_embree_closest(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                       bool coherent, uint32_t *shape, uint32_t *prim, uint32_t *instance,
                       float *t);
/* Rays whose occluded[i] is already 1 are left out. occluders: learns which triangles block
 * rays; null: nothing does. */
void vl_embree_occluded_packets(const vlWorld *world, uint32_t n, const vlRays *rays,
                                uint8_t *occluded);
void vl_embree_occluded(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                        vlOccluders *occluders, uint8_t *occluded);

#endif
