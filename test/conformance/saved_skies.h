/* conformance/saved_skies.h: the law of skies in written scenes: the image of a sky that a glTF
 * file holds as a cube map shines from everywhere as it did. */
#ifndef TEST_CONFORMANCE_SAVED_SKIES_H
#define TEST_CONFORMANCE_SAVED_SKIES_H

#include "conformance.h"
#include "unit.h"
#include "velo/projection.h"

/* All directions around the origin, each block of them the mean over a part of the sphere. */
enum { SKY_WIDTH = 32, SKY_HEIGHT = 16, SKY_BLOCK = 4 };

static vlImage *image_of_sky(vlScene *scene) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->film = vl_default_film_def(SKY_WIDTH, SKY_HEIGHT);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->build.color = VL_COLOR_RGB;
  defs->render.tracer = VL_TRACER_PATH;
  defs->render.spp = 64;
  return need_image(scene, "a sky");
}

static double mean_of_block(const vlImage *image, uint32_t x0, uint32_t y0) {
  double sum = 0;
  for (uint32_t i = 0; i < SKY_BLOCK * SKY_BLOCK; i++)
    sum += (double)vl_image_get(image, x0 + i % SKY_BLOCK, y0 + i / SKY_BLOCK, 1);
  return sum / (SKY_BLOCK * SKY_BLOCK);
}

/* The texels of a cube map are means: its light is blurred by less than a block. */
static void check_sky(const char *parameters, const char *file) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin AttributeBegin Rotate 40 .3 1 .2 LightSource \"infinite\" %s "
           "AttributeEnd Translate 0 0 900 Shape \"sphere\"",
           parameters);
  vlScene *scene = need_scene(text);
  vlCameraDef camera = vl_default_camera_def(SKY_WIDTH, SKY_HEIGHT);
  camera.projection = VL_PROJECTION_EQUIRECTANGULAR;
  vl_scene_defs(scene)->camera = camera; /* the file may hold the scene mirrored, with it */
  vlImage *again = image_of_sky(read_again(scene, file));
  vlImage *image = image_of_sky(scene);
  const double mean = mean_of_green(image);
  double off = 0;
  for (uint32_t y = 0; y < SKY_HEIGHT; y += SKY_BLOCK)
    for (uint32_t x = 0; x < SKY_WIDTH; x += SKY_BLOCK)
      off = fmax(off, fabs(mean_of_block(again, x, y) - mean_of_block(image, x, y)) / mean);
  if (!(off < 0.12))
    broken("lights", "infinite", "%s: in %s a part of the sky is off by %.3f", parameters, file,
           off);
  vl_image_destroy(again);
  vl_image_destroy(image);
}

static void skies_of_files(void **state) {
  (void)state;
  static const char *const files[] = {"sky.gltf", "sky.pbrt"};
  for (int i = 0; i < 2; i++) {
    check_sky("\"string filename\" \"quarters.pfm\"", files[i]);
    check_sky("\"string filename\" \"quarters.pfm\" \"float scale\" 3", files[i]);
    check_sky("\"string filename\" \"grain.pfm\" \"float illuminance\" 5", files[i]);
  }
  expect_no_failures();
}

#endif
