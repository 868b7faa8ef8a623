/* world/accel/share.h: which of Embree's scenes a world shares with the previous one
 * (vlBuildDef.previous). */
#ifndef WORLD_ACCEL_SHARE_H
#define WORLD_ACCEL_SHARE_H

#include "world/world.h"

/* The scene of the previous world that has the same shapes as group k; null: there is none. */
void *vl_accel_find_group(const vlWorld *world, uint32_t k);
/* Whether the whole accelerator is that of the previous world. The scenes of the groups >= 1
 * are set. */
bool vl_accel_same_whole(const vlWorld *world);
/* Whether the shapes of group 0 get a scene of their own although the world has instances
 * (vlAccel.split). */
bool vl_accel_must_split(const vlWorld *world);

#endif
