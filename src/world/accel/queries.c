/* world/accel/queries.c: sends queries to brute force if the world has it, else to Embree. */
#include "world/accel/accel.h"

#include <string.h>

#include "base/error.h"
#include "base/machine.h"
#include "world/accel/brute_force.h"
#include "world/accel/embree.h"
#include "world/accel/occluders.h"
#include "world/world.h"

vlResult vl_accel_build(vlWorld *world, vlError *error) {
  vlResult r = vl_embree_build(world, error);
  if (r != VL_OK) return r;
  r = vl_brute_force_make(world, &world->accel.brute_force);
  world->accel.brute_force_kernels = vl_brute_force_kernels(vl_context_isa(world->context));
  world->accel.occluder_kernels = vl_occluder_kernels(vl_context_isa(world->context));
  return r == VL_OK ? VL_OK : vl_fail_memory(error);
}

void vl_accel_destroy(vlContext *context, vlAccel *accel) {
  vl_free(context, accel->brute_force);
  vl_embree_destroy(context, accel);
}

void vl_accel_closest(const vlWorld *world, uint32_t n, const vlRays *rays, bool coherent, uint32_t *shape,
                      uint32_t *prim, uint32_t *instance, float *t) {
  const vlAccel *a = &world->accel;
  if (a->log) a->log(a->log_user, coherent ? 0 : 1, n, rays);
  if (a->brute_force)
    a->brute_force_kernels->closest(world, a->brute_force, n, rays, shape, prim, instance, t);
  else
    vl_embree_closest(world, n, rays, coherent, shape, prim, instance, t);
}

void vl_accel_occluded(const vlWorld *world, uint32_t n, const vlRays *rays, vlOccluders *occluders,
                       uint8_t *occluded) {
  const vlAccel *a = &world->accel;
  if (a->log) a->log(a->log_user, 2, n, rays);
  if (a->brute_force) {
    a->brute_force_kernels->occluded(world, a->brute_force, n, rays, occluded);
    return;
  }
  if (occluders) vl_occluders_begin(occluders, world, n);
  if (occluders && occluders->count)
    a->occluder_kernels->test(occluders, n, rays, occluded);
  else
    memset(occluded, 0, n);
  vl_embree_occluded(world, n, rays, occluders && occluders->learns ? occluders : NULL, occluded);
}

unsigned vl_accel_enter(void) {
  return vl_machine_flush_denormals();
}

void vl_accel_leave(unsigned state) {
  vl_machine_restore_denormals(state);
}
