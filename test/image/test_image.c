/* test/image/test_image.c: images in memory: creation, values as linear light, attributes,
 * curves, halves. */
#include "sample_images.h"

#include "base/cookie.h"
#include "color/color.h"
#include "image/pixel.h"

static void test_create(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image;
  vlImageDef def = vl_default_image_def(5, 3, 3);
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  assert_int_equal(vl_image_width(image), 5);
  assert_int_equal(vl_image_height(image), 3);
  assert_int_equal(vl_image_channels(image), 3);
  assert_int_equal(vl_image_type(image), VL_PIXEL_F32);
  assert_int_equal(vl_image_encoding(image), VL_ENCODING_LINEAR);
  assert_string_equal(vl_image_channel_name(image, 2), "B");
  assert_null(vl_image_channel_name(image, 3));
  assert_int_equal(vl_image_find_channel(image, "G"), 1);
  assert_int_equal(vl_image_find_channel(image, "Z"), -1);
  for (uint32_t y = 0; y < 3; y++)
    for (uint32_t x = 0; x < 5; x++)
      assert_true(vl_image_get(image, x, y, 1) == 0.0f);
  vl_image_destroy(image);

  const char *const doubled[2] = {"Z", "Z"}, *const empty[1] = {""},
                    *const null_name[1] = {NULL};
  def = vl_default_image_def(5, 3, 2);
  def.names = doubled;
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  assert_null(image);
  def = vl_default_image_def(5, 3, 1);
  def.names = empty;
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  def.names = null_name;
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  def = vl_default_image_def(0, 3, 1);
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  def = vl_default_image_def(1, 1, 5); /* no default names for five */
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  def = (vlImageDef){.width = 1, .height = 1, .channels = 1}; /* no cookie */
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_ARGUMENT);
  def = vl_default_image_def(0xffffffffu, 0xffffffffu, 4);
  assert_int_equal(vl_image_create(context, &def, &image), VL_ERROR_MEMORY);
  vl_image_destroy(NULL);
  end_context(context);
}

static void test_get(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImageDef def = vl_default_image_def(256, 1, 4);
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  uint8_t *p = vl_image_pixels(image);
  for (int i = 0; i < 256; i++)
    memset(p + 4 * i, i, 4);
  for (int i = 0; i < 256; i++) {
    double v = i / 255.0, light = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    assert_true(fabs(vl_image_get(image, (uint32_t)i, 0, 0) - light) < 1e-7);
    /* alpha has no curve */
    assert_true(fabs(vl_image_get(image, (uint32_t)i, 0, 3) - v) < 1e-7);
  }
  float row[256 * 2];
  vl_image_row_to_float(image, 0, (const uint32_t[]){2, 3}, 2, row);
  for (uint32_t i = 0; i < 256; i++) {
    assert_true(row[2 * i] == vl_image_get(image, i, 0, 2));
    assert_true(row[2 * i + 1] == vl_image_get(image, i, 0, 3));
  }
  vl_image_destroy(image);

  def = vl_default_image_def(2, 1, 1);
  def.type = VL_PIXEL_U16;
  def.encoding = VL_ENCODING_GAMMA;
  def.gamma = 2.2f;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  ((uint16_t *)vl_image_pixels(image))[1] = 32768;
  assert_true(fabs(vl_image_get(image, 1, 0, 0) - pow(32768 / 65535.0, 2.2)) < 1e-7);
  vl_image_destroy(image);
  end_context(context);
}

static void test_color(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  const char *const names[6] = {"Z", "B", "A", "G", "id", "R"};
  vlImageDef def = vl_default_image_def(1, 1, 6);
  def.names = names;
  vlImage *image;
  uint32_t c[4];
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  assert_int_equal(vl_image_color(image, c), 4);
  assert_true(c[0] == 5 && c[1] == 3 && c[2] == 1 && c[3] == 2);
  vl_image_destroy(image);
  def.channels = 2; /* Z, B */
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  assert_int_equal(vl_image_color(image, c), 0);
  vl_image_destroy(image);
  end_context(context);
}

static void test_attributes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 2, 2, 1, VL_PIXEL_F32, VL_ENCODING_LINEAR);
  vlAttribute a = {.name = "one", .type = VL_ATTRIBUTE_FLOAT, .numbers = {1.5}}, b;
  assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  a = (vlAttribute){.name = "text", .type = VL_ATTRIBUTE_STRING, .string = "hello"};
  assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  assert_int_equal(vl_image_attribute_count(image), 2);
  assert_int_equal(vl_image_find_attribute(image, "text", &b), VL_OK);
  assert_string_equal(b.string, "hello");
  a = (vlAttribute){
      .name = "text", .type = VL_ATTRIBUTE_INT, .numbers = {7}}; /* the last one stays */
  assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  assert_int_equal(vl_image_attribute_count(image), 2);
  assert_int_equal(vl_image_attribute(image, 1, &b), VL_OK);
  assert_true(b.type == VL_ATTRIBUTE_INT && b.numbers[0] == 7.0 && !b.string);
  assert_int_equal(vl_image_attribute(image, 2, &b), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_find_attribute(image, "none", &b), VL_ERROR_MISSING);
  a.name = "";
  assert_int_equal(vl_image_set_attribute(image, &a), VL_ERROR_ARGUMENT);
  a = (vlAttribute){.name = "s", .type = VL_ATTRIBUTE_STRING};
  assert_int_equal(vl_image_set_attribute(image, &a), VL_ERROR_ARGUMENT);
  vl_image_destroy(image);
  end_context(context);
}

/* What an image takes can be written: the writer of OpenEXR refuses no attribute. */
static void test_attributes_suit(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  const double large = INT32_MAX / 2, max = large - 1;
  const struct {
    vlAttribute attribute;
    bool suits;
  } rows[] = {
      {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, {1e-6}, NULL}, true},
      {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, {1e6}, NULL}, true},
      {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, {0}, NULL}, false},
      {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, {2e6}, NULL}, false},
      {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, {NAN}, NULL}, false},
      {{"pixelAspectRatio", VL_ATTRIBUTE_DOUBLE, {1}, NULL}, false},
      {{"screenWindowWidth", VL_ATTRIBUTE_FLOAT, {0}, NULL}, true},
      {{"screenWindowWidth", VL_ATTRIBUTE_FLOAT, {-1}, NULL}, false},
      {{"screenWindowCenter", VL_ATTRIBUTE_V2F, {-3, 4}, NULL}, true},
      {{"screenWindowCenter", VL_ATTRIBUTE_V3F, {-3, 4}, NULL}, false},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {5, 6, 5, 6}, NULL}, true},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {-max, -max, max, max}, NULL}, true},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {0, 0, large, 1}, NULL}, false},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {0, -large, 1, 1}, NULL}, false},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {1, 0, 0, 1}, NULL}, false},
      {{"displayWindow", VL_ATTRIBUTE_BOX2I, {0, 1, 1, 0}, NULL}, false},
      {{"dataWindow", VL_ATTRIBUTE_BOX2I, {7, 8, 8, 9}, NULL}, true},
      {{"dataWindow", VL_ATTRIBUTE_BOX2I, {8, 8, 7, 9}, NULL}, false},
      {{"own", VL_ATTRIBUTE_INT, {INT32_MIN}, NULL}, true},
      {{"own", VL_ATTRIBUTE_INT, {2147483648.0}, NULL}, false},
      {{"own", VL_ATTRIBUTE_INT, {NAN}, NULL}, false},
      {{"own", VL_ATTRIBUTE_BOX2I, {3, 3, 1, INT32_MAX}, NULL}, true},
      {{"own", VL_ATTRIBUTE_BOX2I, {0, 0, 0, 2147483648.0}, NULL}, false},
      {{"own", VL_ATTRIBUTE_FLOAT, {1e38}, NULL}, true},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    vlImage *image = make_image(context, 2, 2, 1, VL_PIXEL_F32, VL_ENCODING_LINEAR);
    const vlResult wanted = rows[i].suits ? VL_OK : VL_ERROR_ARGUMENT;
    if (vl_image_set_attribute(image, &rows[i].attribute) != wanted)
      fail_msg("row %zu: %s", i, rows[i].attribute.name);
    void *bytes = NULL;
    size_t size;
    vlError error;
    if (vl_image_write_memory(image, ".exr", NULL, &bytes, &size, &error) != VL_OK)
      fail_msg("row %zu: %s", i, error.message);
    vl_release(context, bytes);
    vl_image_destroy(image);
  }
  end_context(context);
}

static void test_half(void **state) {
  (void)state;
  for (uint32_t h = 0; h < 65536; h++) {
    float f = vl_half_to_float((uint16_t)h);
    uint32_t exponent = h >> 10 & 31, mantissa = h & 1023;
    double expect = exponent == 31 ? mantissa ? NAN : INFINITY
                    : exponent     ? ldexp(1024 + mantissa, (int)exponent - 25)
                                   : ldexp(mantissa, -24);
    if (h & 0x8000)
      expect = -expect;
    if (isnan(expect)) {
      assert_true(isnan(f));
      assert_true((vl_float_to_half(f) & 0x7c00) == 0x7c00 && (vl_float_to_half(f) & 0x3ff));
    } else {
      assert_true(f == (float)expect && !signbit(f) == !signbit(expect));
      assert_int_equal(vl_float_to_half(f), h);
    }
  }
  /* Between two halves: the nearest, ties to even. */
  for (uint32_t h = 0; h < 0x7bff; h++) {
    float low = vl_half_to_float((uint16_t)h), high = vl_half_to_float((uint16_t)(h + 1)),
          middle = 0.5f * (low + high);
    assert_int_equal(vl_float_to_half(middle), h & 1 ? h + 1 : h);
    assert_int_equal(vl_float_to_half(nextafterf(middle, 0.0f)), h);
    assert_int_equal(vl_float_to_half(nextafterf(middle, 1e9f)), h + 1);
  }
  assert_int_equal(vl_float_to_half(65520.0f), 0x7c00);
  assert_int_equal(vl_float_to_half(65519.0f), 0x7bff);
  assert_int_equal(vl_float_to_half(1e30f), 0x7c00);
}

static void test_curves(void **state) {
  (void)state;
  for (int i = 0; i < 256; i++) {
    double v = i / 255.0, light = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    assert_true(fabs(vl_srgb8_to_linear[i] - light) <= 6e-8 * light);
    assert_int_equal(vl_linear_to_srgb8(vl_srgb8_to_linear[i]), i);
    if (i == 0)
      continue;
    assert_int_equal(vl_linear_to_srgb8(vl_srgb8_begin[i]), i);
    assert_int_equal(vl_linear_to_srgb8(nextafterf(vl_srgb8_begin[i], 0.0f)), i - 1);
    v = (i - 0.5) / 255.0;
    light = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    assert_true(fabs(vl_srgb8_begin[i] - light) <= 1.3e-7 * light);
  }
  assert_int_equal(vl_linear_to_srgb8(NAN), 0);
  assert_int_equal(vl_linear_to_srgb8(-INFINITY), 0);
  assert_int_equal(vl_linear_to_srgb8(INFINITY), 255);
  uint32_t seed = 3;
  for (int i = 0; i < 20000; i++) {
    double x = ldexp(1.0 + noise(&seed) / 16777216.0, (int)(noise(&seed) % 600) - 300);
    assert_true(fabs(vl_log2_exact(x) - log2(x)) <= 2e-15 * fmax(1.0, fabs(log2(x))));
    double y = (double)noise(&seed) / 16777216.0 * 40.0 - 20.0;
    assert_true(fabs(vl_exp2_exact(y) / exp2(y) - 1.0) < 4e-15);
    double base = (double)(noise(&seed) + 1) / 16777216.0;
    assert_true(fabs(vl_pow_exact(base, 2.4) / pow(base, 2.4) - 1.0) < 3e-14);
  }
  for (int i = 0; i <= 1000; i++) {
    assert_true(fabs(vl_linear_to_srgb(vl_srgb_to_linear(i / 1000.0)) - i / 1000.0) < 1e-6);
    assert_true(fabs(vl_decode(VL_ENCODING_GAMMA, 2.2f, i / 1000.0) - pow(i / 1000.0, 2.2f)) <
                1e-12);
  }
}

static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlResult result = VL_ERROR_MEMORY;
  long n = 0;
  for (; result != VL_OK; n++) {
    long before = failing.blocks;
    vlImage *image = NULL;
    vlImageDef def = vl_default_image_def(4, 4, 3);
    vlAttribute a = {.name = "text", .type = VL_ATTRIBUTE_STRING, .string = "hello"};
    fail_after(&failing, n);
    result = vl_image_create(context, &def, &image);
    if (result == VL_OK)
      result = vl_image_set_attribute(image, &a);
    if (result != VL_OK && image)
      assert_int_equal(vl_image_attribute_count(image), 0);
    fail_after(&failing, -1);
    vl_image_destroy(image);
    assert_true(result == VL_OK || result == VL_ERROR_MEMORY);
    assert_int_equal(failing.blocks, before);
  }
  assert_in_range(n, 5, 20);
  end_context(context);
}

static void test_rename(void **state) {
  (void)state;
  failAllocator failing = {.fail_at = 0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlImage *image;
  def.threads = 1;
  def.allocator = fail_allocator(&failing);
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlImageDef image_def = vl_default_image_def(2, 2, 3);
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
  assert_int_equal(vl_image_rename_channel(image, 1, "right.G"), VL_OK);
  assert_string_equal(vl_image_channel_name(image, 0), "R");
  assert_string_equal(vl_image_channel_name(image, 1), "right.G");
  assert_int_equal(vl_image_find_channel(image, "B"), 2);
  assert_int_equal(vl_image_rename_channel(image, 1, "right.G"), VL_OK);
  assert_int_equal(vl_image_rename_channel(image, 1, "B"), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_rename_channel(image, 1, ""), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_rename_channel(image, 3, "X"), VL_ERROR_ARGUMENT);
  fail_after(&failing, 0);
  assert_int_equal(vl_image_rename_channel(image, 0, "X"), VL_ERROR_MEMORY);
  assert_string_equal(vl_image_channel_name(image, 0), "R");
  vl_image_destroy(image);
  vl_context_destroy(context);
  assert_int_equal(failing.blocks, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_rename),        cmocka_unit_test(test_create),
      cmocka_unit_test(test_get),           cmocka_unit_test(test_color),
      cmocka_unit_test(test_attributes),    cmocka_unit_test(test_attributes_suit),
      cmocka_unit_test(test_half),          cmocka_unit_test(test_curves),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
