/* thousand_frames: a camera goes round the scene in 1000 small frames. World and film are made once. The image is a
 * sheet of 40 of the frames.
 *
 *   thousand_frames SCENE IMAGE
 *   build/release/bin/example_thousand_frames examples/corner.pbrt examples/thousand_frames.jpg
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

enum { FRAMES = 1000, WIDTH = 48, HEIGHT = 32, COLUMNS = 8, ROWS = 5 };

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: thousand_frames SCENE IMAGE\n");
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
  vlImageDef sheet_def = vl_default_image_def(COLUMNS * WIDTH, ROWS * HEIGHT, 3);
  vlImage *sheet;
  defs->film = vl_default_film_def(WIDTH, HEIGHT);
  defs->camera.width = WIDTH;
  defs->camera.height = HEIGHT;
  defs->render.spp = 1;
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  must(vl_image_create(context, &sheet_def, &sheet), &error);
  float *pixels = vl_image_pixels(sheet);
  for (uint32_t frame = 0; frame < FRAMES; frame++) {
    double turn = 6.283185307179586 * frame / FRAMES,
           eye[3] = {1.5 * sin(turn), 1.5 + 0.5 * sin(2 * turn), 4 + cos(turn)};
    for (int i = 0; i < 3; i++) defs->camera.eye[i] = eye[i];
    must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
    defs->render.seed = frame;
    vl_film_clear(film);
    must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
    uint32_t place = frame / (FRAMES / (COLUMNS * ROWS));
    if (frame % (FRAMES / (COLUMNS * ROWS))) continue; /* a program would write the frame, or learn from it */
    must(vl_film_develop(film, &defs->develop, &image), &error);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
      uint32_t x = place % COLUMNS * WIDTH + i % WIDTH, y = place / COLUMNS * HEIGHT + i / WIDTH;
      for (uint32_t c = 0; c < 3; c++)
        pixels[3 * (y * COLUMNS * WIDTH + x) + c] = vl_image_get(image, i % WIDTH, i / WIDTH, c);
    }
    vl_image_destroy(image);
  }
  must(vl_image_write(sheet, arguments[2], NULL, &error), &error);
  vl_image_destroy(sheet);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
