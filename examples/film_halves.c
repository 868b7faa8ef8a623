/* film_halves: a film in two halves: each has half of the samples, as if two machines had rendered them; merged they
 * have the bytes of one render of all samples. The film files are IMAGE.1.film, IMAGE.2.film and IMAGE.film.
 *
 *   film_halves SCENE IMAGE
 *   build/release/bin/example_film_halves examples/corner.pbrt examples/film_halves.jpg
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

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: film_halves SCENE IMAGE\n");
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
  char names[2][4096], whole[4096];
  uint32_t spp = defs->render.spp;
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  for (uint32_t half = 0; half < 2; half++) {
    snprintf(names[half], sizeof names[half], "%s.%u.film", arguments[2], half + 1);
    defs->render.first_sample = half * spp / 2;
    defs->render.spp = (half + 1) * spp / 2;
    must(vl_film_create(context, &defs->film, &film), &error);
    must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
    must(vl_film_write(film, NULL, names[half], &error), &error);
    vl_film_destroy(film);
  }
  const char *const paths[2] = {names[0], names[1]};
  snprintf(whole, sizeof whole, "%s.film", arguments[2]);
  must(vl_film_merge(context, paths, 2, NULL, whole, &error), &error);
  must(vl_film_read(context, whole, false, &film, &error), &error);
  must(vl_film_develop(film, &defs->develop, &image), &error);
  must(vl_image_write(image, arguments[2], NULL, &error), &error);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
