/* test/api/test_threads.c: one world shared by renders on several threads of the caller, each
 * with its own workers. Meant for the thread sanitizer; the images must also be
 * bit-identical. */
#include <pthread.h>

#include "api/small_world.h"
#include "unit.h"
#include "velo/channels.h"
#include "velo/edit.h"

typedef struct Job {
  vlContext *context;
  const vlWorld *world;
  vlImage *image;
} Job;

static void *render_one(void *argument) {
  Job *job = argument;
  vlCamera camera;
  vlFilm *film = NULL;
  vlFilmDef film_def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  vlDevelopDef develop = vl_default_develop_def();
  vlRenderDef render = vl_default_render_def();
  render.spp = 2;
  if (small_camera(&camera) == VL_OK &&
      vl_film_create(job->context, &film_def, &film) == VL_OK &&
      vl_render(job->world, &camera, film, &render, NULL, NULL) == VL_OK)
    vl_film_develop(film, &develop, &job->image);
  vl_film_destroy(film);
  return NULL;
}

static void a_world_is_shared(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 3;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlBuildDef build = vl_default_build_def();
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  small_scene(scene);
  assert_int_equal(vl_world_build(scene, &build, &world, &error), VL_OK);
  vl_scene_destroy(scene);
  Job jobs[2] = {{context, world, NULL}, {context, world, NULL}};
  pthread_t threads[2];
  for (int i = 0; i < 2; i++)
    assert_int_equal(pthread_create(&threads[i], NULL, render_one, &jobs[i]), 0);
  for (int i = 0; i < 2; i++)
    pthread_join(threads[i], NULL);
  assert_non_null(jobs[0].image);
  assert_non_null(jobs[1].image);
  assert_memory_equal(
      vl_image_const_pixels(jobs[0].image), vl_image_const_pixels(jobs[1].image),
      (size_t)SMALL_WIDTH * SMALL_HEIGHT * vl_image_channels(jobs[0].image) * sizeof(float));
  for (int i = 0; i < 2; i++)
    vl_image_destroy(jobs[i].image);
  vl_world_destroy(world);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* Ground truth, a build and an edit beside two renders. */
static void *render_channels(void *argument) {
  Job *job = argument;
  vlCamera camera;
  vlImage *ids = NULL;
  vlChannelsDef def = vl_default_channels_def(SMALL_WIDTH, SMALL_HEIGHT);
  if (small_camera(&camera) == VL_OK)
    vl_render_channels(job->world, &camera, &def, &job->image, &ids, NULL);
  vl_image_destroy(ids);
  return NULL;
}

static void *build_again(void *argument) {
  Job *job = argument;
  vlScene *scene = NULL;
  vlBuildDef build = vl_default_build_def();
  build.previous = job->world;
  if (vl_scene_create(job->context, &scene) != VL_OK)
    return NULL;
  small_scene(scene);
  for (int i = 0; i < 3; i++) {
    vlWorld *world = NULL;
    double place[16];
    small_place(place, 0.1 * i, 0.4, 0);
    vl_scene_set_instance(scene, (vlInstanceId){1}, place, NULL);
    if (vl_world_build(scene, &build, &world, NULL) != VL_OK)
      break;
    if (i == 2) {
      Job shot = {job->context, world, NULL};
      render_one(&shot);
      job->image = shot.image;
    }
    vl_world_destroy(world);
  }
  vl_scene_destroy(scene);
  return NULL;
}

static void calls_overlap(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 3;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  small_scene(scene);
  assert_int_equal(vl_world_build(scene, NULL, &world, NULL), VL_OK);
  vl_scene_destroy(scene);
  static void *(*const calls[4])(void *) = {render_one, render_channels, build_again,
                                            render_one};
  Job jobs[4];
  pthread_t threads[4];
  for (int i = 0; i < 4; i++) {
    jobs[i] = (Job){context, world, NULL};
    assert_int_equal(pthread_create(&threads[i], NULL, calls[i], &jobs[i]), 0);
  }
  for (int i = 0; i < 4; i++)
    pthread_join(threads[i], NULL);
  for (int i = 0; i < 4; i++)
    assert_non_null(jobs[i].image);
  assert_memory_equal(
      vl_image_const_pixels(jobs[0].image), vl_image_const_pixels(jobs[3].image),
      (size_t)SMALL_WIDTH * SMALL_HEIGHT * vl_image_channels(jobs[0].image) * sizeof(float));
  for (int i = 0; i < 4; i++)
    vl_image_destroy(jobs[i].image);
  vl_world_destroy(world);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* The progress report reads what the workers count, from inside a pass. */
static bool watch(void *user, const vlProgress *progress) {
  int *reports = user;
  if (!progress->pass_done)
    ++*reports;
  return *reports < 3;
}

static void progress_is_told_meanwhile(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 3;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  int reports = 0;
  vlRenderDef render = vl_default_render_def();
  render.spp = 4096;
  render.progress = watch;
  render.progress_user = &reports;
  vlImage *image = NULL;
  assert_int_equal(small_image(context, &render, NULL, VL_COLOR_SPECTRAL, &image),
                   VL_CANCELLED);
  assert_int_equal(reports, 3);
  vl_image_destroy(image);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_world_is_shared),
                                     cmocka_unit_test(calls_overlap),
                                     cmocka_unit_test(progress_is_told_meanwhile)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
