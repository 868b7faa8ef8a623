/* base/context.c: counted allocation, log, parallel loops (pool.c), the sandbox. See
 * context.h. */
#include "base/context.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/isa.h"
#include "base/machine.h"
#include "base/pool.h"
#include "base/sandbox.h"
#include "base/text.h"
#include "base/unfinished.h"
#include "velo/film.h"

struct vlContext {
  vlContextDef def;
  vlIsa isa;
  atomic_size_t held, peak;
  pthread_mutex_t log_mutex;
  atomic_uint_fast64_t last_number;
  vlFileRecords files;
  vlFileInputs inputs;
  vlUnfinishedList unfinished;
  vlSandbox sandbox;
  vlPool pool;
};

/* Memory: a header of 64 bytes before each block holds its size, so that the count is
 * exact. */

enum { HEADER = 64 };
typedef struct BlockHeader {
  size_t size; /* bytes of the user part */
  void *raw;   /* what the allocator returned */
} BlockHeader;

static void *default_allocate(VL_UNUSED void *user, size_t size) {
  enum { LARGE = 4 << 20 };
  void *block = malloc(size);
  if (block && size >= LARGE)
    vl_machine_large_pages(block, size);
  return block;
}
static void default_release(VL_UNUSED void *user, void *block) {
  free(block);
}

static BlockHeader *header_of(void *block) {
  return (BlockHeader *)(void *)((char *)block - sizeof(BlockHeader));
}

/* Adds to and subtracts from the count. False: beyond the limit, nothing is counted. */
static bool count_memory(vlContext *context, size_t add, size_t sub) {
  size_t now = atomic_fetch_add(&context->held, add - sub) + (add - sub),
         max = context->def.max_memory;
  if (max && add && now > max) {
    atomic_fetch_sub(&context->held, add);
    return false;
  }
  size_t peak = atomic_load(&context->peak);
  while (now > peak && !atomic_compare_exchange_weak(&context->peak, &peak, now)) {
  }
  return true;
}

bool vl_count_foreign(vlContext *context, int64_t bytes, bool taken) {
  if (bytes < 0)
    return count_memory(context, 0, (size_t)-bytes);
  if (count_memory(context, (size_t)bytes, 0))
    return true;
  if (taken)
    atomic_fetch_add(&context->held, (size_t)bytes);
  return taken;
}

/* Every block is 64-byte aligned, for vector loads. */
void *vl_alloc(vlContext *context, size_t size) {
  if (size > SIZE_MAX / 2)
    return NULL;
  if (!count_memory(context, size, 0))
    return NULL;
  char *raw = context->def.allocator.allocate(context->def.allocator.user, size + 2 * HEADER);
  if (!raw) {
    count_memory(context, 0, size);
    return NULL;
  }
  char *block =
      (char *)(((uintptr_t)raw + sizeof(BlockHeader) + HEADER - 1) & ~(uintptr_t)(HEADER - 1));
  *header_of(block) = (BlockHeader){size, raw};
  return block;
}

void *vl_alloc_array(vlContext *context, size_t count, size_t size) {
  if (size && count > SIZE_MAX / 2 / size)
    return NULL;
  return vl_alloc(context, count * size);
}

void *vl_alloc_zero(vlContext *context, size_t count, size_t size) {
  void *block = vl_alloc_array(context, count, size);
  if (block)
    memset(block, 0, count * size);
  return block;
}

void *vl_realloc_array(vlContext *context, void *block, size_t count, size_t size) {
  if (!block)
    return vl_alloc_array(context, count, size);
  void *fresh = vl_alloc_array(context, count, size);
  if (!fresh)
    return NULL;
  size_t old = header_of(block)->size;
  memcpy(fresh, block, old < count * size ? old : count * size);
  vl_free(context, block);
  return fresh;
}

void vl_free(vlContext *context, void *block) {
  if (!block)
    return;
  BlockHeader header = *header_of(block);
  count_memory(context, 0, header.size);
  context->def.allocator.release(context->def.allocator.user, header.raw);
}

void vl_release(vlContext *context, void *data) {
  vl_free(context, data);
}

char *vl_strdup(vlContext *context, const char *text) {
  if (!text)
    return NULL;
  size_t size = strlen(text) + 1;
  char *copy = vl_alloc(context, size);
  if (copy)
    memcpy(copy, text, size);
  return copy;
}

size_t vl_context_memory(const vlContext *context, size_t *peak) {
  if (peak)
    *peak = atomic_load(&context->peak);
  return atomic_load(&context->held);
}

/* ---- log --------------------------------------------------------------------------------- */

void vl_log(vlContext *context, vlLogLevel level, const vlError *where, const char *format,
            ...) {
  if (!context->def.log)
    return;
  char text[1024];
  VL_FORMAT(text, format);
  vl_make_printable(text);
  pthread_mutex_lock(&context->log_mutex);
  context->def.log(context->def.log_user, level, where, text);
  pthread_mutex_unlock(&context->log_mutex);
}

/* ---- workers ----------------------------------------------------------------------------- */

static void *wait_turn(void *mutex) {
  pthread_mutex_lock(mutex);
  pthread_mutex_unlock(mutex);
  return NULL;
}

vlResult vl_try_threads(vlContext *context, vlError *error) {
  uint32_t wanted = vl_context_threads(context) - 1, started = 0;
  pthread_t *threads = vl_alloc_array(context, wanted + 1, sizeof *threads);
  if (!threads)
    return vl_fail_memory(error);
  pthread_mutex_t all = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&all); /* held until the last thread has started: systems limit the number
                               of threads that exist at the same time */
  while (started < wanted && pthread_create(&threads[started], NULL, wait_turn, &all) == 0)
    started++;
  pthread_mutex_unlock(&all);
  for (uint32_t i = 0; i < started; i++)
    pthread_join(threads[i], NULL);
  pthread_mutex_destroy(&all);
  vl_free(context, threads);
  if (started == wanted)
    return VL_OK;
  return vl_fail(error, VL_ERROR_MEMORY, "the system refuses to start %u threads", wanted);
}

void vl_parallel_for_at(vlContext *context, const vlLoopDef *def, uint32_t count,
                        vlParallelFn *body, void *loop_user) {
  if (count == 0)
    return;
  if (context->def.parallel_for)
    context->def.parallel_for(context->def.parallel_for_user, count, body, loop_user);
  else
    vl_pool_run(&context->pool, def, count, body, loop_user);
}

void vl_parallel_for(vlContext *context, uint32_t count, vlParallelFn *body, void *loop_user) {
  vl_parallel_for_at(context, &(vlLoopDef){0}, count, body, loop_user);
}

/* ---- the sandbox ------------------------------------------------------------------------- */

bool vl_context_allows(const vlContext *context, const char *path) {
  /* takes its mutex */
  return vl_sandbox_allows((vlSandbox *)(uintptr_t)&context->sandbox, path);
}

vlSandbox *vl_context_sandbox(vlContext *context) {
  return &context->sandbox;
}

uint64_t vl_context_max_texture_pixels(const vlContext *context) {
  return context->def.max_texture_pixels;
}

/* ---- creation and destruction ------------------------------------------------------------ */

vlContextDef vl_default_context_def_abi(uint32_t abi) {
  long cores = sysconf(_SC_NPROCESSORS_ONLN);
  return (vlContextDef){
      .cookie = VL_COOKIE_OF(VL_COOKIE_CONTEXT & 0xff, abi),
      .allocator = {NULL, default_allocate, default_release},
      .threads = cores > 0 ? (uint32_t)cores : 1,
      .isa = VL_ISA_AUTO,
      .max_texture_pixels = UINT64_C(1) << 28,
  };
}

vlResult vl_context_create(const vlContextDef *def, vlContext **result) {
  if (!result)
    return VL_ERROR_ARGUMENT;
  *result = NULL;
  vlContextDef d = def ? *def : vl_default_context_def();
  if (d.cookie != VL_COOKIE_CONTEXT || !d.allocator.allocate || !d.allocator.release ||
      d.threads == 0 || d.threads > 4096)
    return VL_ERROR_ARGUMENT;
  vlIsa isa = VL_ISA_BASE;
  VL_TRY(vl_isa_choose(d.isa, &isa));
  vlContext *context = d.allocator.allocate(d.allocator.user, sizeof *context);
  if (!context)
    return VL_ERROR_MEMORY;
  memset(context, 0, sizeof *context);
  context->def = d;
  context->unfinished.allocator = d.allocator;
  context->isa = isa;
  pthread_mutex_init(&context->log_mutex, NULL);
  pthread_mutex_init(&context->files.mutex, NULL);
  pthread_mutex_init(&context->inputs.mutex, NULL);
  vlResult r = vl_sandbox_make(&context->sandbox, &d.allocator, d.sandbox, d.sandbox_count);
  if (r == VL_OK && !d.parallel_for)
    r = vl_pool_start(&context->pool, d.threads);
  if (r != VL_OK) {
    vl_sandbox_free(&context->sandbox);
    d.allocator.release(d.allocator.user, context);
    return r;
  }
  *result = context;
  return VL_OK;
}

vlResult vl_context_create_quiet(const vlContext *context, vlContext **result) {
  vlContextDef def = context->def;
  def.log = NULL;
  def.threads = 1;
  def.sandbox = (const char *const *)context->sandbox.folders;
  return vl_context_create(&def, result);
}

void vl_context_destroy(vlContext *context) {
  if (!context)
    return;
  if (!context->def.parallel_for)
    vl_pool_stop(&context->pool);
  pthread_mutex_destroy(&context->log_mutex);
  pthread_mutex_destroy(&context->files.mutex);
  pthread_mutex_destroy(&context->inputs.mutex);
  for (size_t i = 0; i < context->files.files.count; i++)
    vl_free(context, (void *)(uintptr_t)context->files.files.items[i].path);
  vl_free(context, context->files.files.items);
  for (size_t i = 0; i < context->inputs.list.count; i++)
    vl_free(context, context->inputs.list.items[i].path);
  vl_free(context, context->inputs.list.items);
  vl_unfinished_free(&context->unfinished);
  vl_sandbox_free(&context->sandbox);
  context->def.allocator.release(context->def.allocator.user, context);
}

vlIsa vl_context_isa(const vlContext *context) {
  return context->isa;
}

uint32_t vl_context_threads(const vlContext *context) {
  return context->def.threads;
}

uint64_t vl_context_number(vlContext *context) {
  return atomic_fetch_add(&context->last_number, 1) + 1;
}

vlFileRecords *vl_context_file_records(vlContext *context) {
  return &context->files;
}

vlFileInputs *vl_context_file_inputs(vlContext *context) {
  return context->def.keep_inputs ? &context->inputs : NULL;
}

vlUnfinishedList *vl_context_unfinished(vlContext *context) {
  return &context->unfinished;
}

void vl_remove_unfinished(vlContext *context) {
  if (context)
    vl_unfinished_remove(&context->unfinished);
}

bool vl_context_interrupted(const vlContext *context) {
  return context->def.interrupted && context->def.interrupted(context->def.interrupted_user);
}
