/* world/accel/bundle.c: two or more spheres, disks and cylinders of a group share one geometry
 * of the accelerator, because Embree's data per geometry take more memory than such a shape. */
#include "world/accel/bundle.h"

#include "schema/schema.h"

bool vl_accel_bundled(const vlWorldShape *s) {
  return !s->centers &&
         (vl_kind_row(&vl_shape_family, (int)s->kind)->traits & VL_SHAPE_TRAIT_QUADRIC) != 0;
}

uint32_t vl_accel_find_bundle(const vlWorld *world, const vlWorldGroup *group,
                              vlAccelBundle *bundle, uint32_t *members) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < group->count; i++) {
    if (!vl_accel_bundled(&world->shapes.items[group->shapes[i]]))
      continue;
    if (count == 0)
      bundle->geometry = i;
    members[count++] = group->shapes[i];
  }
  bundle->members = count > 1 ? members : NULL;
  bundle->count = count > 1 ? count : 0;
  return bundle->count;
}
