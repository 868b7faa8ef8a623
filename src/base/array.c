/* base/array.c: see array.h. */
#include "base/array.h"

#include <string.h>

bool vl_array_reserve(vlContext *context, void **items, size_t *capacity, size_t count,
                      size_t size, size_t more) {
  if (more <= *capacity - count)
    return true;
  if (more > SIZE_MAX / 4 / size - count)
    return false;
  size_t wanted = count + more;
  size_t grown = *capacity + *capacity / 2 + 8;
  if (grown < wanted)
    grown = wanted;
  void *fresh = vl_realloc_array(context, *items, grown, size);
  if (!fresh)
    return false;
  *items = fresh;
  *capacity = grown;
  return true;
}

bool vl_array_grow(vlContext *context, void **items, size_t *capacity, size_t count,
                   size_t size, size_t more) {
  if (!vl_array_reserve(context, items, capacity, count, size, more))
    return false;
  if (more)
    memset((char *)*items + count * size, 0, more * size);
  return true;
}

void *vl_array_open(void *items, size_t count, size_t size, size_t at) {
  char *slot = (char *)items + at * size;
  memmove(slot + size, slot, (count - 1 - at) * size);
  return slot;
}
