/* world/accel/share.c: see share.h. */
#include "world/accel/share.h"

#include <string.h>

#include "world/share.h"

/* Below this number of faces outside of groups, the accelerator is built anew whenever an
 * instance moves. */
enum { FEW_FACES = 4096 };

static bool same_group(const vlWorld *world, uint32_t k, const vlWorld *previous, uint32_t j) {
  const vlWorldGroup *a = &world->groups.items[k], *b = &previous->groups.items[j];
  if (a->count != b->count)
    return false;
  for (uint32_t i = 0; i < a->count; i++)
    if (!vl_shape_same(world, a->shapes[i], previous, b->shapes[i]))
      return false;
  return true;
}

void *vl_accel_find_group(const vlWorld *world, uint32_t k) {
  const vlWorld *previous = world->previous;
  if (!previous)
    return NULL;
  const vlAccel *old = &previous->accel;
  if (k < old->group_count && old->groups[k] && same_group(world, k, previous, k))
    return old->groups[k];
  const vlWorldGroup *group = &world->groups.items[k];
  if (k == 0 || group->count == 0 || world->shape_from[group->shapes[0]] == VL_NONE)
    return NULL;
  for (uint32_t j = 1; j < old->group_count; j++) { /* the numbers of the groups have changed */
    const vlWorldGroup *other = &previous->groups.items[j];
    if (other->count && other->shapes[0] == world->shape_from[group->shapes[0]] &&
        old->groups[j] && same_group(world, k, previous, j))
      return old->groups[j];
  }
  return NULL;
}

static bool same_instance(const vlWorld *world, const vlWorldInstance *a,
                          const vlWorld *previous, const vlWorldInstance *b) {
  if (world->accel.groups[a->group] != previous->accel.groups[b->group] || a->keys != b->keys)
    return false;
  if (memcmp(a->from_group, b->from_group, sizeof a->from_group) != 0)
    return false;
  return !a->keys || memcmp(a->path, b->path, 12 * (size_t)a->keys * sizeof *a->path) == 0;
}

bool vl_accel_same_whole(const vlWorld *world) {
  const vlWorld *previous = world->previous;
  if (!previous || !previous->accel.scene ||
      world->instances.count != previous->instances.count || !same_group(world, 0, previous, 0))
    return false;
  for (size_t i = 0; i < world->instances.count; i++)
    if (!same_instance(world, &world->instances.items[i], previous,
                       &previous->instances.items[i]))
      return false;
  return true;
}

bool vl_accel_must_split(const vlWorld *world) {
  const vlWorldGroup *own = &world->groups.items[0];
  /* With VL_BITS_FAST Embree decides which of two equal hits is the nearest, so the layout must
   * be that of a first build. */
  if (!world->previous || own->count == 0 || world->def.bits != VL_BITS_PORTABLE)
    return false;
  uint64_t faces = 0;
  for (uint32_t i = 0; i < own->count && faces < FEW_FACES; i++)
    faces += world->shapes.items[own->shapes[i]].faces;
  return faces >= FEW_FACES;
}
