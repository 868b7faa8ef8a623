/* test/image/test_layers.c: several images in one OpenEXR file, each with its own type, and
 * single channels read from it. */

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "failing_allocator.h"
#include "unit.h"
#include "velo/image.h"

static const char file[] = VELO_BINARY_DIR "/test_layers.exr";

typedef struct Layers {
  vlContext *context;
  vlImage *color, *depth, *ids;
} Layers;

static vlImage *make(vlContext *context, uint32_t width, const char *const *names,
                     uint32_t count, vlPixelType type) {
  vlImageDef def = vl_default_image_def(width, 5, count);
  def.names = names;
  def.type = type;
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  return image;
}

static Layers open_layers(const vlAllocator *allocator) {
  static const char *const depth[] = {"Z", "albedo.R"}, *const ids[] = {"id.object",
                                                                        "id.material"};
  Layers l = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  if (allocator)
    def.allocator = *allocator;
  assert_int_equal(vl_context_create(&def, &l.context), VL_OK);
  l.color = make(l.context, 37, NULL, 4, VL_PIXEL_F32);
  l.depth = make(l.context, 37, depth, 2, VL_PIXEL_F32);
  l.ids = make(l.context, 37, ids, 2, VL_PIXEL_U32);
  for (uint32_t i = 0; i < 37 * 5; i++) {
    for (uint32_t c = 0; c < 4; c++)
      ((float *)vl_image_pixels(l.color))[4 * i + c] = (float)(i + c) / 3.0f;
    for (uint32_t c = 0; c < 2; c++)
      ((float *)vl_image_pixels(l.depth))[2 * i + c] = 1000.1f + (float)(i + c) / 7.0f;
    for (uint32_t c = 0; c < 2; c++)
      ((uint32_t *)vl_image_pixels(l.ids))[2 * i + c] = (1u << 24) + 1 + i * 4097 + c;
  }
  return l;
}

static void close_layers(Layers *l) {
  vl_image_destroy(l->color);
  vl_image_destroy(l->depth);
  vl_image_destroy(l->ids);
  assert_int_equal(vl_context_memory(l->context, NULL), 0);
  vl_context_destroy(l->context);
  unlink(file);
}

static void write_layers(const Layers *l, bool half) {
  const vlImage *images[] = {l->color, l->depth, l->ids};
  vlWriteDef write = vl_default_write_def();
  write.half = half;
  vlError error;
  if (vl_image_write_layers(images, 3, file, &write, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static void expect_equal(const vlImage *a, const vlImage *b) {
  assert_int_equal(vl_image_type(a), vl_image_type(b));
  assert_int_equal(vl_image_channels(a), vl_image_channels(b));
  assert_memory_equal(vl_image_const_pixels(a), vl_image_const_pixels(b),
                      (size_t)37 * 5 * vl_image_channels(a) * 4);
}

/* Names are asked for in another order than the file's; ids above 2^24 come back whole. */
static void test_round_trip(void **state) {
  (void)state;
  Layers l = open_layers(NULL);
  write_layers(&l, false);
  static const char *const rgba[] = {"A", "R", "G", "B"}, *const depth[] = {"albedo.R", "Z"};
  static const char *const ids[] = {"id.object", "id.material"}, *const lone[] = {
                                                                     "id.material"};
  vlImage *image = NULL;
  vlError error;
  assert_int_equal(vl_image_read_channels(l.context, file, rgba, 4, &image, &error), VL_OK);
  expect_equal(l.color, image);
  vl_image_destroy(image);
  assert_int_equal(vl_image_read_channels(l.context, file, depth, 2, &image, &error), VL_OK);
  expect_equal(l.depth, image);
  vl_image_destroy(image);
  assert_int_equal(vl_image_read_channels(l.context, file, lone, 1, &image, &error), VL_OK);
  assert_int_equal(vl_image_type(image), VL_PIXEL_U32);
  for (uint32_t i = 0; i < 37 * 5; i++)
    assert_int_equal(((const uint32_t *)vl_image_const_pixels(image))[i],
                     ((const uint32_t *)vl_image_const_pixels(l.ids))[2 * i + 1]);
  vl_image_destroy(image);
  assert_int_equal(vl_image_read_channels(l.context, file, ids, 2, &image, &error), VL_OK);
  int object = vl_image_find_channel(image, "id.object");
  for (uint32_t i = 0; i < 37 * 5; i++)
    assert_int_equal(((const uint32_t *)vl_image_const_pixels(image))[2 * i + (uint32_t)object],
                     ((const uint32_t *)vl_image_const_pixels(l.ids))[2 * i]);
  vl_image_destroy(image);
  close_layers(&l);
}

/* Read as a whole, the image has floats and remembers the types of the file. `half` applies
 * only to the first layer. */
static void test_stored_types(void **state) {
  (void)state;
  Layers l = open_layers(NULL);
  write_layers(&l, true);
  vlImage *image = NULL;
  assert_int_equal(vl_image_read(l.context, file, &image, NULL), VL_OK);
  assert_int_equal(vl_image_type(image), VL_PIXEL_F32);
  assert_int_equal(vl_image_channels(image), 8);
  for (uint32_t i = 0; i < 8; i++) {
    const char *name = vl_image_channel_name(image, i);
    vlPixelType expected = name[1] == 0 && name[0] != 'Z' ? VL_PIXEL_F16
                           : name[0] == 'i'               ? VL_PIXEL_U32
                                                          : VL_PIXEL_F32;
    assert_int_equal(vl_image_stored_type(image, i), expected);
  }
  int z = vl_image_find_channel(image, "Z");
  assert_true(vl_image_get(image, 0, 0, (uint32_t)z) == 1000.1f);
  assert_int_equal(vl_image_stored_type(l.ids, 0), VL_PIXEL_U32);
  vl_image_destroy(image);
  close_layers(&l);
}

static void test_refused(void **state) {
  (void)state;
  Layers l = open_layers(NULL);
  vlImage *wide = make(l.context, 38, (const char *const[]){"W"}, 1, VL_PIXEL_F32),
          *image = NULL;
  const vlImage *sizes[] = {l.color, wide}, *twice[] = {l.color, l.depth, l.depth},
                *good[] = {l.color, l.ids};
  const vlImage *hole[] = {l.color, NULL};
  vlError error;
  assert_int_equal(vl_image_write_layers(sizes, 2, file, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "38x5"));
  assert_int_equal(vl_image_write_layers(twice, 3, file, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "\"Z\""));
  assert_int_equal(vl_image_write_layers(hole, 2, file, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_write_layers(good, 0, file, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_write_layers(good, 2, "layers.png", NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, ".exr"));
  assert_int_not_equal(access(file, F_OK), 0);
  write_layers(&l, false);
  const char *names[] = {"Z", "depth"};
  assert_int_equal(vl_image_read_channels(l.context, file, names, 2, &image, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "\"depth\""));
  assert_null(image);
  assert_int_equal(vl_image_read_channels(l.context, file, names + 1, 1, &image, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "\"depth\""));
  assert_int_equal(vl_image_read_channels(l.context, file, names, 0, &image, &error),
                   VL_ERROR_ARGUMENT);
  vl_image_destroy(wide);
  close_layers(&l);
}

static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator allocator = {.fail_at = 0};
  vlAllocator fails = fail_allocator(&allocator);
  Layers l = open_layers(&fails);
  const vlImage *images[] = {l.color, l.depth, l.ids};
  const char *names[] = {"id.object"};
  for (int reading = 0; reading < 2; reading++) {
    bool done = false;
    for (long n = 1; !done && n < 1000; n++) {
      vlImage *image = NULL;
      atomic_store(&allocator.refused, false);
      allocator.fail_at = atomic_load(&allocator.calls) + n;
      vlResult result = reading
                            ? vl_image_read_channels(l.context, file, names, 1, &image, NULL)
                            : vl_image_write_layers(images, 3, file, NULL, NULL);
      allocator.fail_at = 0;
      done = !atomic_load(&allocator.refused);
      assert_int_equal(result, done ? VL_OK : VL_ERROR_MEMORY);
      vl_image_destroy(image);
    }
    assert_true(done);
  }
  close_layers(&l);
  assert_int_equal(atomic_load(&allocator.blocks), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trip),
      cmocka_unit_test(test_stored_types),
      cmocka_unit_test(test_refused),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
