/* test/api/test_cancel.c: a request to cancel stops a render, ground truth, a build and a load
 * between two tasks; the film keeps whole passes; the steps of loads and builds. */
#include <math.h>
#include <pthread.h>
#include <time.h>

#include "api/small_world.h"
#include "unit.h"
#include "velo/channels.h"
#include "velo/load.h"

/* Runs loops on the calling thread and makes the request before task `at` of loop `loop`. */
typedef struct Runner {
  vlCancel *cancel;
  uint32_t loop, at, loops;
} Runner;

static void run_loop(void *user, uint32_t count, vlParallelFn *body, void *loop_user) {
  Runner *r = user;
  for (uint32_t i = 0; i < count; i++) {
    if (r->cancel && r->loops == r->loop && i == r->at)
      vl_cancel_request(r->cancel);
    body(loop_user, i, 0);
  }
  r->loops++;
}

typedef struct Stage {
  vlContext *context;
  vlWorld *world;
  vlCamera camera;
  vlFilm *film;
  vlCancel *cancel;
  Runner runner;
} Stage;

static void set_up(Stage *s, uint32_t threads) {
  memset(s, 0, sizeof *s);
  vlContextDef def = vl_default_context_def();
  def.threads = threads;
  if (threads == 1) {
    def.parallel_for = run_loop;
    def.parallel_for_user = &s->runner;
  }
  assert_int_equal(vl_context_create(&def, &s->context), VL_OK);
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(s->context, &scene), VL_OK);
  small_scene(scene);
  assert_int_equal(vl_world_build(scene, NULL, &s->world, NULL), VL_OK);
  vl_scene_destroy(scene);
  assert_int_equal(small_camera(&s->camera), VL_OK);
  vlFilmDef film = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  assert_int_equal(vl_film_create(s->context, &film, &s->film), VL_OK);
  assert_int_equal(vl_cancel_create(s->context, &s->cancel), VL_OK);
  s->runner = (Runner){0};
}

static void tear_down(Stage *s) {
  vl_cancel_destroy(s->cancel);
  vl_film_destroy(s->film);
  vl_world_destroy(s->world);
  assert_int_equal(vl_context_memory(s->context, NULL), 0);
  vl_context_destroy(s->context);
}

/* An image of two blocks, in place of the small one. */
static void widen(Stage *s, uint32_t width, uint32_t height) {
  vl_film_destroy(s->film);
  vlFilmDef film = vl_default_film_def(width, height);
  assert_int_equal(vl_film_create(s->context, &film, &s->film), VL_OK);
  vlCamera camera = s->camera;
  assert_int_equal(vl_camera_resize(&camera, width, height, &s->camera), VL_OK);
}

/* The request in the middle of the second pass: no batch is traced after it, and the film has
 * the first pass only. */
static void a_render_keeps_whole_passes(void **state) {
  (void)state;
  enum { WIDTH = 144, HEIGHT = 4 };
  Stage s;
  set_up(&s, 1);
  widen(&s, WIDTH, HEIGHT);
  vlRenderDef def = vl_default_render_def();
  vlRenderStats stats;
  def.spp = 1;
  assert_int_equal(vl_render(s.world, &s.camera, s.film, &def, &stats, NULL), VL_OK);
  vlImage *before = NULL, *after = NULL;
  assert_int_equal(vl_film_develop(s.film, NULL, &before), VL_OK);
  def.spp = 2;
  def.cancel = s.cancel;
  s.runner = (Runner){s.cancel, 0, 1, 0};
  vlError error;
  assert_int_equal(vl_render(s.world, &s.camera, s.film, &def, &stats, &error), VL_CANCELLED);
  assert_true(stats.paths > 0);
  assert_true(stats.paths <= 1024); /* one batch */
  assert_int_equal(vl_film_spp(s.film), 1);
  assert_int_equal(vl_film_develop(s.film, NULL, &after), VL_OK);
  assert_memory_equal(vl_image_const_pixels(before), vl_image_const_pixels(after),
                      (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
  assert_true(vl_cancel_requested(s.cancel));
  s.runner.cancel = NULL;
  vl_cancel_clear(s.cancel);
  assert_int_equal(vl_render(s.world, &s.camera, s.film, &def, &stats, NULL), VL_OK);
  assert_int_equal(vl_film_spp(s.film), 2);
  vl_image_destroy(before);
  vl_image_destroy(after);
  tear_down(&s);
}

static void ground_truth_stops(void **state) {
  (void)state;
  Stage s;
  set_up(&s, 1);
  vlChannelsDef def = vl_default_channels_def(SMALL_WIDTH, SMALL_HEIGHT);
  def.cancel = s.cancel;
  s.runner = (Runner){s.cancel, 0, 1, 0};
  vlImage *floats = NULL, *ids = NULL;
  assert_int_equal(vl_render_channels(s.world, &s.camera, &def, &floats, &ids, NULL),
                   VL_CANCELLED);
  assert_null(floats);
  assert_null(ids);
  tear_down(&s);
}

/* Every step stops; the build frees what it has made (tear_down counts the memory). */
static bool stop_at(void *user, const vlStep *step) {
  assert_true(step->fraction >= 0 && step->fraction <= 1);
  assert_true(step->elapsed >= 0);
  assert_non_null(step->name);
  ++*(int *)user;
  return false;
}

static void builds_and_loads_stop(void **state) {
  (void)state;
  Stage s;
  set_up(&s, 2);
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(s.context, &scene), VL_OK);
  small_scene(scene);
  vlBuildDef def = vl_default_build_def();
  def.cancel = s.cancel;
  vl_cancel_request(s.cancel);
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_world_build(scene, &def, &world, &error), VL_CANCELLED);
  assert_null(world);
  vl_cancel_clear(s.cancel);
  int calls = 0;
  def.progress = stop_at;
  def.progress_user = &calls;
  assert_int_equal(vl_world_build(scene, &def, &world, &error), VL_CANCELLED);
  assert_int_equal(calls, 1);
  assert_null(world);
  vl_scene_destroy(scene);
  static const char text[] = "WorldBegin\nShape \"sphere\"\n";
  vlLoadDef load = vl_default_load_def();
  load.cancel = s.cancel;
  vl_cancel_request(s.cancel);
  assert_int_equal(vl_scene_create(s.context, &scene), VL_OK);
  assert_int_equal(
      vl_scene_load_memory(scene, "scene.pbrt", text, sizeof text - 1, &load, &error),
      VL_CANCELLED);
  assert_int_equal(vl_scene_result(scene, NULL), VL_CANCELLED);
  vl_scene_destroy(scene);
  tear_down(&s);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *render_long(void *argument) {
  Stage *s = argument;
  vlRenderDef def = vl_default_render_def();
  def.spp = 1 << 20;
  def.cancel = s->cancel;
  vlResult result = vl_render(s->world, &s->camera, s->film, &def, NULL, NULL);
  return result == VL_CANCELLED ? NULL : s;
}

/* From another thread. The bound is generous: the machine may be busy. */
static void another_thread_cancels(void **state) {
  (void)state;
  Stage s;
  set_up(&s, 2);
  pthread_t thread;
  assert_int_equal(pthread_create(&thread, NULL, render_long, &s), 0);
  nanosleep(&(struct timespec){0, 50000000}, NULL);
  double start = now();
  vl_cancel_request(s.cancel);
  void *failed = &s;
  pthread_join(thread, &failed);
  assert_null(failed);
  assert_true(now() - start < 5);
  tear_down(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_render_keeps_whole_passes),
      cmocka_unit_test(ground_truth_stops),
      cmocka_unit_test(builds_and_loads_stop),
      cmocka_unit_test(another_thread_cancels),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
