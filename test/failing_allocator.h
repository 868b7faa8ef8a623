/* test/failing_allocator.h: an allocator that counts the blocks held and whose n-th call fails.
 *     failAllocator state = {.fail_at = n};             n counts from 1; 0: no call fails
 *     def.allocator = fail_allocator(&state);
 * Its memory is not empty: what must be zero or a number is not so by chance. Nor does it stay
 * as it was after its release: what is still used then shows.
 * fail_everywhere runs a test for n = 1, 2, ... until no call fails. Each run with a failure
 * must return VL_ERROR_MEMORY and leave state.blocks at 0. Only one call fails, so the code
 * after it runs with partly built data. */
#ifndef TEST_FAILING_ALLOCATOR_H
#define TEST_FAILING_ALLOCATOR_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/base.h"

typedef struct failAllocator {
  long fail_at;
  atomic_long calls;
  atomic_long blocks;  /* blocks currently held */
  atomic_bool refused; /* whether a call was refused */
} failAllocator;

static inline bool fail_now(failAllocator *state) {
  if (atomic_fetch_add(&state->calls, 1) + 1 != state->fail_at)
    return false;
  atomic_store(&state->refused, true);
  return true;
}

/* Before each block lies its size. */
enum { FAIL_HEADER = 2 * sizeof(max_align_t), FAIL_FILL = 0xff /* NaN, -1, no address */ };

static inline void *fail_allocate(void *user, size_t size) {
  failAllocator *state = user;
  if (fail_now(state))
    return NULL;
  char *start = size < SIZE_MAX - FAIL_HEADER ? malloc(FAIL_HEADER + size) : NULL;
  if (!start)
    return NULL;
  memcpy(start, &size, sizeof size);
  memset(start + FAIL_HEADER, FAIL_FILL, size);
  atomic_fetch_add(&state->blocks, 1);
  return start + FAIL_HEADER;
}

static inline void fail_release(void *user, void *block) {
  failAllocator *state = user;
  size_t size;
  if (!block)
    return;
  char *start = (char *)block - FAIL_HEADER;
  memcpy(&size, start, sizeof size);
  memset(block, FAIL_FILL, size);
  atomic_fetch_sub(&state->blocks, 1);
  free(start);
}

/* Fails one call: the one after the next n; n < 0: none. */
static inline void fail_after(failAllocator *state, long n) {
  state->fail_at = n < 0 ? 0 : atomic_load(&state->calls) + n + 1;
}

static inline vlAllocator fail_allocator(failAllocator *state) {
  return (vlAllocator){state, fail_allocate, fail_release};
}

/* Runs the body once per allocation, with a context of one thread, and makes that allocation
 * fail. At least `min` runs are needed until one without a failure. */
static inline void fail_everywhere(vlResult (*body)(vlContext *context, void *user), void *user,
                                   long min) {
  for (long n = 1;; n++) {
    failAllocator state = {.fail_at = n};
    vlContextDef def = vl_default_context_def();
    vlContext *context = NULL;
    def.threads = 1;
    def.allocator = fail_allocator(&state);
    vlResult result = vl_context_create(&def, &context);
    if (result == VL_OK) {
      result = body(context, user);
      vl_context_destroy(context);
    }
    vlResult wanted = state.refused ? VL_ERROR_MEMORY : VL_OK;
    if (state.blocks != 0)
      print_message("failing at call %ld leaks\n", n);
    if (result != wanted)
      print_message("failing at call %ld gives %s\n", n, vl_result_name(result));
    assert_int_equal(state.blocks, 0);
    assert_int_equal(result, wanted);
    if (state.refused)
      continue;
    assert_true(n > min);
    return;
  }
}

#endif
