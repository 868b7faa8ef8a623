/* own_tracer: a tracer of one's own: light that reaches the camera straight from lamps, or by at most two surfaces
 * (docs/own-code.md).
 *
 *   own_tracer SCENE IMAGE
 *   build/release/bin/example_own_tracer examples/corner.pbrt examples/own_tracer.jpg
 */
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

static void radiance_of(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  vlTraceHits hits;
  vlTraceLights lights;
  vlTraceBounce next = {.rays = *paths->rays};
  uint8_t occluded[VL_OWN_BATCH];
  float bsdf[4][VL_OWN_BATCH], beta[4][VL_OWN_BATCH];
  for (uint32_t bounce = 0; bounce < 2; bounce++) {
    vl_world_trace(trace, &next.rays, &hits);
    vl_trace_lights(trace, bounce, &lights);
    vl_world_occluded(trace, &lights.rays, occluded);
    vl_trace_bsdf(trace, lights.direction, bsdf, NULL);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = 0; i < paths->count; i++) {
        beta[c][i] = bounce ? beta[c][i] * next.weight[c][i] : 1;
        if (bounce == 0 || next.specular[i]) paths->radiance[c][i] += beta[c][i] * hits.emission[c][i];
        if (!occluded[i]) paths->radiance[c][i] += beta[c][i] * bsdf[c][i] * lights.radiance[c][i];
      }
    vl_trace_bounce(trace, bounce, &next);
  }
}

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  static const vlOwnTracer two_surfaces = {.name = "two surfaces", .radiance = radiance_of};
  if (count != 3) {
    fprintf(stderr, "usage: own_tracer SCENE IMAGE\n");
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
  defs->render.own_tracer = &two_surfaces;
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
