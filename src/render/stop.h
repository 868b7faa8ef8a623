/* render/stop.h: how a pass over many tasks is abandoned. The caller's callback is called about
 * forty times a second, on the thread that called vl_render; every worker checks the request
 * to cancel and the deadline. */
#ifndef RENDER_STOP_H
#define RENDER_STOP_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/cancel.h"
#include "base/file.h"

typedef struct vlStop {
  vlStopFn *ask; /* the callback; true: stop; null: none */
  void *user;
  const vlCancel *cancel; /* null: none */
  pthread_t caller;
  double last;         /* time of its last call; only the caller's thread reads and writes it */
  double deadline;     /* on the clock of vl_seconds(); 0: none. Constant while tasks run */
  atomic_bool stopped; /* the remaining tasks do nothing */
  atomic_bool late;    /* stopped by the deadline */
} vlStop;

static inline void vl_stop_init(vlStop *stop, const vlCancel *cancel, vlStopFn *ask,
                                void *user) {
  stop->cancel = cancel;
  stop->ask = ask;
  stop->user = user;
  stop->caller = pthread_self();
  stop->last = vl_seconds();
  stop->deadline = 0;
  atomic_store(&stop->stopped, false);
  atomic_store(&stop->late, false);
}

/* True: stop. Tasks call it every few milliseconds of work. */
static inline bool vl_stop_check(vlStop *stop) {
  if (atomic_load_explicit(&stop->stopped, memory_order_relaxed))
    return true;
  if (vl_is_cancelled(stop->cancel)) {
    atomic_store(&stop->stopped, true);
    return true;
  }
  double now = vl_seconds();
  if (stop->deadline > 0 && now >= stop->deadline) {
    atomic_store(&stop->late, true);
    atomic_store(&stop->stopped, true);
  } else if (stop->ask && pthread_equal(pthread_self(), stop->caller) &&
             now - stop->last > 0.025) {
    stop->last = now;
    if (stop->ask(stop->user))
      atomic_store(&stop->stopped, true);
  }
  return atomic_load_explicit(&stop->stopped, memory_order_relaxed);
}

#endif
