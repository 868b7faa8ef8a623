/* test/cli/helper_own.c: renders a scene with code of its own of one kind and writes the image,
 * with its receipt, and the film, for test_own.sh: helper_own SCENE camera|sampler|tracer NAME
 * IMAGE FILM */
#include <stdio.h>
#include <string.h>

#include "velo/film.h"
#include "velo/trace.h"

static void ahead(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    rays->dx[i] = points->x[i] - 0.5 * points->width;
    rays->dy[i] = points->y[i] - 0.5 * points->height;
    rays->dz[i] = points->width;
  }
}

static void halves(void *user, const vlOwnSamples *samples) {
  (void)user;
  for (uint32_t i = 0; i < samples->count; i++)
    samples->u[i] = 0.5f;
  for (uint32_t i = 0; samples->v && i < samples->count; i++)
    samples->v[i] = 0.5f;
}

static void white(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  (void)trace;
  for (int c = 0; c < 4; c++)
    memcpy(paths->radiance[c], paths->white[c], sizeof(float) * paths->count);
}

int main(int count, char **words) {
  if (count != 6)
    return 2;
  const vlOwnCamera camera_code = {.name = words[3], .rays = ahead};
  const vlOwnSampler sampler_code = {.name = words[3], .numbers = halves};
  const vlOwnTracer tracer_code = {.name = words[3], .radiance = white};
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlReceipt *receipt = NULL;
  vlCamera camera;
  vlResult r = vl_context_create(&def, &context);
  if (r == VL_OK)
    r = vl_scene_create(context, &scene);
  if (r == VL_OK)
    r = vl_scene_load(scene, words[1], NULL, &error);
  if (r == VL_OK) {
    vlSceneDefs *defs = vl_scene_defs(scene);
    if (!strcmp(words[2], "camera"))
      defs->camera.own = &camera_code;
    if (!strcmp(words[2], "sampler"))
      defs->render.own_sampler = &sampler_code;
    if (!strcmp(words[2], "tracer"))
      defs->render.own_tracer = &tracer_code;
    r = vl_world_build(scene, &defs->build, &world, &error);
    if (r == VL_OK)
      r = vl_camera_make(&defs->camera, &camera, NULL, &error);
    if (r == VL_OK)
      r = vl_film_create(context, &defs->film, &film);
    if (r == VL_OK)
      r = vl_render(world, &camera, film, &defs->render, NULL, &error);
    vlReceiptDef made = vl_default_receipt_def();
    made.scene = words[1];
    made.defs = defs;
    made.samples = defs->render.spp;
    if (r == VL_OK)
      r = vl_receipt_make(context, &made, &receipt, &error);
    if (r == VL_OK)
      r = vl_film_develop(film, &defs->develop, &image);
  }
  if (r == VL_OK) {
    const vlAttribute own = {.name = "velo.receipt",
                             .type = VL_ATTRIBUTE_STRING,
                             .string = vl_receipt_text(receipt)};
    vlFilmWriteDef write = vl_default_film_write_def();
    write.receipt = vl_receipt_text(receipt);
    r = vl_image_set_attribute(image, &own);
    if (r == VL_OK)
      r = vl_image_write(image, words[4], NULL, &error);
    if (r == VL_OK)
      r = vl_film_write(film, &write, words[5], &error);
  }
  if (r != VL_OK)
    fprintf(stderr, "helper_own: %s: %s\n", vl_result_name(r), error.message);
  vl_receipt_destroy(receipt);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return r == VL_OK ? 0 : 1;
}
