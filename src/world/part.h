/* world/part.h: parts that worlds share: the arrays of a shape, an image, a table. Each world
 * that has a part is one of its users; the last one frees it. Parts are not changed once they
 * are made. */
#ifndef WORLD_PART_H
#define WORLD_PART_H

#include <stdatomic.h>

#include "base/array.h"
#include "velo/world.h"

typedef struct vlPart {
  vlContext *context;
  atomic_uint users;
  VL_ARRAY(void *) blocks;                           /* its memory */
  void (*destroy)(vlContext *context, void *object); /* frees object; null: there is none */
  void *object;
  float low[3], high[3]; /* of a shape: its bounding box over all times, in group space */
} vlPart;

struct vlWorld;
/* A new part of a world under construction. While vlWorld.part is set to it, vl_world_block
 * allocates for it. Null: out of memory. */
vlPart *vl_part_add(struct vlWorld *world);
/* Shares a part of another world. False: out of memory. */
bool vl_part_share(struct vlWorld *world, vlPart *part);
/* Takes back a part that vl_part_add or vl_part_share gave the world. */
void vl_part_drop(struct vlWorld *world, vlPart *part);

#endif
