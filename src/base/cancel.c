/* base/cancel.c: requests to stop, and the progress of loads and builds. See cancel.h. */
#include "base/cancel.h"

#include "base/file.h"

vlResult vl_cancel_create(vlContext *context, vlCancel **result) {
  if (!context || !result)
    return VL_ERROR_ARGUMENT;
  vlCancel *cancel = *result = vl_alloc_zero(context, 1, sizeof *cancel);
  if (!cancel)
    return VL_ERROR_MEMORY;
  cancel->context = context;
  return VL_OK;
}

void vl_cancel_destroy(vlCancel *cancel) {
  if (cancel)
    vl_free(cancel->context, cancel);
}

void vl_cancel_request(vlCancel *cancel) {
  atomic_store(&cancel->requested, true);
}

void vl_cancel_clear(vlCancel *cancel) {
  atomic_store(&cancel->requested, false);
}

bool vl_cancel_requested(const vlCancel *cancel) {
  return vl_is_cancelled(cancel);
}

static const double step_interval = 0.05; /* seconds */

void vl_task_start(vlTask *task, const vlCancel *cancel, vlStepFn *progress, void *user) {
  *task = (vlTask){.cancel = cancel,
                   .progress = progress,
                   .user = user,
                   .caller = pthread_self(),
                   .name = "reading"};
  task->start = vl_seconds();
  task->last = task->start - step_interval; /* the first step is reported at once */
}

bool vl_task_stopped(vlTask *task, const char *name, double fraction) {
  if (!task)
    return false;
  if (atomic_load_explicit(&task->stopped, memory_order_relaxed))
    return true;
  if (vl_is_cancelled(task->cancel)) {
    atomic_store(&task->stopped, true);
    return true;
  }
  if (!task->progress || !pthread_equal(pthread_self(), task->caller))
    return false;
  if (name) {
    task->name = name;
    task->fraction = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
  }
  double now = vl_seconds();
  if (now - task->last < step_interval)
    return false;
  task->last = now;
  vlStep step = {task->name, task->fraction, now - task->start};
  if (task->progress(task->user, &step))
    return false;
  atomic_store(&task->stopped, true);
  return true;
}
