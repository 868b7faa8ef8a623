/* allocator: velo inside a program that counts its memory: an allocator of its own, a limit, and a log. The program
 * prints the most bytes that velo held; at the end it holds none.
 *
 *   allocator SCENE IMAGE
 *   build/release/bin/example_allocator examples/corner.pbrt examples/allocator.jpg
 */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

static atomic_long blocks; /* velo's threads allocate at the same time */

static void *allocate(void *user, size_t size) {
  (void)user;
  atomic_fetch_add(&blocks, 1);
  return malloc(size);
}

static void release(void *user, void *block) {
  (void)user;
  if (block) atomic_fetch_sub(&blocks, 1);
  free(block);
}

static void print(void *user, vlLogLevel level, const vlError *where, const char *message) {
  (void)user;
  (void)where;
  if (level <= VL_LOG_WARNING) fprintf(stderr, "%s\n", message);
}

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: allocator SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){NULL, allocate, release};
  def.max_memory = (size_t)1 << 30; /* a call that needs more returns VL_ERROR_MEMORY */
  def.log = print;
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlImage *image;
  vlCamera camera;
  size_t peak;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
  must(vl_film_develop(film, &defs->develop, &image), &error);
  must(vl_image_write(image, arguments[2], NULL, &error), &error);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_memory(context, &peak);
  vl_context_destroy(context);
  printf("%.1f MB at most; %ld blocks are left\n", 1e-6 * (double)peak, atomic_load(&blocks));
  return atomic_load(&blocks) != 0;
}
