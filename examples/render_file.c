/* render_file: the shortest program that renders a scene file with velo's public API. It uses the settings in the file,
 * so the image has the same bytes as that of `velo render SCENE -o IMAGE`.
 *
 *   render_file SCENE IMAGE     the suffix of IMAGE selects the format; .exr and .pfm are linear
 *   build/release/bin/example_render_file examples/corner.pbrt examples/render_file.jpg
 *
 * To compile it against an installed velo:
 *   cc -std=c17 render_file.c $(pkg-config --cflags --libs velo) -o render_file
 */
#include <stdio.h>
#include <velo/velo.h>

static vlResult render_file(vlContext *context, const char *path, const char *result_path, vlError *error) {
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlCamera camera;

  vlResult result = vl_scene_create(context, &scene);
  if (result == VL_OK) result = vl_scene_load(scene, path, NULL, error);
  if (result == VL_OK)
    result = vl_scene_complete(scene, NULL, error); /* adds a camera and light if the file has none */
  if (result == VL_OK) {
    vlSceneDefs *defs = vl_scene_defs(scene); /* the file's settings; may be changed here */
    result = vl_world_build(scene, &defs->build, &world, error);
    if (result == VL_OK) result = vl_camera_make(&defs->camera, &camera, NULL, error);
    if (result == VL_OK) result = vl_film_create(context, &defs->film, &film);
    if (result == VL_OK) result = vl_render(world, &camera, film, &defs->render, NULL, error);
    if (result == VL_OK) result = vl_film_develop(film, &defs->develop, &image);
  }
  if (result == VL_OK) result = vl_image_write(image, result_path, NULL, error);

  vl_image_destroy(image); /* null is allowed */
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return result;
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: render_file SCENE IMAGE\n");
    return 2;
  }
  vlContext *context = NULL;
  vlContextDef def = vl_default_context_def();
  vlError error = {0};
  vlResult result = vl_context_create(&def, &context);
  if (result == VL_OK) result = render_file(context, arguments[1], arguments[2], &error);
  vl_context_destroy(context);
  if (result == VL_OK) return 0;
  fprintf(stderr, "render_file: %s:%u:%u: %s%s%s\n", error.file[0] ? error.file : arguments[1], error.line,
          error.column, vl_result_name(result), error.message[0] ? ": " : "", error.message);
  return 1;
}
