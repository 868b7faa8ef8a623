/* world/accel/bundle.h: which shapes share one geometry of the accelerator. */
#ifndef WORLD_ACCEL_BUNDLE_H
#define WORLD_ACCEL_BUNDLE_H

#include "world/world.h"

/* Whether this shape can be part of a bundle. A shape of many spheres cannot, because it
 * already is one geometry. */
bool vl_accel_bundled(const vlWorldShape *shape);
/* Finds the shapes of a group that form its bundle. The geometry id of the bundle is that of
 * its first shape. members: array with room for all shapes of the group. Returns the number of
 * members written. */
uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group,
                              vlAccelBundle *bundle, uint32_t *members);

/* The shape of a geometry of a group. *prim is that of the geometry and becomes that of the
 * shape. */
static inline const vlWorldShape *vl_accel_group_shape(const vlWorld *world, uint32_t group,
                                                       uint32_t geometry, uint32_t *prim) {
  const vlAccelBundle *bundle = &world->accel.bundles[group];
  uint32_t index = world->groups.items[group].shapes[geometry];
  if (bundle->members && geometry == bundle->geometry) {
    index = bundle->members[*prim];
    *prim = 0;
  }
  return &world->shapes.items[index];
}

/* The shape of a hit with Embree's numbers, and its primitive. inst: number of the instance, or
 * VL_NONE. */
static inline const vlWorldShape *vl_accel_shape(const vlWorld *world, uint32_t inst,
                                                 uint32_t geometry, uint32_t *prim) {
  uint32_t group =
      inst == VL_NONE ? 0 : world->instances.items[inst - world->groups.items[0].count].group;
  return vl_accel_group_shape(world, group, geometry, prim);
}

#endif
