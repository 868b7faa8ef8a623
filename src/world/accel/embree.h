/* world/accel/embree.h: the functions of accel.h, by Embree. */
#ifndef WORLD_ACCEL_EMBREE_H
#define WORLD_ACCEL_EMBREE_H

#include "world/accel/accel.h"

/* What the callbacks of Embree's scenes read. It lies behind Embree's context, with which a query begins. */
typedef struct vlEmbreeQuery {
  const struct vlWorld *world;
  const vlRays *rays;
  struct vlNearest *nearest; /* nearest hits so far of rays first, first + 1, ...; null: Embree decides */
  uint32_t first;
  vlOccluders *occluders; /* learns the triangles that block the rays; null: nothing does */
} vlEmbreeQuery;

/* Builds Embree's scenes and the members of vlAccel that describe them. */
vlResult vl_embree_build(struct vlWorld *world, vlError *error);
/* Frees them and sets *accel to 0. */
void vl_embree_destroy(vlContext *context, vlAccel *accel);
void vl_embree_closest(const struct vlWorld *world, uint32_t n, const vlRays *rays, bool coherent, uint32_t *shape,
                       uint32_t *prim, uint32_t *instance, float *t);
/* Rays whose occluded[i] is already 1 are left out. occluders: learns which triangles block rays; null: nothing does.
 */
void vl_embree_occluded(const struct vlWorld *world, uint32_t n, const vlRays *rays, vlOccluders *occluders,
                        uint8_t *occluded);

#endif
