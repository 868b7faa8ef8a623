/* test/image/sample_images.h: helpers of the image tests: counting contexts, directories, test
 * patterns. */
#ifndef TEST_IMAGE_SAMPLE_IMAGES_H
#define TEST_IMAGE_SAMPLE_IMAGES_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "failing_allocator.h"
#include "image/image.h"
#include "unit.h"

static inline vlContext *make_context(failAllocator *failing) {
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  *failing = (failAllocator){0};
  def.allocator = fail_allocator(failing);
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}
static inline void end_context(vlContext *context) {
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* A directory of this process. */
static inline const char *folder(void) {
  static char path[512];
  if (!path[0]) {
    snprintf(path, sizeof path, "%s/image_test_XXXXXX", VELO_BINARY_DIR);
    assert_non_null(mkdtemp(path));
  }
  return path;
}
static inline char *in_folder(const char *name, char result[1024]) {
  snprintf(result, 1024, "%s/%s", folder(), name);
  return result;
}
static inline int remove_folder(void **state) {
  (void)state;
  char command[600];
  snprintf(command, sizeof command, "rm -rf '%s'", folder());
  return system(command);
}

static inline void *slurp(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  *size = (size_t)ftell(f);
  rewind(f);
  uint8_t *data = malloc(*size + 1);
  assert_int_equal(fread(data, 1, *size, f), *size);
  data[*size] = 0;
  fclose(f);
  return data;
}
static inline void spit(const char *path, const void *data, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
}

static inline uint32_t noise(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return *state >> 8;
}

/* An image of the type with flat parts, ramps and noise. */
static inline vlImage *make_image(vlContext *context, uint32_t width, uint32_t height,
                                  uint32_t channels, vlPixelType type, vlEncoding encoding) {
  vlImageDef def = vl_default_image_def(width, height, channels);
  static const char *const NAMES[6] = {"R", "G", "B", "A", "Z", "id"};
  if (channels > 4)
    def.names = NAMES;
  def.type = type;
  def.encoding = encoding;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  uint32_t seed = 7;
  for (size_t i = 0; i < (size_t)width * height * channels; i++) {
    size_t pixel = i / channels, x = pixel % width, y = pixel / width;
    uint32_t v = y < height / 3       ? 100u
                 : y < 2 * height / 3 ? (uint32_t)(x * 5 + i % channels * 40)
                                      : noise(&seed);
    switch (type) {
      case VL_PIXEL_U8:
        ((uint8_t *)image->pixels)[i] = (uint8_t)v;
        break;
      case VL_PIXEL_U16:
        ((uint16_t *)image->pixels)[i] = (uint16_t)(v * 257u);
        break;
      case VL_PIXEL_F16:
        ((uint16_t *)image->pixels)[i] = (uint16_t)(v % 0x7c00u);
        break;
      case VL_PIXEL_U32:
        ((uint32_t *)image->pixels)[i] = v * 4294967u;
        break;
      case VL_PIXEL_F32:
        ((float *)image->pixels)[i] = (float)(v % 4096u) / 1024.0f;
        break;
    }
  }
  return image;
}

static inline bool same_pixels(const vlImage *a, const vlImage *b) {
  return a->width == b->width && a->height == b->height && a->channels == b->channels &&
         a->type == b->type &&
         memcmp(a->pixels, b->pixels, vl_image_row_size(a) * a->height) == 0;
}

#endif
