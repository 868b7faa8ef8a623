/* world/accel/bundle.h: which shapes are one geometry of the accelerator together. */
#ifndef WORLD_ACCEL_BUNDLE_H
#define WORLD_ACCEL_BUNDLE_H

#include "world/world.h"

/* Can this shape (many spheres are a geometry already) be part of a bundle? */
bool vl_accel_bundled(const vlWorldShape *shape);
/* The bundle of a group; it stands at its first shape's id. members: room for the group's shapes; how many of them are
 * taken is returned. */
uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group, vlAccelBundle *bundle,
                              uint32_t *members);

#endif
