/* stereo: the two eyes of a stereo pair, side by side. Their windows show the same rectangle at the distance of
 * convergence.
 *
 *   stereo SCENE IMAGE
 *   build/release/bin/example_stereo examples/corner.pbrt examples/stereo.jpg
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
    fprintf(stderr, "usage: stereo SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlImage *images[2];
  vlCamera eyes[2];
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  defs->camera.stereo = (vlStereo){.mode = VL_STEREO_OFF_AXIS, .interocular = 0.2, .convergence = 4.5};
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_stereo(&defs->camera, &eyes[0], &eyes[1], NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  for (int eye = 0; eye < 2; eye++) {
    vl_film_clear(film);
    must(vl_render(world, &eyes[eye], film, &defs->render, NULL, &error), &error);
    must(vl_film_develop(film, &defs->develop, &images[eye]), &error);
  }
  vlImage *both = join(context, images[0], images[1], &error);
  must(vl_image_write(both, arguments[2], NULL, &error), &error);
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  vl_image_destroy(both);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
