/* base/pool.c: the worker pool. Several loops may run at once. Worker 0 of a loop is the thread
 * that called; the pool's threads are workers 1, 2, ... of any loop. After each task a pool
 * thread goes to the loop that needs it most: that of the highest priority, among equals the
 * one with the fewest workers. The caller of a loop pauses while a loop of a higher priority
 * has tasks. */
#include "base/pool.h"

#include <stdlib.h>
#include <time.h>

#include "base/machine.h"

typedef struct vlLoop {
  struct vlLoop *next;
  int priority;
  const atomic_bool *cancelled;
  vlParallelFn *body;
  void *user;
  uint32_t count, taken; /* taken: number of tasks that workers have begun */
  uint32_t workers;      /* pool threads that run a task */
} vlLoop;

typedef struct Slot {
  vlPool *pool;
  uint32_t worker;
} Slot;

/* All functions of this part are called with the mutex locked. */

static void leave_list(vlPool *pool, const vlLoop *loop) {
  for (vlLoop **at = &pool->loops; *at; at = &(*at)->next)
    if (*at == loop) {
      *at = loop->next;
      return;
    }
}

/* Takes a task. The last one takes the loop off the list. */
static uint32_t take(vlPool *pool, vlLoop *loop) {
  uint32_t index = loop->taken++;
  if (loop->taken == loop->count) {
    leave_list(pool, loop);
    pthread_cond_broadcast(&pool->done); /* for callers of lower priority */
  }
  return index;
}

static vlLoop *choose(const vlPool *pool) {
  vlLoop *best = NULL;
  for (vlLoop *l = pool->loops; l; l = l->next)
    if (!best || l->priority > best->priority ||
        (l->priority == best->priority && l->workers < best->workers))
      best = l;
  return best;
}

static bool is_outranked(const vlPool *pool, const vlLoop *loop) {
  if (loop->cancelled && atomic_load(loop->cancelled))
    return false;
  for (const vlLoop *l = pool->loops; l; l = l->next)
    if (l->priority > loop->priority)
      return true;
  return false;
}

/* Waits until no loop of a higher priority has tasks, at most PAUSE: so the callbacks of this
 * loop are still called. */
static void give_way(vlPool *pool, const vlLoop *loop) {
  const long PAUSE = 50 * 1000000L, POLL = 5 * 1000000L; /* ns */
  for (long waited = 0; waited < PAUSE && is_outranked(pool, loop); waited += POLL) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += POLL;
    if (until.tv_nsec >= 1000000000L) {
      until.tv_nsec -= 1000000000L;
      until.tv_sec++;
    }
    pthread_cond_timedwait(&pool->done, &pool->mutex, &until);
  }
}

/* ---- threads ----------------------------------------------------------------------------- */

static void *pool_thread(void *argument) {
  Slot slot = *(Slot *)argument;
  free(argument);
  vlPool *pool = slot.pool;
  vl_machine_set_floats();
  pthread_mutex_lock(&pool->mutex);
  while (!pool->stop) {
    vlLoop *loop = choose(pool);
    if (!loop) {
      pthread_cond_wait(&pool->wake, &pool->mutex);
      continue;
    }
    uint32_t index = take(pool, loop);
    loop->workers++;
    pthread_mutex_unlock(&pool->mutex);
    loop->body(loop->user, index, slot.worker);
    pthread_mutex_lock(&pool->mutex);
    if (--loop->workers == 0 && loop->taken == loop->count)
      pthread_cond_broadcast(&pool->done);
  }
  pthread_mutex_unlock(&pool->mutex);
  return NULL;
}

void vl_pool_run(vlPool *pool, const vlLoopDef *def, uint32_t count, vlParallelFn *body,
                 void *user) {
  vlLoop loop = {.priority = def->priority,
                 .cancelled = def->cancelled,
                 .body = body,
                 .user = user,
                 .count = count};
  unsigned floats = vl_machine_set_floats();
  pthread_mutex_lock(&pool->mutex);
  loop.next = pool->loops;
  pool->loops = &loop;
  if (count > 1)
    pthread_cond_broadcast(&pool->wake);
  while (loop.taken < count) {
    give_way(pool, &loop);
    if (loop.taken == count)
      break;
    uint32_t index = take(pool, &loop);
    pthread_mutex_unlock(&pool->mutex);
    body(user, index, 0);
    pthread_mutex_lock(&pool->mutex);
  }
  while (loop.workers > 0)
    pthread_cond_wait(&pool->done, &pool->mutex);
  pthread_mutex_unlock(&pool->mutex);
  vl_machine_restore_floats(floats);
}

void vl_pool_stop(vlPool *pool) {
  pthread_mutex_lock(&pool->mutex);
  pool->stop = true;
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
  for (uint32_t i = 0; i < pool->thread_count; i++)
    pthread_join(pool->threads[i], NULL);
  free(pool->threads);
  pthread_mutex_destroy(&pool->mutex);
  pthread_cond_destroy(&pool->wake);
  pthread_cond_destroy(&pool->done);
}

vlResult vl_pool_start(vlPool *pool, uint32_t threads) {
  pthread_mutex_init(&pool->mutex, NULL);
  pthread_cond_init(&pool->wake, NULL);
  pthread_cond_init(&pool->done, NULL);
  pool->threads = threads > 1 ? calloc(threads - 1, sizeof *pool->threads) : NULL;
  if (threads > 1 && !pool->threads)
    return VL_ERROR_MEMORY;
  for (uint32_t i = 1; i < threads; i++) {
    Slot *slot = malloc(sizeof *slot);
    if (slot) {
      *slot = (Slot){pool, i};
      if (pthread_create(&pool->threads[pool->thread_count], NULL, pool_thread, slot) == 0) {
        pool->thread_count++;
        continue;
      }
      free(slot);
    }
    vl_pool_stop(pool);
    return VL_ERROR_MEMORY;
  }
  return VL_OK;
}
