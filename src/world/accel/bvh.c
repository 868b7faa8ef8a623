/* world/accel/bvh.c: the trees of a world: one for each group, and one for all instances
 * (vlAccel.scene). Those of the previous world are shared. */
#include "world/accel/bvh.h"

#include "base/free.h"
#include "world/accel/share.h"

void vl_bvh_map(const float m[12], float w[12]) {
  float x[3] = {m[0], m[4], m[8]}, y[3] = {m[1], m[5], m[9]}, z[3] = {m[2], m[6], m[10]};
  const float *a[3] = {y, z, x}, *b[3] = {z, x, y};
  for (int i = 0; i < 3; i++) { /* rows of the adjugate: y x z, z x x, x x y */
    w[4 * i] = a[i][1] * b[i][2] - a[i][2] * b[i][1];
    w[4 * i + 1] = a[i][2] * b[i][0] - a[i][0] * b[i][2];
    w[4 * i + 2] = a[i][0] * b[i][1] - a[i][1] * b[i][0];
  }
  float volume = (x[0] * w[0] + x[1] * w[1]) + x[2] * w[2];
  for (int i = 0; i < 3; i++) {
    float *row = w + 4 * i;
    for (int j = 0; j < 3; j++)
      row[j] = row[j] / volume;
    row[3] = -(m[3] * row[0] + (m[7] * row[1] + m[11] * row[2]));
  }
}

void vl_bvh_release(vlContext *context, vlBvh *tree) {
  if (!tree || atomic_fetch_sub(&tree->users, 1) > 1)
    return;
  for (vlBvhBlock *block = tree->blocks, *next; block; block = next) {
    next = block->next;
    vl_free(context, block);
  }
  VL_FREE(context, tree->maps, tree);
}

vlResult vl_bvh_build(vlWorld *world, vlError *error) {
  vlAccel *a = &world->accel;
  vlResult r = VL_OK;
  for (uint32_t k = a->group_count; r == VL_OK && k-- > 0;) {
    vlBvh *tree = vl_accel_find_group(world, k);
    if (tree)
      atomic_fetch_add(&tree->users, 1);
    else
      r = vl_bvh_make(world, k, &tree, error);
    a->groups[k] = tree;
    if (r == VL_OK)
      r = vl_world_step(world, "accelerator", 0.5 + 0.5 / (k + 1), error);
  }
  if (r != VL_OK || world->instances.count == 0)
    return r;
  a->split = true;
  vlBvh *tree = vl_accel_same_whole(world) ? world->previous->accel.scene : NULL;
  if (tree)
    atomic_fetch_add(&tree->users, 1);
  else
    r = vl_bvh_make(world, VL_NONE, &tree, error);
  a->scene = tree;
  return r;
}

void vl_bvh_destroy(vlContext *context, vlAccel *a) {
  for (uint32_t k = 0; k < a->group_count; k++)
    vl_bvh_release(context, a->groups[k]);
  vl_bvh_release(context, a->scene);
}
