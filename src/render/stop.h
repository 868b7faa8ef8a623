/* render/stop.h: how a ignore many tasks is given up: the caller's callback is asked about ten times a second, on
 * the thread that called; a deadline is seen by every worker. */
#ifndef RENDER_STOP_H
#define RENDER_STOP_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/file.h"

typedef struct vlStop {
  vlStopFn *ask; /* true: stop; null: never */
  void *user;
  pthread_t caller;
  double last;         /* when it was asked; the caller's thread alone reads and writes it */
  double deadline;     /* by vl_seconds(); 0: none. Constant while tasks run */
  atomic_bool stopped; /* the tasks that are left do nothing */
  atomic_bool late;    /* by the deadline */
} vlStop;

static inline void vl_stop_init(vlStop *stop, vlStopFn *ask, void *user) {
  stop->ask = ask;
  stop->user = user;
  stop->caller = pthread_self();
  stop->last = vl_seconds();
  stop->deadline = 0;
  atomic_store(&stop->stopped, false);
  atomic_store(&stop->late, false);
}

/* Called by tasks, between pieces of work of some milliseconds. */
static inline bool vl_stop_check(vlStop *stop) {
  if (atomic_load_explicit(&stop->stopped, memory_order_relaxed)) return true;
  double now = vl_seconds();
  if (stop->deadline > 0 && now >= stop->deadline) {
    atomic_store(&stop->late, true);
    atomic_store(&stop->stopped, true);
  } else if (stop->ask && pthread_equal(pthread_self(), stop->caller) && now - stop->last > 0.1) {
    stop->last = now;
    if (stop->ask(stop->user)) atomic_store(&stop->stopped, true);
  }
  return atomic_load_explicit(&stop->stopped, memory_order_relaxed);
}

#endif
