/* world/accel/embree.h: the functions of accel.h, by Embree. */
#ifndef WORLD_ACCEL_EMBREE_H
#define WORLD_ACCEL_EMBREE_H

#include "world/accel/accel.h"

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
