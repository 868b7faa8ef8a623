/* conformance/saved_skies.h: the law of skies in written scenes: the image of a sky that a glTF
 * file holds as a cube map shines from everywhere as it did. */
#ifndef TEST_CONFORMANCE_SAVED_SKIES_H
#define TEST_CONFORMANCE_SAVED_SKIES_H

#include <jansson.h>

#include "conformance.h"
#include "files.h"
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

/* ---- blurred levels of cube maps --------------------------------------------------------- */

/* The mean radiance of a face, by the solid angles of its texels: RGB over D, which is alpha.
 */
static double radiance_of_face(const char *uri, uint32_t *side) {
  char path[100];
  vlImage *image;
  double sum = 0;
  double all = 0;
  path_of(path, uri);
  assert_int_equal(vl_image_read(context, path, &image, NULL), VL_OK);
  *side = vl_image_width(image);
  for (uint32_t y = 0; y < *side; y++)
    for (uint32_t x = 0; x < *side; x++) {
      const double u = (2 * x + 1.0) / *side - 1;
      const double v = (2 * y + 1.0) / *side - 1;
      const double angle = pow(1 + u * u + v * v, -1.5);
      sum +=
          angle * (double)vl_image_get(image, x, y, 1) / (double)vl_image_get(image, x, y, 3);
      all += angle;
    }
  vl_image_destroy(image);
  return sum / all;
}

/* A sky with one bright place. */
static bool write_glow(const char *name) {
  enum { GLOW_SIDE = 256 };
  static float pixels[3 * GLOW_SIDE * GLOW_SIDE];
  for (int i = 0; i < 3 * GLOW_SIDE * GLOW_SIDE; i++) {
    const double x = i / 3 % GLOW_SIDE - 70;
    const double y = i / (3 * GLOW_SIDE) - 100;
    pixels[i] = (float)(0.2 + exp(-(x * x + y * y) / 1200));
  }
  return write_square(name, GLOW_SIDE, pixels);
}

/* before: another sky, or nothing. Each level has half the side of the one before and sends as
 * much light in all, the face that is brightest first of all, and is more blurred. Returns the
 * first level's side. */
static uint32_t check_levels(const char *before, const char *parameters) {
  static char text[TEXT];
  char path[100];
  snprintf(text, sizeof text, HEAD "WorldBegin %s LightSource \"infinite\" %s Shape \"sphere\"",
           before, parameters);
  vlScene *scene = need_scene(text);
  path_of(path, "levels.gltf");
  assert_int_equal(vl_scene_save(scene, path, NULL, NULL), VL_OK);
  vl_scene_destroy(scene);
  json_t *file = json_load_file(path, 0, NULL);
  const json_t *images = json_object_get(file, "images");
  json_t *lights = NULL;
  assert_int_equal(json_unpack(file, "{s:{s:{s:o}}}", "extensions", "EXT_lights_image_based",
                               "lights", &lights),
                   0);
  const json_t *levels = json_object_get(json_array_get(lights, 0), "specularImages");
  double first = 0;
  double contrast = 1e9; /* of the level before */
  uint32_t first_side = 0;
  size_t first_brightest = 0;
  for (size_t k = 0; k < json_array_size(levels); k++) {
    double sum = 0;
    double max = 0;
    size_t brightest = 0;
    uint32_t side = 0;
    for (size_t face = 0; face < 6; face++) {
      const json_t *index = json_array_get(json_array_get(levels, k), face);
      const json_t *image = json_array_get(images, (size_t)json_integer_value(index));
      const double here =
          radiance_of_face(json_string_value(json_object_get(image, "uri")), &side);
      sum += here / 6;
      brightest = here > max ? face : brightest;
      max = fmax(max, here);
    }
    first = k ? first : sum;
    first_side = k ? first_side : side;
    first_brightest = k ? first_brightest : brightest;
    if (!(max / sum < 0.98 * contrast))
      broken("lights", "infinite", "%s: level %zu is not more blurred than the one before",
             parameters, k);
    contrast = max / sum;
    if (!(fabs(sum - first) < 0.005 * first) || side != first_side >> k ||
        brightest != first_brightest)
      broken("lights", "infinite",
             "%s: level %zu of %u texels a side sends %.4f, most to face %zu, not %.4f, %zu",
             parameters, k, side, sum, brightest, first, first_brightest);
  }
  if (json_array_size(levels) < 3)
    broken("lights", "infinite", "%s: %zu levels", parameters, json_array_size(levels));
  json_decref(file);
  return first_side;
}

static void skies_of_files(void **state) {
  (void)state;
  assert_true(write_glow("glow.pfm"));
  const uint32_t side = check_levels("", "\"string filename\" \"glow.pfm\"");
  check_levels("", "\"string filename\" \"glow.pfm\" \"float illuminance\" 5");
  const uint32_t beside = check_levels(
      "LightSource \"infinite\" \"string filename\" \"quarters.pfm\" \"float scale\" .1",
      "\"string filename\" \"glow.pfm\"");
  if (beside != side)
    broken("lights", "infinite", "%u texels a side after a small sky, not %u", beside, side);
  static const char *const files[] = {"sky.gltf", "sky.pbrt"};
  for (int i = 0; i < 2; i++) {
    check_sky("\"string filename\" \"quarters.pfm\"", files[i]);
    check_sky("\"string filename\" \"quarters.pfm\" \"float scale\" 3", files[i]);
    check_sky("\"string filename\" \"grain.pfm\" \"float illuminance\" 5", files[i]);
  }
  expect_no_failures();
}

#endif
