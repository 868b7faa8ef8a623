/* base/pool.h: the threads of a context, which run the parallel loops of all its callers. */
#ifndef BASE_POOL_H
#define BASE_POOL_H

#include <pthread.h>
#include <stdatomic.h>

#include "velo/base.h"

/* How a loop shares the workers with other loops that run at the same time. */
typedef struct vlLoopDef {
  int priority; /* while a loop of a higher priority runs, this one does one task each 50 ms */
  /* once it is true, the loop no longer waits for others; may be null */
  const atomic_bool *cancelled;
} vlLoopDef;

typedef struct vlPool {
  pthread_mutex_t mutex;
  pthread_cond_t wake; /* a loop is new, or the pool stops */
  pthread_cond_t done; /* a loop is finished, or a worker has left one */
  pthread_t *threads;
  uint32_t thread_count; /* besides the callers */
  bool stop;
  struct vlLoop *loops; /* those with tasks that no worker has taken */
} vlPool;

vlResult vl_pool_start(vlPool *pool, uint32_t threads);
void vl_pool_stop(vlPool *pool);
void vl_pool_run(vlPool *pool, const vlLoopDef *def, uint32_t count, vlParallelFn *body,
                 void *user);

#endif
