/* base/free.h: frees several blocks of a context at once. */
#ifndef BASE_FREE_H
#define BASE_FREE_H

#include "base/context.h"

/* A block that is const for its readers, for its owner, who frees it. */
static inline void *vl_owned(const void *block) {
  return (void *)(uintptr_t)block;
}
/* Frees the blocks, of which any may be null. */
static inline void vl_free_all(vlContext *context, void *const *blocks, size_t count) {
  for (size_t i = 0; i < count; i++)
    vl_free(context, blocks[i]);
}
#define VL_FREE(context, ...)                        \
  vl_free_all(context, (void *const[]){__VA_ARGS__}, \
              sizeof((void *const[]){__VA_ARGS__}) / sizeof(void *))

#endif
