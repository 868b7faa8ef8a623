/* own_sampler: a sampler of one's own: in each dimension the samples of a pixel go round by steps of one angle (a
 * Kronecker sequence); each pixel starts elsewhere (docs/own-code.md).
 *
 *   own_sampler SCENE IMAGE
 *   build/release/bin/example_own_sampler examples/corner.pbrt examples/own_sampler.jpg
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

static double hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  uint32_t h = a * 0x9e3779b9u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 0x165667b1u) * 0xc2b2ae35u ^ d * 0x27d4eb2fu;
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return (h ^ h >> 16) * 0x1p-32;
}

static float number(const vlOwnSamples *s, uint32_t i, uint32_t dimension) {
  double start = hash((uint32_t)s->x[i], (uint32_t)s->y[i], dimension, s->seed);
  double u = start + s->index[i] * hash(dimension, s->seed, 0, 0);
  return fminf((float)(u - floor(u)), 0x1.fffffep-1f); /* at most the largest float below 1 */
}

static void numbers_of(void *user, const vlOwnSamples *s) {
  (void)user;
  for (uint32_t i = 0; i < s->count; i++) s->u[i] = number(s, i, s->dimension);
  for (uint32_t i = 0; s->v && i < s->count; i++) s->v[i] = number(s, i, s->dimension + 1);
}

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  static const vlOwnSampler sampler = {.name = "Kronecker", .numbers = numbers_of};
  if (count != 3) {
    fprintf(stderr, "usage: own_sampler SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlImage *image;
  vlCamera camera;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  defs->render.own_sampler = &sampler;
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
  vl_context_destroy(context);
  return 0;
}
