/* edit_render: changes a scene and renders it again: gold becomes red plaster, one ball is hidden. The second world
 * shares with the first what has not changed. The image shows both.
 *
 *   edit_render SCENE IMAGE
 *   build/release/bin/example_edit_render examples/corner.pbrt examples/edit_render.jpg
 */
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

/* The left and the right image side by side; the caller destroys the result. */
static vlImage *join(vlContext *context, const vlImage *left, const vlImage *right, vlError *error) {
  uint32_t width = vl_image_width(left), height = vl_image_height(left);
  vlImageDef def = vl_default_image_def(2 * width, height, 3);
  vlImage *both;
  must(vl_image_create(context, &def, &both), error);
  float *to = vl_image_pixels(both);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < 2 * width; x++)
      for (uint32_t c = 0; c < 3; c++) *to++ = vl_image_get(x < width ? left : right, x % width, y, c);
  return both;
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: edit_render SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world, *first;
  vlFilm *film;
  vlImage *before, *after;
  vlCamera camera;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
  must(vl_film_develop(film, &defs->develop, &before), &error);
  const vlMaterialDef *material;
  for (uint32_t i = 1; (material = vl_scene_material(scene, (vlMaterialId){i})); i++) {
    if (material->kind != VL_MATERIAL_CONDUCTOR) continue;
    vlMaterialDef plaster = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    plaster.reflectance = vl_spectrum_input(vl_spectrum_rgb(0.7f, 0.1f, 0.05f));
    must(vl_scene_set_material(scene, (vlMaterialId){i}, &plaster, &error), &error);
  }
  uint32_t shapes = vl_scene_id_count(scene, VL_ID_OBJECT); /* the ball that the file describes last */
  must(vl_scene_show_shape(scene, (vlShapeId){shapes}, false, &error), &error);
  first = world;
  vlBuildDef build = defs->build;
  build.previous = first; /* what has not changed is shared */
  must(vl_world_build(scene, &build, &world, &error), &error);
  vl_world_destroy(first);
  vl_film_clear(film);
  must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
  must(vl_film_develop(film, &defs->develop, &after), &error);
  vlImage *both = join(context, before, after, &error);
  must(vl_image_write(both, arguments[2], NULL, &error), &error);
  vl_image_destroy(before);
  vl_image_destroy(after);
  vl_image_destroy(both);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
