/* world/accel/bundle.h: which shapes share one geometry of the accelerator. */
#ifndef WORLD_ACCEL_BUNDLE_H
#define WORLD_ACCEL_BUNDLE_H

#include "world/world.h"

/* Whether this shape can be part of a bundle. A shape of many spheres cannot, because it already is one geometry. */
bool vl_accel_bundled(const vlWorldShape *shape);
/* Finds the shapes of a group that form its bundle. The geometry id of the bundle is that of its first shape. members:
 * array with room for all shapes of the group. Returns the number of members written. */
uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group, vlAccelBundle *bundle,
                              uint32_t *members);

#endif
