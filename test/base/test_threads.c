/* test/base/test_threads.c: the worker pool: each index runs once, worker numbers are in range,
 * loops follow each other, several callers at once, priorities, the caller's own parallel_for,
 * a log callback that is never entered twice at a time. */
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/context.h"
#include "unit.h"

enum { COUNT = 1000 };

typedef struct Job {
  atomic_uint seen[COUNT];
  atomic_uint bad_worker;
  uint32_t threads;
} Job;

static void mark(void *user, uint32_t index, uint32_t worker) {
  Job *job = user;
  atomic_fetch_add(&job->seen[index], 1);
  if (worker >= job->threads)
    atomic_fetch_add(&job->bad_worker, 1);
}

static void run_job(vlContext *context, uint32_t threads, uint32_t count) {
  static Job job;
  memset(&job, 0, sizeof job);
  job.threads = threads;
  vl_parallel_for(context, count, mark, &job);
  for (uint32_t i = 0; i < COUNT; i++)
    assert_int_equal(job.seen[i], i < count ? 1 : 0);
  assert_int_equal(job.bad_worker, 0);
}

static void each_index_once(void **state) {
  (void)state;
  static const uint32_t threads[] = {1, 2, 3, 8};
  for (unsigned i = 0; i < 4; i++) {
    vlContextDef def = vl_default_context_def();
    def.threads = threads[i];
    vlContext *context = NULL;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    assert_int_equal(vl_context_threads(context), threads[i]);
    for (uint32_t round = 0; round < 50; round++)
      run_job(context, threads[i], round % 2 ? COUNT : round);
    vl_context_destroy(context);
  }
}

/* One sum in plain memory by each worker: a data race here would be seen by the thread
 * sanitizer. */
typedef struct Sums {
  uint64_t by_worker[8];
} Sums;
static void add(void *user, uint32_t index, uint32_t worker) {
  ((Sums *)user)->by_worker[worker] += index;
}

static void *call_loops(void *argument) {
  for (int round = 0; round < 50; round++) {
    Sums sums = {0};
    vl_parallel_for(argument, COUNT, add, &sums);
    uint64_t sum = 0;
    for (int i = 0; i < 8; i++)
      sum += sums.by_worker[i];
    if (sum != (uint64_t)COUNT * (COUNT - 1) / 2)
      return argument;
  }
  return NULL;
}

static void several_callers(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 4;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  pthread_t callers[3];
  for (int i = 0; i < 3; i++)
    assert_int_equal(pthread_create(&callers[i], NULL, call_loops, context), 0);
  for (int i = 0; i < 3; i++) {
    void *failed = NULL;
    pthread_join(callers[i], &failed);
    assert_null(failed);
  }
  vl_context_destroy(context);
}

static void backwards(void *user, uint32_t count, vlParallelFn *body, void *loop_user) {
  ++*(int *)user;
  for (uint32_t i = count; i > 0; i--)
    body(loop_user, i - 1, 0);
}

static void callers_own_loop(void **state) {
  (void)state;
  int calls = 0;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  def.parallel_for = backwards;
  def.parallel_for_user = &calls;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  run_job(context, 1, COUNT);
  assert_int_equal(calls, 1);
  vl_context_destroy(context);
}

typedef struct Log {
  /* plain: the library promises never to call from two threads at once */
  int inside, lines, twice;
} Log;
static void count_line(void *user, vlLogLevel level, const vlError *where,
                       const char *message) {
  Log *log = user;
  if (log->inside++)
    log->twice++;
  if (level == VL_LOG_WARNING && where && where->line == 7 && strcmp(message, "a warning") == 0)
    log->lines++;
  log->inside--;
}
static void warn(void *user, uint32_t index, uint32_t worker) {
  (void)index;
  (void)worker;
  vlError where = {.line = 7};
  vl_log(user, VL_LOG_WARNING, &where, "a %s", "warning");
}

static void log_is_entered_once(void **state) {
  (void)state;
  Log log = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = 4;
  def.log = count_line;
  def.log_user = &log;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vl_parallel_for(context, COUNT, warn, context);
  assert_int_equal(log.lines, COUNT);
  assert_int_equal(log.twice, 0);
  vl_context_destroy(context);
}

/* Two loops at once: each body waits until a body of the other loop runs, too. A pool that runs
 * one loop after the other would wait for ever; the alarm ends it. */
typedef struct Meeting {
  atomic_uint here[2];
  vlContext *context;
} Meeting;
typedef struct Side {
  Meeting *meeting;
  int index;
} Side;

static void meet(void *user, uint32_t index, uint32_t worker) {
  (void)index;
  (void)worker;
  Side *side = user;
  atomic_store(&side->meeting->here[side->index], 1);
  while (!atomic_load(&side->meeting->here[1 - side->index]))
    sched_yield();
}

static void *call_meet(void *user) {
  vl_parallel_for(((Side *)user)->meeting->context, 4, meet, user);
  return NULL;
}

static void loops_overlap(void **state) {
  (void)state;
  for (uint32_t threads = 1; threads <= 3; threads++) {
    vlContextDef def = vl_default_context_def();
    def.threads = threads;
    Meeting meeting = {{0, 0}, NULL};
    assert_int_equal(vl_context_create(&def, &meeting.context), VL_OK);
    Side sides[2] = {{&meeting, 0}, {&meeting, 1}};
    pthread_t other;
    alarm(120);
    assert_int_equal(pthread_create(&other, NULL, call_meet, &sides[1]), 0);
    call_meet(&sides[0]);
    pthread_join(other, NULL);
    alarm(0);
    vl_context_destroy(meeting.context);
  }
}

/* A loop of low priority gives way: while the other one runs, it starts at most a task each 50
 * ms. */
typedef struct Race {
  vlContext *context;
  atomic_uint low, low_before, low_after, high;
} Race;

static void low_task(void *user, uint32_t index, uint32_t worker) {
  (void)index;
  (void)worker;
  atomic_fetch_add(&((Race *)user)->low, 1);
  nanosleep(&(struct timespec){0, 1000000}, NULL);
}

static void high_task(void *user, uint32_t index, uint32_t worker) {
  (void)index;
  (void)worker;
  Race *race = user;
  if (atomic_fetch_add(&race->high, 1) == 0)
    race->low_before = atomic_load(&race->low);
  nanosleep(&(struct timespec){0, 1000000}, NULL);
  race->low_after = atomic_load(&race->low);
}

static void *call_low(void *user) {
  vl_parallel_for_at(((Race *)user)->context, &(vlLoopDef){0, NULL}, 400, low_task, user);
  return NULL;
}

static void priority_gives_way(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  Race race = {NULL, 0, 0, 0, 0};
  assert_int_equal(vl_context_create(&def, &race.context), VL_OK);
  pthread_t other;
  assert_int_equal(pthread_create(&other, NULL, call_low, &race), 0);
  while (atomic_load(&race.low) < 4)
    sched_yield();
  vl_parallel_for_at(race.context, &(vlLoopDef){1, NULL}, 200, high_task, &race);
  pthread_join(other, NULL);
  assert_int_equal(race.high, 200);
  assert_int_equal(race.low, 400);
  /* Without priorities as many low tasks as high ones would run: 100 to 200. */
  assert_true(race.low_after - race.low_before < 60);
  vl_context_destroy(race.context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_index_once),    cmocka_unit_test(several_callers),
      cmocka_unit_test(callers_own_loop),   cmocka_unit_test(loops_overlap),
      cmocka_unit_test(priority_gives_way), cmocka_unit_test(log_is_entered_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
