/* bench/cancel.c: how soon a load and a build of a scene stop. Requests to cancel are made at
 * times that are spread over both. Usage: bench_cancel SCENE ...  Prints the time of load and
 * build, the median and the longest time from a request to the return, and at which time of the
 * whole the longest began. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "velo/velo.h"

enum { ROUNDS = 25 };

typedef struct Work {
  vlContext *context;
  const char *path;
  vlCancel *cancel;
  double start, loaded, end; /* ms */
  bool failed;
} Work;

static double wall(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void *load_and_build(void *user) {
  Work *w = user;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  load.cancel = w->cancel;
  w->start = wall();
  vlResult r = vl_scene_create(w->context, &scene);
  if (r == VL_OK)
    r = vl_scene_load(scene, w->path, &load, &error);
  w->loaded = wall();
  if (r == VL_OK) {
    vlBuildDef build = vl_scene_defs(scene)->build;
    build.cancel = w->cancel;
    r = vl_world_build_last(scene, &build, &world, &error);
  }
  w->end = wall();
  w->failed = r != VL_OK && r != VL_CANCELLED;
  if (w->failed)
    fprintf(stderr, "bench_cancel: %s: %s\n", w->path, error.message);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return NULL;
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Returns whether the scene can be loaded. */
static bool measure(vlContext *context, const char *path) {
  Work w = {.context = context, .path = path};
  double late[ROUNDS], worst_at = 0, worst = 0;
  if (vl_cancel_create(context, &w.cancel) != VL_OK)
    return false;
  for (int i = 0; i < 2; i++)
    load_and_build(&w); /* the second time files are in memory */
  const double load = w.loaded - w.start, whole = w.end - w.start;
  for (int k = 0; k < ROUNDS && !w.failed; k++) {
    pthread_t thread;
    double wait = whole * (k + 0.5) / ROUNDS;
    if (pthread_create(&thread, NULL, load_and_build, &w) != 0)
      exit(1);
    nanosleep(&(struct timespec){(time_t)(wait / 1e3),
                                 (long)(1e6 * (wait - 1e3 * (double)(long)(wait / 1e3)))},
              NULL);
    double asked = wall();
    vl_cancel_request(w.cancel);
    pthread_join(thread, NULL);
    vl_cancel_clear(w.cancel);
    late[k] = w.end > asked ? w.end - asked : 0;
    if (late[k] > worst) {
      worst = late[k];
      worst_at = wait;
    }
  }
  vl_cancel_destroy(w.cancel);
  if (w.failed)
    return false;
  qsort(late, ROUNDS, sizeof *late, by_value);
  printf(
      "%s: load %.0f ms, build %.0f ms; stops after %.1f ms (median), %.1f ms (longest, "
      "asked at %.0f ms)\n",
      path, load, whole - load, late[ROUNDS / 2], worst, worst_at);
  return true;
}

int main(int argc, char **argv) {
  vlContext *context = NULL;
  if (argc < 2) {
    fprintf(stderr, "usage: bench_cancel SCENE ...\n");
    return 2;
  }
  if (vl_context_create(NULL, &context) != VL_OK)
    return 1;
  bool fine = true;
  for (int i = 1; i < argc; i++)
    fine &= measure(context, argv[i]);
  vl_context_destroy(context);
  return fine ? 0 : 1;
}
