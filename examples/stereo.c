/* stereo: the two eyes of a stereo pair, side by side. Their windows show the same rectangle at the distance of
 * convergence.
 *
 *   stereo SCENE IMAGE
 *   build/release/bin/example_stereo examples/corner.pbrt examples/stereo.jpg
 */
#include "example.h"

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  vlCamera eyes[2];
  vlImage *images[2];
  e.defs->camera.stereo = (vlStereo){.mode = VL_STEREO_OFF_AXIS, .interocular = 0.2, .convergence = 4.5};
  example_build(&e);
  example_must(&e, vl_camera_stereo(&e.defs->camera, &eyes[0], &eyes[1], NULL, &e.error), "camera");
  for (int eye = 0; eye < 2; eye++) {
    vl_film_clear(e.film);
    example_must(&e, vl_render(e.world, &eyes[eye], e.film, &e.defs->render, NULL, &e.error), "render");
    images[eye] = example_develop(&e);
  }
  vlImage *both = example_join(&e, images[0], images[1]);
  example_must(&e, vl_image_write(both, arguments[2], NULL, &e.error), arguments[2]);
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  vl_image_destroy(both);
  return example_close(&e);
}
