/* viewer_loop: the loop of a viewer: a first image at 1/8 of the size, then finer ones; after each pass the image so
 * far is shown (here: written), and a movement of the camera would end the render between two batches.
 *
 *   viewer_loop SCENE IMAGE
 *   build/release/bin/example_viewer_loop examples/corner.pbrt examples/viewer_loop.jpg
 */
#include "example.h"

typedef struct Viewer {
  Example *example;
  const char *path;
  double shown; /* seconds after the start */
} Viewer;

/* Called after each pass, and ten times a second. False ends the render: here a viewer looks for its user's keys. */
static bool pass(void *user, const vlProgress *progress) {
  Viewer *viewer = user;
  if (progress->pass_done && (progress->elapsed > viewer->shown + 0.5 || progress->fraction == 1)) {
    example_write(viewer->example, viewer->path);
    printf("%u of %u samples per pixel\n", progress->spp_done, progress->spp_total);
    viewer->shown = progress->elapsed;
  }
  return true;
}

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  Viewer viewer = {.example = &e, .path = arguments[2]};
  example_build(&e);
  vlFilm *film = e.film;
  for (uint32_t factor = 8; factor >= 1; factor /= 2) { /* 1/8, 1/4, 1/2 of the size with one sample; then all */
    vlRenderDef render = e.defs->render;
    vlFilmDef coarse_def = vl_coarse_film_def(&e.defs->film, factor);
    vlCamera camera;
    example_must(&e, vl_camera_coarse(&e.camera, factor, &camera), "camera");
    if (factor > 1) render.spp = 1;
    if (factor > 1) example_must(&e, vl_film_create(e.context, &coarse_def, &e.film), "film");
    render.progress = pass, render.progress_user = &viewer;
    viewer.shown = -1;
    example_must(&e, vl_render(e.world, &camera, e.film, &render, NULL, &e.error), "render");
    if (factor > 1) vl_film_destroy(e.film);
    e.film = film;
  }
  return example_close(&e);
}
