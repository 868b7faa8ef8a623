/* example.h: what the short examples share: they render a scene file with settings of their own.
 *
 *   example_run(count, arguments, change)   loads the scene arguments[1], lets change(defs) set what it likes, renders
 * and writes the image arguments[2]; returns the exit code of main
 */
#ifndef EXAMPLE_H
#define EXAMPLE_H

#include <stdio.h>
#include <velo/velo.h>

static inline int example_run(int count, char **arguments, void (*change)(vlSceneDefs *defs)) {
  if (count != 3) {
    fprintf(stderr, "usage: %s SCENE IMAGE\n", arguments[0]);
    return 2;
  }
  vlContextDef context_def = vl_default_context_def();
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlCamera camera;
  vlRenderStats stats;
  vlError error = {0};
  vlResult result = vl_context_create(&context_def, &context);
  if (result == VL_OK) result = vl_scene_create(context, &scene);
  if (result == VL_OK) result = vl_scene_load(scene, arguments[1], NULL, &error);
  if (result == VL_OK) result = vl_scene_complete(scene, NULL, &error);
  if (result == VL_OK) {
    vlSceneDefs *defs = vl_scene_defs(scene);
    change(defs);
    result = vl_world_build(scene, &defs->build, &world, &error);
    if (result == VL_OK) result = vl_camera_make(&defs->camera, &camera, NULL, &error);
    if (result == VL_OK) result = vl_film_create(context, &defs->film, &film);
    if (result == VL_OK) result = vl_render(world, &camera, film, &defs->render, &stats, &error);
    if (result == VL_OK) result = vl_film_develop(film, &defs->develop, &image);
  }
  if (result == VL_OK) result = vl_image_write(image, arguments[2], NULL, &error);
  if (result != VL_OK) fprintf(stderr, "%s: %s: %s\n", arguments[0], vl_result_name(result), error.message);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return result == VL_OK ? 0 : 1;
}

#endif
