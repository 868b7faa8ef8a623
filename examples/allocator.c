/* allocator: velo inside a program that counts its memory: an allocator of its own, a limit, and a log. The program
 * prints the most bytes that velo held; at the end it holds none.
 *
 *   allocator SCENE IMAGE
 *   build/release/bin/example_allocator examples/corner.pbrt examples/allocator.jpg
 */
#include <stdatomic.h>

#include "example.h"

static atomic_long blocks; /* velo's threads allocate at the same time */

static void *allocate(void *user, size_t size) {
  (void)user;
  atomic_fetch_add(&blocks, 1);
  return malloc(size);
}

static void release(void *user, void *block) {
  (void)user;
  if (block) atomic_fetch_sub(&blocks, 1);
  free(block);
}

static void print(void *user, vlLogLevel level, const vlError *where, const char *message) {
  (void)user, (void)where;
  if (level <= VL_LOG_WARNING) fprintf(stderr, "%s\n", message);
}

int main(int count, char **arguments) {
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){NULL, allocate, release};
  def.max_memory = (size_t)1 << 30; /* a call that needs more returns VL_ERROR_MEMORY */
  def.log = print;
  size_t peak;
  Example e = example_open(count, arguments, &def);
  example_render(&e);
  example_write(&e, arguments[2]);
  vl_context_memory(e.context, &peak);
  example_close(&e);
  printf("%.1f MB at most; %ld blocks are left\n", 1e-6 * (double)peak, atomic_load(&blocks));
  return atomic_load(&blocks) != 0;
}
