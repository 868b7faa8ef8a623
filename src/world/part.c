/* world/part.c: see part.h; the functions that change a world are in build.c. */
#include "world/part.h"

void vl_part_release(vlPart *part) {
  if (atomic_fetch_sub(&part->users, 1) > 1)
    return;
  vlContext *context = part->context;
  if (part->destroy)
    part->destroy(context, part->object);
  for (size_t i = 0; i < part->blocks.count; i++)
    vl_free(context, part->blocks.items[i]);
  VL_ARRAY_FREE(context, &part->blocks);
  vl_free(context, part);
}
