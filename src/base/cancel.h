/* base/cancel.h: how a long call is stopped: by a request from another thread (vlCancel), or by
 * the caller's progress callback (vlTask). */
#ifndef BASE_CANCEL_H
#define BASE_CANCEL_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/context.h"

struct vlCancel {
  vlContext *context;
  atomic_bool requested;
};

static inline bool vl_is_cancelled(const vlCancel *cancel) {
  return cancel && atomic_load_explicit(&cancel->requested, memory_order_relaxed);
}

static inline vlLoopDef vl_loop_def(int priority, const vlCancel *cancel) {
  return (vlLoopDef){priority, cancel ? &cancel->requested : NULL};
}

/* A load or a build that is running. */
typedef struct vlTask {
  const vlCancel *cancel;
  vlStepFn *progress;
  void *user;
  pthread_t caller;
  double start, last; /* clock of vl_seconds(); last: time of the last call of progress, used by
                         the caller's thread */
  const char *name;   /* of the last step, and its fraction; used by the caller's thread */
  double fraction;
  atomic_bool stopped;
} vlTask;

void vl_task_start(vlTask *task, const vlCancel *cancel, vlStepFn *progress, void *user);
/* True: the call must end with VL_CANCELLED. Calls `progress` if that is due and this is the
 * caller's thread. name, fraction: as in vlStep; without a name those of the last step. A null
 * task never stops. */
bool vl_task_stopped(vlTask *task, const char *name, double fraction);

#endif
