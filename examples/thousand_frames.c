/* thousand_frames: a camera goes round the scene in 1000 small frames. World and film are made once. The image is a
 * sheet of 40 of the frames.
 *
 *   thousand_frames SCENE IMAGE
 *   build/release/bin/example_thousand_frames examples/corner.pbrt examples/thousand_frames.jpg
 */
#include <math.h>

#include "example.h"

enum { FRAMES = 1000, WIDTH = 48, HEIGHT = 32, COLUMNS = 8, ROWS = 5 };

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  vlImageDef sheet_def = vl_default_image_def(COLUMNS * WIDTH, ROWS * HEIGHT, 3);
  vlImage *sheet;
  e.defs->film = vl_default_film_def(WIDTH, HEIGHT);
  e.defs->camera.width = WIDTH, e.defs->camera.height = HEIGHT;
  e.defs->render.spp = 1;
  example_build(&e);
  example_must(&e, vl_image_create(e.context, &sheet_def, &sheet), "image");
  float *pixels = vl_image_pixels(sheet);
  for (uint32_t frame = 0; frame < FRAMES; frame++) {
    double turn = 6.283185307179586 * frame / FRAMES,
           eye[3] = {1.5 * sin(turn), 1.5 + 0.5 * sin(2 * turn), 4 + cos(turn)};
    for (int i = 0; i < 3; i++) e.defs->camera.eye[i] = eye[i];
    example_must(&e, vl_camera_make(&e.defs->camera, &e.camera, NULL, &e.error), "camera");
    e.defs->render.seed = frame;
    vl_film_clear(e.film);
    example_must(&e, vl_render(e.world, &e.camera, e.film, &e.defs->render, NULL, &e.error), "render");
    uint32_t place = frame / (FRAMES / (COLUMNS * ROWS));
    if (frame % (FRAMES / (COLUMNS * ROWS))) continue; /* a program would write the frame, or learn from it */
    vlImage *image = example_develop(&e);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
      uint32_t x = place % COLUMNS * WIDTH + i % WIDTH, y = place / COLUMNS * HEIGHT + i / WIDTH;
      for (uint32_t c = 0; c < 3; c++)
        pixels[3 * (y * COLUMNS * WIDTH + x) + c] = vl_image_get(image, i % WIDTH, i / WIDTH, c);
    }
    vl_image_destroy(image);
  }
  example_must(&e, vl_image_write(sheet, arguments[2], NULL, &e.error), arguments[2]);
  vl_image_destroy(sheet);
  return example_close(&e);
}
