/* viewer_loop: the loop of a viewer: a first image at 1/8 of the size, then finer ones; after each pass the image so
 * far is shown (here: written), and a movement of the camera would end the render between two batches.
 *
 *   viewer_loop SCENE IMAGE
 *   build/release/bin/example_viewer_loop examples/corner.pbrt examples/viewer_loop.jpg
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

typedef struct Viewer {
  const char *path;
  const vlDevelopDef *develop;
  vlFilm *film;
  double shown; /* seconds after the start */
} Viewer;

static void show(const Viewer *viewer) {
  vlError error = {0};
  vlImage *image;
  must(vl_film_develop(viewer->film, viewer->develop, &image), &error);
  must(vl_image_write(image, viewer->path, NULL, &error), &error);
  vl_image_destroy(image);
}

/* Called after each pass, and ten times a second. False ends the render: here a viewer looks for its user's keys. */
static bool pass(void *user, const vlProgress *progress) {
  Viewer *viewer = user;
  if (progress->pass_done && (progress->elapsed > viewer->shown + 0.5 || progress->fraction == 1)) {
    show(viewer);
    printf("%u of %u samples per pixel\n", progress->spp_done, progress->spp_total);
    viewer->shown = progress->elapsed;
  }
  return true;
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: viewer_loop SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlCamera camera;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  Viewer viewer = {.path = arguments[2], .develop = &defs->develop};
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  for (uint32_t factor = 8; factor >= 1; factor /= 2) { /* 1/8, 1/4, 1/2 of the size with one sample; then all */
    vlRenderDef render = defs->render;
    vlFilmDef film = vl_coarse_film_def(&defs->film, factor);
    vlCamera coarse;
    must(vl_camera_coarse(&camera, factor, &coarse), &error);
    must(vl_film_create(context, &film, &viewer.film), &error);
    if (factor > 1) render.spp = 1;
    render.progress = pass;
    render.progress_user = &viewer;
    viewer.shown = -1;
    must(vl_render(world, &coarse, viewer.film, &render, NULL, &error), &error);
    vl_film_destroy(viewer.film);
  }
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
