/* test/failing_allocator.h: an allocator that says no at its n-th call, and counts what is still held.
 *   failAllocator state = {.fail_at = n};             n counts from 1; 0: never
 *   def.allocator = fail_allocator(&state);
 * The out-of-memory loop: for n = 1, 2, ... until a run in which nothing was refused; each must return
 * VL_ERROR_MEMORY and leave state.blocks at 0. */
#ifndef TEST_FAILING_ALLOCATOR_H
#define TEST_FAILING_ALLOCATOR_H

#include <stdatomic.h>
#include <stdlib.h>

#include "velo/base.h"

typedef struct failAllocator {
  long fail_at;
  atomic_long calls;
  atomic_long blocks;  /* held now */
  atomic_bool refused; /* whether a call was refused */
} failAllocator;

static inline bool fail_now(failAllocator *state) {
  if (atomic_fetch_add(&state->calls, 1) + 1 != state->fail_at) return false;
  atomic_store(&state->refused, true);
  return true;
}

static inline void *fail_allocate(void *user, size_t size) {
  failAllocator *state = user;
  if (fail_now(state)) return NULL;
  void *block = malloc(size);
  if (block) atomic_fetch_add(&state->blocks, 1);
  return block;
}

static inline void *fail_reallocate(void *user, void *block, size_t size) {
  failAllocator *state = user;
  if (fail_now(state)) return NULL;
  void *fresh = realloc(block, size);
  if (fresh && !block) atomic_fetch_add(&state->blocks, 1);
  return fresh;
}

static inline void fail_release(void *user, void *block) {
  failAllocator *state = user;
  if (block) atomic_fetch_sub(&state->blocks, 1);
  free(block);
}

static inline vlAllocator fail_allocator(failAllocator *state) {
  return (vlAllocator){state, fail_allocate, fail_reallocate, fail_release};
}

#endif
