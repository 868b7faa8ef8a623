/* world/accel/bundle.c: spheres, disks and cylinders of a group, from two on, are one geometry of the accelerator: one
 * each costs more than they do. */
#include "world/accel/bundle.h"

bool vl_accel_bundled(const vlWorldShape *s) {
  return !s->centers && (s->kind == VL_SHAPE_SPHERE || s->kind == VL_SHAPE_DISK || s->kind == VL_SHAPE_CYLINDER);
}

uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group, vlAccelBundle *bundle,
                              uint32_t *members) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < group->count; i++) {
    if (!vl_accel_bundled(&world->shapes.items[group->shapes[i]])) continue;
    if (count == 0) bundle->geometry = i;
    members[count++] = group->shapes[i];
  }
  bundle->members = count > 1 ? members : NULL;
  bundle->count = count > 1 ? count : 0;
  return bundle->count;
}
