/* world/accel/queries.c: chooses the accelerator, and sends queries to brute force if the world
 * has it, else to Embree or the BVH. */
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "base/machine.h"
#include "world/accel/brute_force.h"
#include "world/accel/bundle.h"
#include "world/accel/bvh.h"
#include "world/accel/embree.h"
#include "world/accel/occluders.h"
#include "world/world.h"

/* Without Embree's library (VELO_EMBREE=OFF) only the BVH is chosen, and the compiler leaves
 * the calls out. */
#ifdef VELO_EMBREE_MAJOR
enum { HAS_EMBREE = 1 };
#else
enum { HAS_EMBREE = 0 };
#endif
/* Whether Embree's instruction set can be chosen, as portable bits need. */
#if defined(__x86_64__)
enum { HAS_SETS = HAS_EMBREE };
#else
enum { HAS_SETS = 0 };
#endif

vlResult vl_accel_choose(const vlBuildDef *def, vlAccelerator *kind, vlError *error) {
  bool fits = HAS_EMBREE && (HAS_SETS || def->bits == VL_BITS_FAST);
  *kind = fits && def->accelerator != VL_ACCELERATOR_BVH ? VL_ACCELERATOR_EMBREE
                                                         : VL_ACCELERATOR_BVH;
  if (fits || def->accelerator != VL_ACCELERATOR_EMBREE)
    return VL_OK;
  return vl_fail(error, VL_ERROR_UNSUPPORTED, "accelerator embree: %s; use bvh",
                 HAS_EMBREE ? "with portable bits it needs an x86-64 processor"
                            : "velo was built without Embree");
}

const char *vl_accel_fast_set(const vlBuildDef *def) {
  vlAccelerator kind;
  vlError error;
  if (vl_accel_choose(def, &kind, &error) != VL_OK || kind != VL_ACCELERATOR_EMBREE)
    return NULL;
  return HAS_EMBREE ? vl_embree_fast_set() : NULL;
}

/* Room for the groups' trees, and their bundles. False: out of memory. */
static bool prepare(vlWorld *world) {
  vlAccel *a = &world->accel;
  a->groups = vl_alloc_zero(world->context, world->groups.count, sizeof *a->groups);
  a->bundles = vl_alloc_zero(world->context, world->groups.count, sizeof *a->bundles);
  a->members = vl_alloc_array(world->context, world->shapes.count + 1, sizeof *a->members);
  if (!a->groups || !a->bundles || !a->members)
    return false;
  a->group_count = (uint32_t)world->groups.count;
  uint32_t bundled = 0;
  for (size_t k = world->groups.count; k-- > 0;)
    bundled += vl_accel_find_bundle(world, &world->groups.items[k], &a->bundles[k],
                                    a->members + bundled);
  return true;
}

vlResult vl_accel_build(vlWorld *world, vlError *error) {
  vlAccel *a = &world->accel;
  VL_TRY(vl_accel_choose(&world->def, &a->kind, error));
  if (world->previous && world->previous->accel.kind != a->kind)
    world->previous = NULL; /* it has nothing to share */
  if (!prepare(world))
    return vl_fail_memory(error);
  VL_TRY(HAS_EMBREE && a->kind == VL_ACCELERATOR_EMBREE ? vl_embree_build(world, error)
                                                        : vl_bvh_build(world, error));
  vlResult r = vl_brute_force_make(world, &a->brute_force);
  a->brute_force_kernels = vl_brute_force_kernels(vl_context_isa(world->context));
  a->occluder_kernels = vl_occluder_kernels(vl_context_isa(world->context));
  a->bvh_kernels = vl_bvh_kernels(vl_context_isa(world->context));
  return r == VL_OK ? VL_OK : vl_fail_memory(error);
}

void vl_accel_destroy(vlContext *context, vlAccel *a) {
  vl_free(context, a->brute_force);
  if (HAS_EMBREE && a->kind == VL_ACCELERATOR_EMBREE)
    vl_embree_destroy(a);
  else
    vl_bvh_destroy(context, a);
  VL_FREE(context, a->groups, a->bundles, a->members);
  memset(a, 0, sizeof *a);
}

void vl_accel_closest(const vlWorld *world, uint32_t n, const vlRays *rays, bool coherent,
                      uint32_t *shape, uint32_t *prim, uint32_t *instance, float *t) {
  const vlAccel *a = &world->accel;
  if (a->log)
    a->log(a->log_user, coherent ? 0 : 1, n, rays);
  if (a->brute_force)
    a->brute_force_kernels->closest(world, a->brute_force, n, rays, shape, prim, instance, t);
  else if (HAS_EMBREE && a->kind == VL_ACCELERATOR_EMBREE)
    vl_embree_closest(world, n, rays, coherent, shape, prim, instance, t);
  else
    a->bvh_kernels->closest(world, n, rays, shape, prim, instance, t);
}

void vl_accel_occluded(const vlWorld *world, uint32_t n, const vlRays *rays,
                       vlOccluders *occluders, uint8_t *occluded) {
  const vlAccel *a = &world->accel;
  if (a->log)
    a->log(a->log_user, 2, n, rays);
  if (a->brute_force) {
    a->brute_force_kernels->occluded(world, a->brute_force, n, rays, occluded);
    return;
  }
  if (occluders)
    vl_occluders_begin(occluders, world, n);
  if (occluders && occluders->count)
    a->occluder_kernels->test(occluders, n, rays, occluded);
  else
    memset(occluded, 0, n);
  vlOccluders *learning = occluders && occluders->learns ? occluders : NULL;
  if (HAS_EMBREE && a->kind == VL_ACCELERATOR_EMBREE)
    vl_embree_occluded(world, n, rays, learning, occluded);
  else
    a->bvh_kernels->occluded(world, n, rays, learning, occluded);
}

void vl_accel_occluded_coherent(const vlWorld *world, uint32_t n, const vlRays *rays,
                                uint8_t *occluded) {
  if (HAS_EMBREE && world->accel.kind == VL_ACCELERATOR_EMBREE && !world->accel.brute_force)
    vl_embree_occluded_packets(world, n, rays, occluded);
  else
    vl_accel_occluded(world, n, rays, NULL, occluded);
}

unsigned vl_accel_enter(void) {
  return vl_machine_set_floats();
}

void vl_accel_leave(unsigned state) {
  vl_machine_restore_floats(state);
}
