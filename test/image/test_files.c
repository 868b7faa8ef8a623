/* test/image/test_files.c: round trips through every written format, attributes, determinism,
 * suffixes, write errors, a failure of every allocation, and oiiotool as an independent reader
 * where it is installed. */
#include "sample_images.h"

#include "image/pixel.h"

static vlImage *round_trip(vlContext *context, const vlImage *image, const char *name,
                           const vlWriteDef *def) {
  char path[1024];
  vlError error;
  vlImage *back;
  if (vl_image_write(image, in_folder(name, path), def, &error) != VL_OK)
    fail_msg("%s", error.message);
  if (vl_image_read(context, path, &back, &error) != VL_OK)
    fail_msg("%s", error.message);
  return back;
}

static void test_exr(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const vlPixelType TYPES[] = {VL_PIXEL_F32, VL_PIXEL_F16, VL_PIXEL_U32};
  static const uint32_t SIZES[][2] = {{1, 1}, {37, 21}, {64, 16}, {5, 100}};
  for (int t = 0; t < 3; t++)
    for (int s = 0; s < 4; s++)
      for (uint32_t channels = 1; channels <= 6; channels++)
        for (int compression = 0; compression < 2; compression++) {
          vlImage *image = make_image(context, SIZES[s][0], SIZES[s][1], channels, TYPES[t],
                                      VL_ENCODING_LINEAR);
          vlWriteDef def = vl_default_write_def();
          def.compression = compression;
          vlImage *back = round_trip(context, image, "a.exr", &def);
          assert_true(same_pixels(image, back));
          for (uint32_t c = 0; c < channels; c++)
            assert_string_equal(vl_image_channel_name(image, c),
                                vl_image_channel_name(back, c));
          assert_int_equal(vl_image_attribute_count(back), 0);
          vl_image_destroy(image);
          vl_image_destroy(back);
        }
  end_context(context);
}

static void test_exr_half(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  const char *const names[5] = {"A", "Z", "G", "B", "R"};
  vlImageDef d = vl_default_image_def(40, 9, 5);
  d.names = names;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &d, &image), VL_OK);
  float *p = vl_image_pixels(image);
  for (int i = 0; i < 40 * 9 * 5; i++)
    p[i] = (float)i * 1.37f;
  p[4] = 1e6f; /* too much for a half */
  p[9] = INFINITY;
  vlWriteDef def = vl_default_write_def();
  def.half = true;
  vlImage *back = round_trip(context, image, "half.exr", &def);
  assert_int_equal(back->type, VL_PIXEL_F32); /* Z stays a float, so all are */
  const char *const order[5] = {"R", "G", "B", "A", "Z"};
  for (uint32_t c = 0; c < 5; c++) {
    assert_string_equal(vl_image_channel_name(back, c), order[c]);
    uint32_t from = (uint32_t)vl_image_find_channel(image, order[c]);
    for (uint32_t x = 2; x < 40; x++) {
      float v = vl_image_get(image, x, 3, from), w = vl_image_get(back, x, 3, c);
      assert_true(c == 4 ? v == w : w == vl_half_to_float(vl_float_to_half(v)));
    }
  }
  assert_true(vl_image_get(back, 0, 0, 0) == 65504.0f);
  assert_true(isinf(vl_image_get(back, 1, 0, 0)));
  vl_image_destroy(back);
  vl_image_destroy(image);

  /* eight bits are written as light */
  image = make_image(context, 8, 8, 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
  back = round_trip(context, image, "light.exr", NULL);
  assert_int_equal(back->type, VL_PIXEL_F32);
  for (uint32_t y = 0; y < 8; y++)
    assert_true(vl_image_get(image, 5, y, 1) == vl_image_get(back, 5, y, 1));
  vl_image_destroy(back);
  vl_image_destroy(image);
  end_context(context);
}

static const vlAttribute ATTRIBUTES[] = {
    {.name = "exposureTime", .type = VL_ATTRIBUTE_FLOAT, .numbers = {0.125}},
    {.name = "samples", .type = VL_ATTRIBUTE_INT, .numbers = {-64}},
    {.name = "comments", .type = VL_ATTRIBUTE_STRING, .string = "grüße, \"velo\"\nline"},
    {.name = "empty", .type = VL_ATTRIBUTE_STRING, .string = ""},
    {.name = "multiView", .type = VL_ATTRIBUTE_STRINGS, .string = "left\nright"},
    {.name = "one", .type = VL_ATTRIBUTE_STRINGS, .string = "alone"},
    {.name = "v2", .type = VL_ATTRIBUTE_V2F, .numbers = {1, -2}},
    {.name = "v3", .type = VL_ATTRIBUTE_V3F, .numbers = {1, -2, 0.5}},
    {.name = "m33", .type = VL_ATTRIBUTE_M33F, .numbers = {1, 2, 3, 4, 5, 6, 7, 8, 9}},
    {.name = "worldToCamera",
     .type = VL_ATTRIBUTE_M44F,
     .numbers = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}},
    {.name = "box", .type = VL_ATTRIBUTE_BOX2I, .numbers = {-1, -2, 3, 4}},
    {.name = "chromaticities",
     .type = VL_ATTRIBUTE_CHROMATICITIES,
     .numbers = {0.625, 0.375, 0.25, 0.5, 0.125, 0.0625, 0.3125, 0.25}},
    {.name = "double", .type = VL_ATTRIBUTE_DOUBLE, .numbers = {0.1}},
    {.name = "a name of more than thirty-one characters",
     .type = VL_ATTRIBUTE_M44D,
     .numbers = {0.1, 0.2, 0.3}},
    {.name = "pixelAspectRatio", .type = VL_ATTRIBUTE_FLOAT, .numbers = {2}},
    {.name = "screenWindowCenter", .type = VL_ATTRIBUTE_V2F, .numbers = {0.5, 0.25}},
    {.name = "screenWindowWidth", .type = VL_ATTRIBUTE_FLOAT, .numbers = {0.75}},
    {.name = "dataWindow", .type = VL_ATTRIBUTE_BOX2I, .numbers = {100, -5, 119, 24}},
    {.name = "displayWindow", .type = VL_ATTRIBUTE_BOX2I, .numbers = {0, 0, 639, 479}},
};
enum { ATTRIBUTE_COUNT = sizeof ATTRIBUTES / sizeof *ATTRIBUTES };

static void test_attributes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 20, 30, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR);
  for (int i = 0; i < ATTRIBUTE_COUNT; i++)
    assert_int_equal(vl_image_set_attribute(image, &ATTRIBUTES[i]), VL_OK);
  vlImage *back = round_trip(context, image, "attributes.exr", NULL);
  assert_true(same_pixels(image, back));
  assert_int_equal(vl_image_attribute_count(back), ATTRIBUTE_COUNT);
  for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
    vlAttribute a;
    assert_int_equal(vl_image_find_attribute(back, ATTRIBUTES[i].name, &a), VL_OK);
    assert_int_equal(a.type, ATTRIBUTES[i].type);
    if (a.type == VL_ATTRIBUTE_STRING || a.type == VL_ATTRIBUTE_STRINGS)
      assert_string_equal(a.string, ATTRIBUTES[i].string);
    else
      assert_memory_equal(a.numbers, ATTRIBUTES[i].numbers, sizeof a.numbers);
  }
  vl_image_destroy(back);

  char path[1024];
  vlError error;
  vlAttribute wrong = {.name = "dataWindow",
                       .type = VL_ATTRIBUTE_BOX2I,
                       .numbers = {0, 0, 20, 30}}; /* one too large */
  assert_int_equal(vl_image_set_attribute(image, &wrong), VL_OK);
  assert_int_equal(vl_image_write(image, in_folder("wrong.exr", path), NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "dataWindow"));
  assert_int_equal(access(path, F_OK), -1);
  vl_image_destroy(image);
  end_context(context);
}

static void test_same_bytes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 61, 47, 4, VL_PIXEL_F32, VL_ENCODING_LINEAR);
  static const char *const NAMES[] = {"same.exr", "same.png", "same.jpg",
                                      "same.hdr", "same.pfm", "same.tga"};
  for (int i = 0; i < 6; i++) {
    char path[1024];
    size_t size[2];
    void *bytes[2];
    for (int k = 0; k < 2; k++) {
      assert_int_equal(vl_image_write(image, in_folder(NAMES[i], path), NULL, NULL), VL_OK);
      bytes[k] = slurp(path, &size[k]);
      if (k == 0)
        usleep(20000);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    free(bytes[0]);
    free(bytes[1]);
  }
  vl_image_destroy(image);
  end_context(context);

  /* The bytes of an OpenEXR file do not depend on the number of threads. */
  void *first = NULL;
  size_t first_size = 0;
  for (uint32_t threads = 1; threads <= 8; threads = threads == 1   ? 2
                                                     : threads == 2 ? 3
                                                                    : threads + 5) {
    vlContextDef def = vl_default_context_def();
    def.threads = threads;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    image = make_image(context, 61, 397, 4, VL_PIXEL_F32, VL_ENCODING_LINEAR);
    char path[1024];
    size_t size;
    assert_int_equal(vl_image_write(image, in_folder("threads.exr", path), NULL, NULL), VL_OK);
    void *bytes = slurp(path, &size);
    if (first) {
      assert_int_equal(size, first_size);
      assert_memory_equal(bytes, first, size);
      free(bytes);
    } else {
      first = bytes;
      first_size = size;
    }
    vlImage *back;
    assert_int_equal(vl_image_read(context, path, &back, NULL), VL_OK);
    assert_true(same_pixels(image, back));
    vl_image_destroy(back);
    vl_image_destroy(image);
    vl_context_destroy(context);
  }
  free(first);
}

static void test_integers(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  for (uint32_t channels = 1; channels <= 4; channels++) {
    static const vlEncoding ENCODINGS[] = {VL_ENCODING_SRGB, VL_ENCODING_LINEAR};
    for (int e = 0; e < 2; e++)
      for (int deep = 0; deep < 2; deep++) {
        vlImage *image = make_image(context, 33, 17, channels,
                                    deep ? VL_PIXEL_U16 : VL_PIXEL_U8, ENCODINGS[e]);
        vlImage *back = round_trip(context, image, "a.png", NULL);
        assert_true(same_pixels(image, back));
        assert_int_equal(back->encoding, ENCODINGS[e]);
        vl_image_destroy(back);
        vl_image_destroy(image);
      }
    vlImage *image = make_image(context, 33, 17, channels, VL_PIXEL_U8, VL_ENCODING_SRGB);
    vlImage *back = round_trip(context, image, "a.tga", NULL);
    if (channels == 2)
      assert_int_equal(back->channels, 1); /* no alpha beside grey */
    else
      assert_true(same_pixels(image, back));
    vl_image_destroy(back);
    vl_image_destroy(image);
  }
  /* JPEG: smooth content comes back nearly. */
  vlImage *image = make_image(context, 64, 48, 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
  uint8_t *p = vl_image_pixels(image);
  for (int i = 0; i < 64 * 48 * 3; i++)
    p[i] = (uint8_t)(i / 3 % 64 * 2 + i / 192 + i % 3 * 20);
  vlImage *back = round_trip(context, image, "a.jpg", NULL);
  assert_true(back->width == 64 && back->height == 48 && back->channels == 3 &&
              back->type == VL_PIXEL_U8);
  for (int i = 0; i < 64 * 48 * 3; i++)
    assert_true(abs(p[i] - ((uint8_t *)back->pixels)[i]) <= 4);
  vl_image_destroy(back);
  back = round_trip(context, image, "a.JPEG", NULL);
  vl_image_destroy(back);
  vl_image_destroy(image);
  end_context(context);
}

static void test_floats(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  for (uint32_t channels = 1; channels <= 3; channels += 2) {
    vlImage *image = make_image(context, 33, 17, channels, VL_PIXEL_F32, VL_ENCODING_LINEAR);
    float *p = vl_image_pixels(image);
    p[3] = -1e30f;
    vlImage *back = round_trip(context, image, "a.pfm", NULL);
    assert_true(same_pixels(image, back));
    vl_image_destroy(back);
    p[3] = 1e30f;
    static const uint32_t WIDTHS[] = {33, 7, 1}; /* 7 and less are written flat */
    for (int w = 0; w < 3; w++) {
      image->width = WIDTHS[w];
      back = round_trip(context, image, "a.hdr", NULL);
      assert_int_equal(back->channels, 3);
      for (uint32_t y = 0; y < 17; y++)
        for (uint32_t x = 0; x < WIDTHS[w]; x++) {
          float peak = 0.0f;
          for (uint32_t c = 0; c < channels; c++)
            peak = fmaxf(peak, vl_image_get(image, x, y, c));
          for (uint32_t c = 0; c < 3; c++) {
            float v = vl_image_get(image, x, y, channels == 3 ? c : 0);
            assert_true(fabsf(vl_image_get(back, x, y, c) - v) <= peak / 255.0f);
          }
        }
      vl_image_destroy(back);
    }
    image->width = 33;
    /* Eight bits from floats: sRGB's curve, clamped. */
    static const char *const NAMES[] = {"a.png", "a.tga"};
    p[0] = NAN;
    p[1] = 1e9f;
    p[2] = -3.0f;
    for (int k = 0; k < 2; k++) {
      back = round_trip(context, image, NAMES[k], NULL);
      assert_true(back->type == VL_PIXEL_U8 && back->encoding == VL_ENCODING_SRGB &&
                  back->channels == channels);
      for (size_t i = 0; i < 33u * 17 * channels; i++)
        assert_int_equal(((uint8_t *)back->pixels)[i], vl_linear_to_srgb8(p[i]));
      vl_image_destroy(back);
    }
    vl_image_destroy(image);
  }
  end_context(context);
}

static void test_refusals(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 200, 100, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR), *back;
  char path[1024], target[1100];
  vlError error;
  assert_int_equal(vl_image_write(image, in_folder("a.xyz", path), NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_write(image, in_folder("a", path), NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_write(image, in_folder("a.exe", path), NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, ".exr"));
  vlWriteDef none = {.quality = 95, .compression = 1};
  assert_int_equal(vl_image_write(image, in_folder("a.exr", path), &none, &error),
                   VL_ERROR_ARGUMENT);

  static const char *const SUFFIXES[] = {"exr", "png", "jpg", "hdr", "pfm", "tga"};
  for (int i = 0; i < 6; i++) {
    char name[64];
    snprintf(name, sizeof name, "none/such/a.%s", SUFFIXES[i]);
    assert_int_equal(vl_image_write(image, in_folder(name, path), NULL, &error), VL_ERROR_IO);
    assert_non_null(strstr(error.message, path));
    /* A full disk: a link to the device that never has room. */
    snprintf(name, sizeof name, "full.%s", SUFFIXES[i]);
    in_folder(name, target);
    if (access("/dev/full", W_OK) == 0 && symlink("/dev/full", target) == 0) {
      vlResult result = vl_image_write(image, target, NULL, &error);
      if (result != VL_ERROR_IO)
        fail_msg("%s on a full disk: %d", SUFFIXES[i], result);
      assert_int_equal(error.code, VL_ERROR_IO);
      unlink(target);
    }
  }
  assert_int_equal(vl_image_read(context, in_folder("absent.png", path), &back, &error),
                   VL_ERROR_MISSING);
  assert_null(back);
  assert_int_equal(vl_image_read(context, folder(), &back, &error), VL_ERROR_IO);

  /* Of an image without colours formats that hold nothing else get the first channel, as
   * grey. */
  const char *const names[2] = {"N.X", "Z"};
  vlImageDef def = vl_default_image_def(2, 2, 2);
  def.names = names;
  vlImage *depth;
  assert_int_equal(vl_image_create(context, &def, &depth), VL_OK);
  for (int i = 0; i < 6; i++) {
    char name[64];
    snprintf(name, sizeof name, "depth.%s", SUFFIXES[i]);
    vlResult result = vl_image_write(depth, in_folder(name, path), NULL, &error);
    assert_int_equal(result, VL_OK);
    assert_int_equal(vl_image_read(context, path, &back, &error), VL_OK);
    assert_int_equal(vl_image_width(back), 2);
    vl_image_destroy(back);
    unlink(path);
  }
  vl_image_destroy(depth);
  vl_image_destroy(image);
  end_context(context);
}

/* Each writer and its reader with an allocator that fails at the n-th call. */
static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const char *const NAMES[] = {"m.exr", "m.png", "m.jpg", "m.hdr", "m.pfm", "m.tga"};
  for (int i = 0; i < 6; i++) {
    vlImage *image = make_image(context, 20, 30, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR);
    for (int k = 0; k < ATTRIBUTE_COUNT && i == 0; k++)
      assert_int_equal(vl_image_set_attribute(image, &ATTRIBUTES[k]), VL_OK);
    char path[1024];
    in_folder(NAMES[i], path);
    /* The context keeps the list of unfinished files. */
    assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
    remove(path);
    long before = failing.blocks;
    for (int reading = 0; reading < 2; reading++) {
      vlResult result = VL_ERROR_MEMORY;
      long n = 0;
      for (; result != VL_OK && n < 1000; n++) {
        vlImage *back = NULL;
        vlError error;
        fail_after(&failing, n);
        result = reading ? vl_image_read(context, path, &back, &error)
                         : vl_image_write(image, path, NULL, &error);
        fail_after(&failing, -1);
        if (result != VL_OK) {
          if (result != VL_ERROR_MEMORY)
            fail_msg("%s: %s", NAMES[i], error.message);
          assert_null(back);
          if (!reading)
            assert_int_equal(access(path, F_OK), -1); /* nothing half-written, no temporary */
        }
        vl_image_destroy(back);
        assert_int_equal(failing.blocks, before);
      }
      assert_in_range(n, 2, 999);
    }
    vl_image_destroy(image);
  }
  end_context(context);
}

/* OpenImageIO reads our files alike. */
static void test_other_reader(void **state) {
  (void)state;
  if (system("command -v oiiotool >/dev/null 2>&1") != 0) {
    print_message("oiiotool is not installed: skipped\n");
    skip();
  }
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 40, 30, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR);
  float *p = vl_image_pixels(image);
  for (int i = 0; i < 40 * 30 * 3; i++)
    p[i] = (float)(i % 97) / 64.0f;
  vlAttribute a = {.name = "samples", .type = VL_ATTRIBUTE_INT, .numbers = {64}};
  assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  char ours[1024], pfm[1024], command[4096], line[1024];
  vlWriteDef def = vl_default_write_def();
  assert_int_equal(vl_image_write(image, in_folder("ours.pfm", pfm), NULL, NULL), VL_OK);
  for (int k = 0; k < 4; k++) {
    def.half = k & 1;
    def.compression = k >> 1;
    assert_int_equal(vl_image_write(image, in_folder("ours.exr", ours), &def, NULL), VL_OK);
    snprintf(command, sizeof command,
             "oiiotool '%s' '%s' --fail 0 --warn 0 --diff >/dev/null 2>&1", ours, pfm);
    assert_int_equal(system(command), 0);
  }
  snprintf(command, sizeof command, "oiiotool --info -v '%s' 2>&1", ours);
  FILE *pipe = popen(command, "r");
  assert_non_null(pipe);
  bool found = false;
  while (fgets(line, sizeof line, pipe))
    found |= strstr(line, "samples: 64") != NULL;
  pclose(pipe);
  assert_true(found);
  vl_image_destroy(image);
  end_context(context);
}

/* Whether the bytes contain the text. */
static bool contains(const void *data, size_t size, const char *text, size_t length) {
  for (size_t i = 0; i + length <= size; i++)
    if (memcmp((const char *)data + i, text, length) == 0)
      return true;
  return false;
}

/* PNG, JPEG and TGA hold the attribute "comments"; TGA its first 255 bytes. */
static void test_comments(void **state) {
  (void)state;
  static const char *const formats[] = {".png", ".jpg", ".tga"};
  failAllocator failing;
  vlContext *context = make_context(&failing);
  char text[401];
  for (int k = 0; k < 2; k++) {
    memset(text, 'a', sizeof text - 1);
    text[sizeof text - 1] = 0;
    memcpy(text, k ? "gr\xc3\xbc\xc3\x9f" : "greeting", 6); /* PNG has iTXt for UTF-8 */
    vlImage *image = make_image(context, 5, 4, 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
    for (int i = 0; i < 3; i++) {
      void *plain, *noted;
      size_t plain_size, noted_size;
      vlImage *bare = make_image(context, 5, 4, 3, VL_PIXEL_U8, VL_ENCODING_SRGB), *back;
      const vlAttribute comment = {
          .name = "comments", .type = VL_ATTRIBUTE_STRING, .string = text};
      vlError error;
      assert_int_equal(vl_image_set_attribute(image, &comment), VL_OK);
      assert_int_equal(
          vl_image_write_memory(bare, formats[i], NULL, &plain, &plain_size, &error), VL_OK);
      assert_int_equal(
          vl_image_write_memory(image, formats[i], NULL, &noted, &noted_size, &error), VL_OK);
      assert_false(contains(plain, plain_size, text, 5));
      assert_true(contains(noted, noted_size, text, i == 2 ? 255 : sizeof text - 1));
      assert_false(contains(noted, noted_size, text, i == 2 ? 256 : sizeof text));
      vl_release(context, plain);
      vl_release(context, noted);
      char name[16];
      snprintf(name, sizeof name, "noted%s", formats[i]);
      back = round_trip(context, image, name, NULL);
      assert_int_equal(vl_image_width(back), 5);
      vl_image_destroy(back);
      vl_image_destroy(bare);
    }
    vl_image_destroy(image);
  }
  end_context(context);
}

/* Noise whose chunks hardly become smaller. Some of them are, compressed, as long as they were:
 * readers take bytes of that number for the values themselves. */
static void test_exr_chunks_of_noise(void **state) {
  (void)state;
  enum { WIDTH = 240, HEIGHT = 6400 };
  failAllocator failing;
  vlContext *context = make_context(&failing);
  const vlImageDef def = vl_default_image_def(WIDTH, HEIGHT, 1);
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  uint32_t random = 1;
  for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
    random = random * 1664525u + 1013904223u;
    const float range = 4096.0f + 4096.0f * (float)i / (WIDTH * HEIGHT);
    pixels[i] = 3000.0f + range * (float)(random >> 8) / 16777216.0f;
  }
  vlImage *back = round_trip(context, image, "noise.exr", NULL);
  assert_memory_equal(pixels, vl_image_const_pixels(back), sizeof(float) * WIDTH * HEIGHT);
  vl_image_destroy(back);
  vl_image_destroy(image);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_exr),
      cmocka_unit_test(test_exr_half),
      cmocka_unit_test(test_attributes),
      cmocka_unit_test(test_same_bytes),
      cmocka_unit_test(test_integers),
      cmocka_unit_test(test_floats),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_out_of_memory),
      cmocka_unit_test(test_other_reader),
      cmocka_unit_test(test_comments),
      cmocka_unit_test(test_exr_chunks_of_noise),
  };
  return cmocka_run_group_tests(tests, NULL, remove_folder);
}
