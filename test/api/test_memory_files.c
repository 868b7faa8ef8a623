/* test/api/test_memory_files.c: scenes and images in memory give the same as files; coarse
 * images. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "api/small_world.h"
#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"

static vlContext *make_context(void) {
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  return context;
}

static void end(vlContext *context) {
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

static vlImage *gradient(vlContext *context, vlPixelType type) {
  vlImageDef def = vl_default_image_def(33, 17, 3);
  def.type = type;
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  for (uint32_t i = 0; i < 33 * 17 * 3; i++) {
    if (type == VL_PIXEL_U8)
      ((uint8_t *)vl_image_pixels(image))[i] = (uint8_t)(i * 7);
    else
      ((float *)vl_image_pixels(image))[i] = (float)i / 100.0f;
  }
  return image;
}

static void *read_whole(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  void *data = malloc(1 << 20);
  *size = fread(data, 1, 1 << 20, file);
  fclose(file);
  return data;
}

/* The bytes of the file and of the memory are equal, and are decoded to the same pixels. */
static void images_in_memory(void **state) {
  (void)state;
  static const char *const suffixes[] = {".png", ".exr", ".jpg", ".hdr", ".pfm", ".tga"};
  vlContext *context = make_context();
  vlError error;
  for (int i = 0; i < 6; i++) {
    vlImage *image = gradient(context, i == 0 || i == 5 ? VL_PIXEL_U8 : VL_PIXEL_F32),
            *a = NULL, *b = NULL;
    char path[512];
    snprintf(path, sizeof path, "%s/velo_memory_%ld%s",
             getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp", (long)getpid(), suffixes[i]);
    assert_int_equal(vl_image_write(image, path, NULL, &error), VL_OK);
    void *data = NULL;
    size_t size = 0, file_size;
    assert_int_equal(vl_image_write_memory(image, suffixes[i], NULL, &data, &size, &error),
                     VL_OK);
    void *file = read_whole(path, &file_size);
    assert_int_equal(size, file_size);
    assert_memory_equal(data, file, size);
    assert_int_equal(vl_image_read(context, path, &a, &error), VL_OK);
    assert_int_equal(vl_image_read_memory(context, "x", data, size, &b, &error), VL_OK);
    assert_int_equal(vl_image_type(a), vl_image_type(b));
    assert_memory_equal(vl_image_const_pixels(a), vl_image_const_pixels(b), 33 * 17 * 3);
    vlImage *half = image;
    assert_int_equal(vl_image_read_memory(context, "x", data, size / 2, &half, &error),
                     VL_ERROR_SCENE);
    assert_null(half);
    unlink(path);
    free(file);
    vl_release(context, data);
    vl_image_destroy(a);
    vl_image_destroy(b);
    vl_image_destroy(image);
  }
  vlImage *image = gradient(context, VL_PIXEL_U8);
  void *data = &error;
  size_t size = 1;
  assert_int_equal(vl_image_write_memory(image, ".pgn", NULL, &data, &size, &error),
                   VL_ERROR_ARGUMENT);
  assert_null(data);
  assert_int_equal(size, 0);
  vl_image_destroy(image);
  end(context);
}

static void scenes_in_memory(void **state) {
  (void)state;
  vlContext *context = make_context();
  static const char text[] =
      "Film \"rgb\" \"integer xresolution\" [ 8 ] \"integer yresolution\" [ 8 ]\n"
      "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\nShape \"disk\"\n";
  vlScene *scene = NULL;
  vlError error;
  vlSceneInfo info;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  assert_int_equal(vl_scene_load_memory(scene, "a.pbrt", text, sizeof text - 1, NULL, &error),
                   VL_OK);
  vl_scene_info(scene, &info);
  assert_int_equal(info.shapes, 2);
  assert_int_equal(vl_scene_defs(scene)->film.width, 8);
  vl_scene_destroy(scene);
  static const char broken[] = "WorldBegin\n  Shape \"spere\"\n";
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  assert_int_equal(
      vl_scene_load_memory(scene, "dir/b.pbrt", broken, sizeof broken - 1, NULL, &error),
      VL_ERROR_SCENE);
  assert_string_equal(error.file, "dir/b.pbrt");
  assert_int_equal(error.line, 2);
  vl_scene_destroy(scene);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  assert_int_equal(vl_scene_load_memory(scene, NULL, text, 1, NULL, &error), VL_ERROR_ARGUMENT);
  vl_scene_destroy(scene);
  end(context);
}

/* Renders the small world with a camera; the mean of each block of factor x factor pixels, 3
 * channels. */
static vlImage *shoot(vlContext *context, const vlWorld *world, const vlCamera *camera,
                      const vlFilmDef *def, uint32_t spp) {
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlRenderDef render = vl_default_render_def();
  render.spp = spp;
  assert_int_equal(vl_film_create(context, def, &film), VL_OK);
  assert_int_equal(vl_render(world, camera, film, &render, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
  vl_film_destroy(film);
  return image;
}

/* Each pixel of the coarse image is the mean of the pixels that it covers (box filter; noise is
 * left). */
static void coarse_images(void **state) {
  (void)state;
  vlContext *context = make_context();
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlCamera camera, coarse;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  small_scene(scene);
  assert_int_equal(vl_world_build(scene, NULL, &world, NULL), VL_OK);
  vl_scene_destroy(scene);
  assert_int_equal(small_camera(&camera), VL_OK);
  assert_int_equal(vl_camera_coarse(&camera, 0, &coarse), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_coarse(&camera, 65, &coarse), VL_ERROR_ARGUMENT);
  vlFilmDef fine_def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  fine_def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  vlImage *fine = shoot(context, world, &camera, &fine_def, 256);
  const float *f = vl_image_const_pixels(fine);
  for (uint32_t factor = 2; factor <= 8; factor *= 2) {
    assert_int_equal(vl_camera_coarse(&camera, factor, &coarse), VL_OK);
    vlFilmDef def = vl_coarse_film_def(&fine_def, factor);
    assert_int_equal(def.width, coarse.width);
    assert_int_equal(def.height, coarse.height);
    vlImage *image = shoot(context, world, &coarse, &def, 1024);
    const float *c = vl_image_const_pixels(image);
    double difference = 0, sum = 0;
    for (uint32_t y = 0; y < SMALL_HEIGHT / factor; y++) /* whole blocks */
      for (uint32_t x = 0; x < SMALL_WIDTH / factor; x++)
        for (uint32_t k = 0; k < 3; k++) {
          double mean = 0;
          for (uint32_t j = 0; j < factor * factor; j++)
            mean += (double)
                f[4 * ((y * factor + j / factor) * SMALL_WIDTH + x * factor + j % factor) + k];
          mean /= factor * factor;
          difference += fabs(mean - (double)c[4 * (y * def.width + x) + k]);
          sum += mean;
        }
    /* a shift by half a coarse pixel gives 0.2 and more */
    assert_true(difference < 0.06 * sum);
    vl_image_destroy(image);
  }
  vl_image_destroy(fine);
  const uint32_t crop[4] = {3, 9, 17, 30}, want[4] = {0, 1, 3, 4};
  memcpy(fine_def.crop, crop, sizeof crop);
  vlFilmDef def = vl_coarse_film_def(&fine_def, 8);
  assert_memory_equal(def.crop, want, sizeof want);
  vl_world_destroy(world);
  end(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(images_in_memory),
      cmocka_unit_test(scenes_in_memory),
      cmocka_unit_test(coarse_images),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
