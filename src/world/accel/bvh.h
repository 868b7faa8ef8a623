/* world/accel/bvh.h: the functions of accel.h by velo's own bounding volume hierarchy (BVH), in
 * plain C. It runs wherever velo does and gives the hits that Embree gives with
 * VL_BITS_PORTABLE: triangles are intersected by the same operations in the same order
 * (bvh.hot.c), and the rule of nearest.h decides between hits
 * (docs/decisions/0022-a-portable-accelerator.md). */
#ifndef WORLD_ACCEL_BVH_H
#define WORLD_ACCEL_BVH_H

#include <stdatomic.h>

#include "base/isa.h"
#include "world/accel/accel.h"
#include "world/moving.h"

enum {
  VL_BVH_WIDTH = 8, /* children of a node */
  VL_BVH_FOUR = 4,  /* triangles that are tested at a time */
  /* Nodes are split at the median from this depth on, which bounds the depth by that plus
   * 32. */
  VL_BVH_DEPTH = 64,
  VL_BVH_STACK = (VL_BVH_DEPTH + 32) * (VL_BVH_WIDTH - 1) + 1,
  VL_BVH_ALIGN = 32
};

/* What a child is: its address, with the kind in the lowest bits. FOUR, MOVING: vlBvhFour.
 * OTHER: vlBvhItem, another primitive, or an instance. 0: an empty tree. */
typedef enum vlBvhKind {
  VL_BVH_NODE,
  VL_BVH_FOUR_STILL,
  VL_BVH_FOUR_MOVING,
  VL_BVH_OTHER
} vlBvhKind;
static inline vlBvhKind vl_bvh_kind(uintptr_t child) {
  return (vlBvhKind)(child & 3);
}
static inline const void *vl_bvh_at(uintptr_t child) {
  return (const void *)(child & ~(uintptr_t)3);
}

/* Boxes of the children: rows low x, high x, low y, high y, low z, high z. Slots without a
 * child have low > high. */
typedef float vlBvhBoxes[6][VL_BVH_WIDTH];
typedef struct vlBvhNode {
  vlBvhBoxes boxes; /* if the tree moves, at time 0 */
  uintptr_t child[VL_BVH_WIDTH];
  vlBvhBoxes later[]; /* if the tree moves: one, at time 1; between, boxes are interpolated */
} vlBvhNode;

/* Numbers of a primitive, as Embree has them (bundle.h): in a tree of instances `geometry` is
 * the instance. */
typedef struct vlBvhItem {
  uint32_t geometry, primitive;
} vlBvhItem;

/* Triangles, as a structure of arrays. Of moving ones, with their corners at time 0. The last
 * fills slots that are left over. */
typedef struct vlBvhFour {
  float corner[3][3][VL_BVH_FOUR]; /* [corner][axis] */
  uint32_t geometry[VL_BVH_FOUR], primitive[VL_BVH_FOUR];
} vlBvhFour;
/* Puts the corners of a triangle at `time` into slot k. */
static inline void vl_bvh_put_corners(const vlWorldShape *s, uint32_t prim, float time,
                                      vlBvhFour *four, uint32_t k) {
  for (size_t c = 0; c < 3; c++) {
    float room[3];
    const float *at = vl_vertex_at(s, s->indices[3 * (size_t)prim + c], time, room);
    for (size_t i = 0; i < 3; i++)
      four->corner[c][i][k] = at[i];
  }
}
/* Added to `geometry` of triangles that may let a ray pass: they have an alpha, one side, or an
 * interface. */
#define VL_BVH_ASKS 0x80000000u

/* A block of memory, which follows. */
typedef struct vlBvhBlock {
  struct vlBvhBlock *next;
} vlBvhBlock;

/* A tree over the shapes of a group, or over the world's instances. Worlds share trees
 * (decision 15): a tree reads nothing of a world, and queries give the world. */
typedef struct vlBvh {
  atomic_uint users;
  bool moves;
  uintptr_t root;
  float low[3], high[3];             /* box of all primitives over all times; empty: 0 */
  float reach;                       /* largest coordinate of the box, without sign */
  struct vlBvhBlock *_Atomic blocks; /* nodes and leaves */
  float (*maps)[12]; /* of a tree of instances: group from world, as Embree computes it; unused
                        for moving instances */
} vlBvh;

/* Builds the tree of a group or, for VL_NONE, that of all instances of a world whose groups are
 * built. *tree is null after an error: MEMORY, CANCELLED. */
vlResult vl_bvh_make(const struct vlWorld *world, uint32_t group, vlBvh **tree, vlError *error);
void vl_bvh_release(vlContext *context, vlBvh *tree); /* null is allowed */

/* Group from world for an instance, and for a moving one at `time`, by the operations of
 * Embree: a ray has the same bits in the group's space. */
void vl_bvh_map(const float from_group[12], float to_group[12]);

/* As those of embree.h. */
vlResult vl_bvh_build(struct vlWorld *world, vlError *error);
void vl_bvh_destroy(vlContext *context, vlAccel *accel);

typedef struct vlBvhKernels {
  void (*closest)(const struct vlWorld *world, uint32_t n, const vlRays *rays, uint32_t *shape,
                  uint32_t *prim, uint32_t *instance, float *t);
  void (*occluded)(const struct vlWorld *world, uint32_t n, const vlRays *rays,
                   vlOccluders *occluders, uint8_t *occluded);
} vlBvhKernels;
VL_KERNEL_TABLE(vlBvhKernels, vl_bvh)

#endif
