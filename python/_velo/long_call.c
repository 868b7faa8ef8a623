/* _velo/long_call.c: calls of the library that take long. Such a call runs on a thread of its
 * own; the thread of Python waits for it, looks for signals and runs the callbacks. So Ctrl-C
 * stops a call at once (vlCancel), whatever it does. A thread serves one call after another:
 * Embree keeps some 300 bytes for each thread that has ever built a tree. */
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "module.h"

_Thread_local const Film *open_film;

enum { NOTHING, PROGRESS, STEP };

/* A thread that runs calls. It is never freed, so that it may still post when its call is
 * done. */
typedef struct Runner {
  sem_t begin;    /* there is a call */
  sem_t wake;     /* the call asks, or is done */
  sem_t answered; /* the callback has answered */
  Waiting *call;
  struct Runner *next; /* of those that have no call */
} Runner;

struct Waiting {
  LongCall *call;
  LongBody *body;
  void *user;
  vlResult result;
  Runner *runner;
  atomic_int question;
  const void *state; /* vlProgress or vlStep of the question */
  bool answer;
  atomic_bool done;
  struct Waiting *next; /* of those that run */
};

/* The calls of this process, guarded by the GIL. */
static Waiting *running;
static Runner *idle;
static long running_pid;
static locale_t plain; /* of the threads of calls */
static bool shutting_down;
static pthread_t shutter; /* the thread that ends the interpreter; only if shutting_down */

/* ---- the thread of the call -------------------------------------------------------------- */

static void *run_calls(void *argument) {
  Runner *runner = argument;
  uselocale(plain);
  for (;;) {
    while (sem_wait(&runner->begin) != 0) {
    }
    Waiting *w = runner->call;
    w->result = w->body(w->user);
    atomic_store(&w->done, true); /* from now on the call may be gone */
    sem_post(&runner->wake);
  }
  return NULL;
}

static bool ask(LongCall *call, int question, const void *state) {
  Waiting *w = call->waiting;
  w->state = state;
  atomic_store(&w->question, question);
  sem_post(&w->runner->wake);
  while (sem_wait(&w->runner->answered) != 0) {
  }
  return w->answer;
}

bool long_call_progress(void *user, const vlProgress *progress) {
  return ask(user, PROGRESS, progress);
}

bool long_call_step(void *user, const vlStep *step) {
  return ask(user, STEP, step);
}

/* A thread that gets no signals: they wake the one that waits. */
static bool start(Runner *runner) {
  enum { STACK = 8 << 20 };
  sigset_t all, old;
  pthread_t thread;
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0)
    return false;
  pthread_attr_setstacksize(&attributes, STACK);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  plain = plain_locale();
  bool started = pthread_create(&thread, &attributes, run_calls, runner) == 0;
  pthread_sigmask(SIG_SETMASK, &old, NULL);
  pthread_attr_destroy(&attributes);
  return started;
}

/* A thread without a call, taken from the list or new; null: there is no memory for one. Needs
 * the GIL. */
static Runner *take_runner(void) {
  Runner *runner = idle;
  if (runner) {
    idle = runner->next;
    while (sem_trywait(&runner->wake) == 0) {
    }
    return runner;
  }
  runner = PyMem_Calloc(1, sizeof *runner);
  if (!runner)
    return NULL;
  sem_init(&runner->begin, 0, 0);
  sem_init(&runner->wake, 0, 0);
  sem_init(&runner->answered, 0, 0);
  if (start(runner))
    return runner;
  PyMem_Free(runner);
  return NULL;
}

static void put_runner(Runner *runner) {
  runner->call = NULL;
  runner->next = idle;
  idle = runner;
}

/* ---- the thread of Python ---------------------------------------------------------------- */

static PyObject *state_object(const Waiting *w, int question) {
  if (question == STEP) {
    const vlStep *s = w->state;
    return call_package("Step", "(sdd)", s->name, s->fraction, s->elapsed);
  }
  const vlProgress *p = w->state;
  return call_package("Progress", "(IIdddKKO)", p->spp_done, p->spp_total, p->elapsed,
                      p->remaining, p->fraction, (unsigned long long)p->paths,
                      (unsigned long long)p->rays, p->pass_done ? Py_True : Py_False);
}

static bool call_back(const Waiting *w, int question) {
  const Film *film = open_film;
  if (question == PROGRESS && ((const vlProgress *)w->state)->pass_done)
    open_film = w->call->film;
  PyObject *state = state_object(w, question);
  PyObject *answer =
      state ? PyObject_CallFunctionObjArgs(w->call->callback, state, NULL) : NULL;
  bool go_on = answer && answer != Py_False;
  open_film = film;
  Py_XDECREF(answer);
  Py_XDECREF(state);
  return go_on;
}

/* Waits for the next event, at most 20 ms: the system may give a signal to another thread. */
static void wait(Waiting *w) {
  const long POLL = 20 * 1000000L; /* ns */
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_nsec += POLL;
  if (until.tv_nsec >= 1000000000L) {
    until.tv_nsec -= 1000000000L;
    until.tv_sec++;
  }
  sem_clockwait(&w->runner->wake, CLOCK_MONOTONIC, &until);
}

/* Looks for signals and calls the call's poll. False: an exception is set. */
static bool look_around(const Waiting *w) {
  if (PyErr_CheckSignals() != 0)
    return false;
  if (!w->call->poll)
    return true;
  PyObject *answer = PyObject_CallFunctionObjArgs(w->call->poll, NULL);
  Py_XDECREF(answer);
  return answer != NULL;
}

/* Until the call is done. False: this is now another process, a child of a callback, where the
 * call does not run. */
static bool attend(Waiting *w, Call *call) {
  bool stopped = false;
  while (!atomic_load(&w->done)) {
    wait(w);
    int question = atomic_exchange(&w->question, NOTHING);
    if (atomic_load(&w->done))
      break;
    PyEval_RestoreThread(call->thread);
    if (!stopped && !question && !look_around(w)) {
      vl_cancel_request(w->call->cancel);
      stopped = true;
    }
    if (question) {
      w->answer = !stopped && call_back(w, question);
      if (!w->answer)
        stopped = true;
    }
    call->thread = PyEval_SaveThread();
    if (running_pid != (long)getpid())
      return false;
    if (question)
      sem_post(&w->runner->answered);
  }
  return true;
}

static void forget(Waiting *w) {
  Waiting **place = &running;
  while (*place && *place != w)
    place = &(*place)->next;
  if (*place)
    *place = w->next;
}

bool long_call_fail(const Own *own, PyObject *error) {
  bool any = false;
  for (Waiting *w = running; w; w = w->next)
    for (size_t i = 0; i < sizeof w->call->own / sizeof *w->call->own; i++) {
      if (w->call->own[i] != own)
        continue;
      if (!w->call->error) {
        Py_INCREF(error);
        w->call->error = error;
      }
      vl_cancel_request(w->call->cancel);
      any = true;
      break;
    }
  if (any)
    Py_DECREF(error);
  return any;
}

bool long_call_begin(LongCall *call, const Context *context, PyObject *callback) {
  *call = (LongCall){.callback = callback == Py_None ? NULL : callback};
  if (!context_check(context))
    return false;
  if (call->callback && !PyCallable_Check(call->callback)) {
    raise_value("progress", callback, "callable, or None");
    return false;
  }
  call->context = context;
  vlResult result = vl_cancel_create(context->context, &call->cancel);
  if (result != VL_OK)
    raise_result(result, NULL);
  return result == VL_OK;
}

bool long_call_poll(LongCall *call, PyObject *poll) {
  if (poll != Py_None && !PyCallable_Check(poll)) {
    raise_value("poll", poll, "callable, or None");
    return false;
  }
  call->poll = poll == Py_None ? NULL : poll;
  return true;
}

/* The interpreter ends, and this is not the thread that ends it, so it never runs Python again:
 * it waits for the end of the process, as Python's own threads do. An exception would be
 * printed, and Python aborts when a thread prints then. */
static void wait_for_the_end(void) {
  if (pthread_equal(pthread_self(), shutter))
    return;
  Py_BEGIN_ALLOW_THREADS;
  for (;;)
    pause();
  Py_END_ALLOW_THREADS;
}

bool long_call_run(LongCall *c, bool *busy, LongBody *body, void *user, vlResult *result) {
  Waiting w = {.call = c, .body = body, .user = user};
  Call call;
  *result = VL_ERROR_MEMORY;
  c->waiting = &w;
  if (running_pid != (long)getpid()) {
    running = NULL;
    idle = NULL; /* threads of the parent */
    running_pid = (long)getpid();
  }
  if (shutting_down)
    wait_for_the_end();
  if (shutting_down) {
    raise_usage("the interpreter is shutting down");
    return false;
  }
  w.next = running;
  running = &w;
  w.runner = take_runner();
  if (!w.runner || !call_begin(&call, c->context, busy)) {
    forget(&w);
    if (!w.runner)
      raise_result(VL_ERROR_MEMORY, NULL);
    else
      put_runner(w.runner);
    return false;
  }
  w.runner->call = &w;
  sem_post(&w.runner->begin);
  bool here = attend(&w, &call);
  call_end(&call);
  forget(&w);
  if (!here) {
    context_check(c->context); /* raises ForkError */
    return false;
  }
  put_runner(w.runner);
  if (shutting_down)
    wait_for_the_end();
  *result = w.result;
  if (c->error) {
    if (!PyErr_Occurred())
      PyErr_SetObject((PyObject *)Py_TYPE(c->error), c->error);
    Py_CLEAR(c->error);
  }
  return !PyErr_Occurred();
}

void long_call_end(LongCall *call) {
  if (context_is_ours(call->context))
    vl_cancel_destroy(call->cancel);
}

/* A callback that does not return is not waited for longer than this. */
PyObject *shut_down(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  const int MAX_WAIT = 5000; /* ms */
  shutter = pthread_self();
  shutting_down = true;
  if (running_pid != (long)getpid())
    running = NULL;
  for (int i = 0; running && i < MAX_WAIT; i++) {
    const struct timespec pause = {0, 1000000};
    for (Waiting *w = running; w; w = w->next)
      vl_cancel_request(w->call->cancel);
    PyThreadState *thread = PyEval_SaveThread();
    nanosleep(&pause, NULL);
    PyEval_RestoreThread(thread);
  }
  Py_RETURN_NONE;
}
