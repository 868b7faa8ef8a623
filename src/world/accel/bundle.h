/* world/accel/bundle.h: which shapes share one geometry of the accelerator. */
#ifndef WORLD_ACCEL_BUNDLE_H
#define WORLD_ACCEL_BUNDLE_H

#include "world/world.h"

/* Whether this shape can be part of a bundle. Many spheres cannot: they are one geometry already. */
bool vl_accel_bundled(const vlWorldShape *shape);
/* Finds the bundle of a group; its geometry id is that of its first shape. members: room for all shapes of the
 * group. Returns how many members were written. */
uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group, vlAccelBundle *bundle,
                              uint32_t *members);

#endif
