/* world/accel/accel.h: who is hit first, who is hit at all. Only accel.c knows Embree. Out come ids alone: t, u, v are
 * computed again in our own arithmetic, since Embree's differ between its instruction sets. */
#ifndef WORLD_ACCEL_ACCEL_H
#define WORLD_ACCEL_ACCEL_H

#include "base/context.h"

#define VL_NONE 0xffffffffu

struct vlWorld;

/* World-space rays, structure of arrays. */
typedef struct vlRays {
  const float *ox, *oy, *oz, *dx, *dy, *dz;
  const float *t_min, *t_max; /* null: 0, infinity */
  const float *time;          /* the world's, 0 to 1 (world/shape/moving.h); null: 0 */
} vlRays;

/* For benchmarks: told of every batch of rays before it is traced. kind: 0 coherent closest, 1 closest, 2 occluded. */
typedef void vlRayLogFn(void *user, int kind, uint32_t n, const vlRays *rays);

/* The quadrics of a group, one geometry together: primitive k is shape members[k]. members null: none. */
typedef struct vlAccelBundle {
  uint32_t geometry, count;
  const uint32_t *members;
} vlAccelBundle;

typedef struct vlAccel {
  void *device;  /* RTCDevice */
  void *scene;   /* RTCScene: the world */
  void **groups; /* RTCScene of each group with index >= 1 */
  uint32_t group_count;
  void *user_data;        /* blocks of AccelGeometry */
  vlAccelBundle *bundles; /* of each group */
  uint32_t *members;      /* of all */
  vlRayLogFn *log;        /* null but in benchmarks */
  void *log_user;
} vlAccel;

vlResult vl_accel_build(struct vlWorld *world, vlError *error);
void vl_accel_destroy(vlContext *context, vlAccel *accel);

/* Ids of the nearest hit of rays [0, n); shape VL_NONE where nothing is hit. t: where on the ray; of shapes that are
 * not of triangles it is our own number, and tells which of their crossings was meant (the nearest may be cut by a
 * plane or not covered); of triangles it is Embree's, differs between instruction sets and is not to be used. coherent:
 * neighbours go the same way (camera rays), traced in packets. */
void vl_accel_closest(const struct vlWorld *world, uint32_t n, const vlRays *rays, bool coherent, uint32_t *shape,
                      uint32_t *prim, uint32_t *instance, float *t);
/* occluded[i] = 1 where something lies in (t_min, t_max). */
void vl_accel_occluded(const struct vlWorld *world, uint32_t n, const vlRays *rays, uint8_t *occluded);
/* Called by each thread before it traces: flush-to-zero, as Embree wants; returns the old state to give back. */
unsigned vl_accel_enter(void);
void vl_accel_leave(unsigned state);

#endif
