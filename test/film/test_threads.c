/* test/film/test_threads.c: at the same time, a render with checkpoints is stopped by another
 * thread and continued, shards are rendered, and films are merged. The test is meant for the
 * thread sanitizer. The films must also have the same bytes as those of a single render. */
/* cmocka.h needs the four headers above */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/small_world.h"
#include "unit.h"
#include "velo/film.h"

enum { STOP = 2, SPP = 4, MAX_SIZE = 1 << 20 };
static char folder[64];
static vlContext *context;
static vlWorld *world;
static vlCamera camera;

static int begin(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/velo-threads-XXXXXX");
  vlContextDef def = vl_default_context_def();
  vlBuildDef build = vl_default_build_def();
  vlScene *scene = NULL;
  vlError error;
  def.threads = 3;
  if (!mkdtemp(folder) || vl_context_create(&def, &context) != VL_OK ||
      vl_scene_create(context, &scene) != VL_OK)
    return 1;
  small_scene(scene);
  vlResult result = vl_world_build(scene, &build, &world, &error);
  vl_scene_destroy(scene);
  return result != VL_OK || small_camera(&camera) != VL_OK;
}

static int end(void **state) {
  (void)state;
  char command[128];
  vl_world_destroy(world);
  vl_context_destroy(context);
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

static void path_of(char path[128], const char *name) {
  snprintf(path, 128, "%s/%s", folder, name);
}

static size_t bytes_of(const char *name, char *bytes) {
  char path[128];
  path_of(path, name);
  FILE *file = fopen(path, "rb");
  if (!file)
    return 0;
  size_t size = fread(bytes, 1, MAX_SIZE, file);
  fclose(file);
  return size;
}

static void assert_same_files(const char *a, const char *b) {
  static char x[MAX_SIZE], y[MAX_SIZE];
  size_t n = bytes_of(a, x), m = bytes_of(b, y);
  assert_true(n > 0 && n < MAX_SIZE);
  assert_int_equal(n, m);
  assert_memory_equal(x, y, n);
}

/* ---- a render with checkpoints ----------------------------------------------------------- */

/* Writes a film after each pass. A thread waits for the disk while the next pass renders. */
typedef struct Keeper {
  const vlFilm *film;
  const char *name;
  vlFilmWriter *writer;
  pthread_t thread;
  uint32_t written;
  bool running;
  vlResult result;
} Keeper;

static void *end_write(void *user) {
  Keeper *k = user;
  k->result = vl_film_write_end(k->writer, NULL);
  return NULL;
}

static bool join(Keeper *k) {
  if (k->running)
    pthread_join(k->thread, NULL);
  k->running = false;
  return k->result == VL_OK;
}

static bool keep(void *user, const vlProgress *progress) {
  Keeper *k = user;
  char path[128];
  path_of(path, k->name);
  if (!progress->pass_done)
    return true;
  if (!join(k) || vl_film_write_begin(k->film, NULL, path, &k->writer, NULL) != VL_OK)
    return false;
  k->running = pthread_create(&k->thread, NULL, end_write, k) == 0;
  k->written++;
  return k->running;
}

static vlFilm *new_film(void) {
  vlFilmDef def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  vlFilm *film = NULL;
  def.errors = true;
  return vl_film_create(context, &def, &film) == VL_OK ? film : NULL;
}

/* Renders the samples from `first`, or from the film's end, to `spp`, and writes a film file
 * after each pass. */
static bool render_kept(vlFilm *film, const char *name, uint32_t first, uint32_t spp) {
  Keeper keeper = {.film = film, .name = name};
  vlRenderDef def = vl_default_render_def();
  def.spp = spp;
  def.first_sample = first;
  def.progress = keep;
  def.progress_user = &keeper;
  bool done = film && vl_render(world, &camera, film, &def, NULL, NULL) == VL_OK;
  return join(&keeper) && done && keeper.written > 0;
}

static void a_kept_render_continues(void **state) {
  (void)state;
  char path[128];
  vlFilm *film = new_film(), *read = NULL, *whole = new_film();
  assert_true(render_kept(film, "part.film", 0, STOP));
  path_of(path, "part.film");
  assert_int_equal(vl_film_read(context, path, false, &read, NULL), VL_OK);
  assert_true(render_kept(read, "part.film", 0, SPP));
  assert_true(render_kept(whole, "whole.film", 0, SPP));
  assert_same_files("part.film", "whole.film");
  vl_film_destroy(film);
  vl_film_destroy(read);
  vl_film_destroy(whole);
}

/* ---- shards and merges at the same time -------------------------------------------------- */

typedef struct Shard {
  const char *name;
  uint32_t first, spp;
  bool done;
} Shard;

static void *render_shard(void *user) {
  Shard *shard = user;
  vlFilm *film = new_film();
  shard->done = render_kept(film, shard->name, shard->first, shard->spp);
  vl_film_destroy(film);
  return NULL;
}

static void *merge_shards(void *user) {
  Shard *shard = user;
  char paths[2][128], output[128];
  path_of(paths[0], "first.film");
  path_of(paths[1], "last.film");
  path_of(output, shard->name);
  shard->done = vl_film_merge(context, (const char *const[]){paths[1], paths[0]}, 2, NULL,
                              output, NULL) == VL_OK;
  return NULL;
}

static void run_both(void *(*job)(void *), Shard shards[2]) {
  pthread_t threads[2];
  for (int i = 0; i < 2; i++)
    assert_int_equal(pthread_create(&threads[i], NULL, job, &shards[i]), 0);
  for (int i = 0; i < 2; i++)
    pthread_join(threads[i], NULL);
  assert_true(shards[0].done && shards[1].done);
}

static void shards_are_rendered_and_merged_at_once(void **state) {
  (void)state;
  Shard shards[2] = {{"first.film", 0, STOP, false}, {"last.film", STOP, SPP, false}};
  Shard merges[2] = {{"merge1.film", 0, 0, false}, {"merge2.film", 0, 0, false}};
  vlFilm *whole = new_film();
  run_both(render_shard, shards);
  run_both(merge_shards, merges);
  assert_true(render_kept(whole, "whole.film", 0, SPP));
  assert_same_files("merge1.film", "whole.film");
  assert_same_files("merge2.film", "whole.film");
  vl_film_destroy(whole);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_kept_render_continues),
                                     cmocka_unit_test(shards_are_rendered_and_merged_at_once)};
  return cmocka_run_group_tests(tests, begin, end);
}
