/* world/accel/occluders.h: the triangles that block most shadow rays. In a closed room few
 * walls block most of them. A worker learns which, and then tests its shadow rays against these
 * triangles, many rays at a time, before they go to Embree.
 *
 * The test is conservative: it finds a ray blocked only if Embree does, too, since the ray
 * meets the triangle away from its edges, not at a grazing angle, and away from its own ends.
 * All other rays go to Embree. So the triangles that a worker has learned change the time, but
 * no result. */
#ifndef WORLD_ACCEL_OCCLUDERS_H
#define WORLD_ACCEL_OCCLUDERS_H

#include "base/isa.h"
#include "world/accel/accel.h"

enum {
  VL_OCCLUDERS = 96,        /* at most as many triangles are tested */
  VL_OCCLUDER_TABLE = 1024, /* slots of the table of counts; a power of two */
};

/* A triangle in world space. inside: a ray must meet it so far from its edges, in barycentric
 * coordinates. */
typedef struct vlOccluder {
  /* edges divided by the length of their cross product; unit normal */
  float corner[3], edge[2][3], normal[3];
  float inside;
} vlOccluder;

/* How often a triangle has blocked a ray. geometry, prim: Embree's; count 0: the slot is free.
 */
typedef struct vlOccluderCount {
  uint32_t geometry, prim, count;
} vlOccluderCount;

/* A worker's triangles. They are forgotten when the worker turns to another world; set `world`
 * to null before a render, since another world may have the address of an old one. */
struct vlOccluders {
  const struct vlWorld *world;
  bool learns;
  uint32_t rays; /* since learning began, or since it ended */
  uint32_t count;
  float center[3], reach; /* rays that begin within this distance of the centre can be tested */
  vlOccluder faces[VL_OCCLUDERS];
  vlOccluderCount table[VL_OCCLUDER_TABLE];
};

/* Prepares for n shadow rays: begins or ends learning. After it, o->count triangles can be
 * tested. */
void vl_occluders_begin(vlOccluders *o, const struct vlWorld *world, uint32_t n);
/* While o->learns: counts a triangle that Embree found to block a ray. */
void vl_occluders_learn(vlOccluders *o, uint32_t geometry, uint32_t prim);

typedef struct vlOccluderKernels {
  /* blocked[i] = 1 if one of the triangles certainly blocks ray i, else 0. */
  void (*test)(const vlOccluders *o, uint32_t n, const vlRays *rays, uint8_t *blocked);
} vlOccluderKernels;
VL_KERNEL_TABLE(vlOccluderKernels, vl_occluder)

#endif
