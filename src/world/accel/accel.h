/* world/accel/accel.h: nearest-hit and occlusion queries: by Embree (embree.h) or velo's own
 * tree (bvh.h), or for worlds of few primitives by brute force (brute_force.h). Queries return
 * ids. velo recomputes t, u and v in its own arithmetic, because Embree's values differ between
 * its instruction sets. */
#ifndef WORLD_ACCEL_ACCEL_H
#define WORLD_ACCEL_ACCEL_H

#include "base/context.h"
#include "math/vec.h"
#include "velo/world.h"

#define VL_NONE 0xffffffffu

struct vlWorld;
typedef struct vlOccluders vlOccluders;

/* Rays in world space, as a structure of arrays. o: origin, d: direction. */
typedef struct vlRays {
  const float *ox, *oy, *oz, *dx, *dy, *dz;
  const float *t_min, *t_max; /* interval of hits along the ray; null: 0 and infinity */
  const float *time;          /* in the world's time, 0 to 1 (world/moving.h); null: 0 */
  /* vl_accel_occluded adds what unoccluded rays have crossed (crossed.h); null: chance decides
   * at surfaces with an alpha, as it does for closest hits */
  uint32_t *crossed;
} vlRays;

static inline vlVec3 vl_ray_origin(const vlRays *r, uint32_t i) {
  return vl_lane3(r->ox, r->oy, r->oz, i);
}
static inline vlVec3 vl_ray_direction(const vlRays *r, uint32_t i) {
  return vl_lane3(r->dx, r->dy, r->dz, i);
}
/* One ray from o along d. t_min, t_max, time: of vlRays. */
static inline vlRays vl_one_ray(const vlVec3 *o, const vlVec3 *d, const float *t_min,
                                const float *t_max, const float *time) {
  return (vlRays){&o->x, &o->y, &o->z, &d->x, &d->y, &d->z, t_min, t_max, time, NULL};
}

/* Copies rays first to first + n - 1 into rows: ox, oy, oz, dx, dy, dz, t_min, t_max. Copies of
 * the last ray fill the rows up to `padded`. */
static inline void vl_load_rays(const vlRays *r, uint32_t first, uint32_t n, uint32_t padded,
                                float *const rows[8]) {
  const float *const from[6] = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz};
  for (uint32_t i = 0; i < padded; i++) {
    uint32_t at = first + (i < n ? i : n - 1);
    for (int k = 0; k < 6; k++)
      rows[k][i] = from[k][at];
    rows[6][i] = r->t_min ? r->t_min[at] : 0.0f;
    rows[7][i] = r->t_max ? r->t_max[at] : __builtin_inff();
  }
}

/* For benchmarks: receives every batch of rays before it is traced. kind: 0 for
 * vl_accel_closest with coherent rays, 1 with other rays, 2 for vl_accel_occluded. */
typedef void vlRayLogFn(void *user, int kind, uint32_t n, const vlRays *rays);

/* The quadrics of a group, combined into one geometry: primitive k is shape members[k]. members
 * is null if the group has no bundle. */
typedef struct vlAccelBundle {
  uint32_t geometry, count;
  const uint32_t *members;
} vlAccelBundle;

typedef struct vlAccel {
  vlAccelerator kind; /* never AUTO */
  void *device;       /* RTCDevice; null for BVH */
  void *scene; /* RTCScene of the whole world; or vlBvh of the instances, null if there are none
                */
  void **groups; /* RTCScene of each group; of group 0 if split or if there are no instances,
                    else null. Or vlBvh */
  uint32_t group_count;
  /* For Embree: the shapes of group 0 are in a scene of their own, which `scene` contains as
   * instance 0. It can then be shared with the previous world, although instances have moved.
   * The numbers of the other instances are the same. */
  bool split;
  /* For Embree: packets of 8 are traced as they are, and filters see Embree's memory of each
   * ray's hit. Its oldest instruction set splits them. */
  bool packets;
  vlAccelBundle *bundles; /* one per group */
  uint32_t *members;      /* memory of the members of all bundles */
  /* of a world of few primitives, where it answers all queries; else null */
  struct vlBruteForce *brute_force;
  const struct vlBruteForceKernels *brute_force_kernels;
  const struct vlOccluderKernels *occluder_kernels;
  const struct vlBvhKernels *bvh_kernels;
  vlRayLogFn *log; /* null except in benchmarks */
  void *log_user;
} vlAccel;

vlResult vl_accel_build(struct vlWorld *world, vlError *error);
/* The accelerator of a build with this def; never AUTO. Error: UNSUPPORTED. */
vlResult vl_accel_choose(const vlBuildDef *def, vlAccelerator *kind, vlError *error);
/* The name of the instruction set that Embree uses for VL_BITS_FAST: the one that VELO_EMBREE
 * names, else the widest. Null: the build uses the BVH. */
const char *vl_accel_fast_set(const vlBuildDef *def);
void vl_accel_destroy(vlContext *context, vlAccel *accel);

/* Ids of the nearest hit of rays [0, n); shape is VL_NONE for a miss. t: distance along the ray
 * in units of its direction. For shapes other than triangles, t is computed by velo and tells
 * which intersection with the shape was hit, because the first one may be clipped or
 * transparent. For triangles, t is Embree's value, which differs between instruction sets;
 * callers must not use it. coherent: neighbouring rays have similar directions (camera rays)
 * and are traced in packets. */
void vl_accel_closest(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                      bool coherent, uint32_t *shape, uint32_t *prim, uint32_t *instance,
                      float *t);
/* occluded[i] = 1 if ray i is blocked within (t_min, t_max). occluders: what the calling thread
 * has learned from its earlier calls (occluders.h), which saves time and changes no result; may
 * be null. */
void vl_accel_occluded(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                       vlOccluders *occluders, uint8_t *occluded);
/* The same for rays whose neighbours have similar directions: they are traced in packets. */
void vl_accel_occluded_coherent(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                                uint8_t *occluded);
/* Each thread calls this before it traces. It sets the floating-point state
 * (vl_machine_set_floats) and returns the previous one. The caller restores that with
 * vl_accel_leave. */
unsigned vl_accel_enter(void);
void vl_accel_leave(unsigned state);

#endif
