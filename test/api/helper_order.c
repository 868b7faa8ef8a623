/* test/api/helper_order.c: renders a scene with the library while its parallel loops run in
 * another order: from last to first, or shuffled by a seed.
 *
 * Usage: helper_order SCENE WIDTH HEIGHT SPP TRACER SEED ORDER OUT.pfm
 *
 * TRACER is a name of pbrt files, or - for the scene's own. ORDER is 0 (first to last), 1 (last
 * to first), or a larger number (the seed of a shuffle). The image must equal that of `velo
 * render SCENE --resolution WIDTHxHEIGHT --spp SPP --seed SEED`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "velo/focus.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/schema.h"
#include "velo/tracer.h"

enum { WORKERS = 3 };

static void run_loop(void *user, uint32_t count, vlParallelFn *body, void *loop_user) {
  uint64_t *state = user;
  uint32_t *order = malloc(count * sizeof *order);
  if (!order)
    exit(2);
  for (uint32_t i = 0; i < count; i++)
    order[i] = *state == 1 ? count - 1 - i : i;
  for (uint32_t i = count; i > 1 && *state > 1; i--) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    uint32_t k = (uint32_t)(*state >> 33) % i, kept = order[i - 1];
    order[i - 1] = order[k];
    order[k] = kept;
  }
  for (uint32_t i = 0; i < count; i++)
    body(loop_user, order[i], (uint32_t)(order[i] * 2654435761u >> 16) % WORKERS);
  free(order);
}

static int fail(const char *what, vlResult result, const vlError *error) {
  fprintf(stderr, "helper_order: %s: %s: %s\n", what, vl_result_name(result), error->message);
  return 2;
}

static vlResult focus(const vlWorld *world, vlCamera *camera, vlError *error) {
  double *pixel = camera->lens.focus_pixel;
  if (!(pixel[0] == pixel[0]))
    return VL_OK;
  vlResult result =
      vl_autofocus(world, camera, pixel[0], pixel[1], &camera->focus_distance, error);
  pixel[0] = pixel[1] = VL_UNSET;
  return result;
}

static bool find_tracer(const char *name, vlTracer *tracer) {
  const vlKindFamily *tracers = vl_kind_family_find("tracers");
  if (strcmp(name, "-") == 0)
    return true;
  for (uint32_t k = 0; k < tracers->kind_count; k++)
    if (tracers->rows[k]->name && strcmp(tracers->rows[k]->name, name) == 0) {
      *tracer = (vlTracer)k;
      return true;
    }
  return false;
}

static vlResult render(vlContext *context, vlScene *scene, char **words, vlError *error) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  uint32_t width = (uint32_t)atoi(words[2]), height = (uint32_t)atoi(words[3]);
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlCamera described, camera;
  defs->render.spp = (uint32_t)atoi(words[4]);
  defs->render.seed = (uint32_t)strtoul(words[6], NULL, 10);
  if (!find_tracer(words[5], &defs->render.tracer))
    return VL_ERROR_ARGUMENT;
  vlFilmDef def = defs->film;
  def.width = width;
  def.height = height;
  memcpy(def.crop, ((uint32_t[]){0, 0, width, height}), sizeof def.crop);
  vlResult result = vl_world_build(scene, &defs->build, &world, error);
  if (result == VL_OK)
    result = vl_camera_make(&defs->camera, &described, NULL, error);
  if (result == VL_OK)
    result = vl_camera_resize(&described, width, height, &camera);
  if (result == VL_OK)
    result = focus(world, &camera, error);
  if (result == VL_OK)
    result = vl_film_create(context, &def, &film);
  if (result == VL_OK)
    result = vl_render(world, &camera, film, &defs->render, NULL, error);
  if (result == VL_OK)
    result = vl_film_develop(film, &defs->develop, &image);
  if (result == VL_OK)
    result = vl_image_write(image, words[8], NULL, error);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  return result;
}

int main(int count, char **words) {
  if (count != 9)
    return 2;
  uint64_t state = strtoull(words[7], NULL, 10);
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = WORKERS;
  def.parallel_for = run_loop;
  def.parallel_for_user = &state;
  vlResult result = vl_context_create(&def, &context);
  if (result != VL_OK)
    return fail("context", result, &error);
  result = vl_scene_create(context, &scene);
  if (result == VL_OK)
    result = vl_scene_load(scene, words[1], NULL, &error);
  if (result == VL_OK)
    result = render(context, scene, words, &error);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return result == VL_OK ? 0 : fail(words[1], result, &error);
}
