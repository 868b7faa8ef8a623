/* test/image/test_corpus.c: the fuzz corpus as a test: every image is read and holds its
 * pattern. The files were made by other programs or byte by byte. Patterns: 8-bit files are (5
 * x + 3 y + 40 c) mod 256 on 13x9 pixels; palettes have its 16 entries at (3 i, i), indexed by
 * (x + 2 y) mod 16; OpenEXR files are ((x (c + 1) + 3 y) mod 64) / 32 on 37x21. */
#include "sample_images.h"

#include <dirent.h>

static uint32_t pattern(uint32_t x, uint32_t y, uint32_t c) {
  return (x * 5 + y * 3 + c * 40) % 256;
}
static uint32_t exact(uint32_t x, uint32_t y, uint32_t c) {
  return pattern(x, y, c);
}
static uint32_t in_fours(uint32_t x, uint32_t y, uint32_t c) {
  return pattern(x / 4 * 4, y, c);
}
static uint32_t palette(uint32_t x, uint32_t y, uint32_t c) {
  uint32_t i = (x + y * 2) % 16;
  return c == 3 ? i == 3 ? 7 : 255 : pattern(i * 3, i, c);
}
static uint32_t palette_in_fours(uint32_t x, uint32_t y, uint32_t c) {
  return palette(x / 4 * 4, y, c);
}
static uint32_t palette_clear(uint32_t x, uint32_t y, uint32_t c) {
  return c == 3 ? (x + y * 2) % 16 == 3 ? 0 : 255 : palette(x, y, c);
}
static uint32_t offset(uint32_t x, uint32_t y, uint32_t c) {
  return x < 2 || y < 3 || x > 14 || y > 11 ? 0 : c == 3 ? 255 : palette(x - 2, y - 3, c);
}
static uint32_t five_bits(uint32_t x, uint32_t y, uint32_t c) {
  return (pattern(x, y, c) >> 3) * 255 / 31;
}
static uint32_t bits565(uint32_t x, uint32_t y, uint32_t c) {
  uint32_t v = pattern(x, y, c), top = c == 1 ? 63 : 31;
  return ((v >> (c == 1 ? 2 : 3)) * 255 + top / 2) / top;
}
static uint32_t one_bit(uint32_t x, uint32_t y, uint32_t c) {
  (void)c;
  return (x + y) % 2 * 255;
}
static uint32_t one_bit_black(uint32_t x, uint32_t y, uint32_t c) {
  return 255 - one_bit(x, y, c);
}
static uint32_t two_bits(uint32_t x, uint32_t y, uint32_t c) {
  (void)c;
  return (x + y) % 4 * 85;
}
static uint32_t qoi(uint32_t x, uint32_t y, uint32_t c) {
  return c == 3 ? pattern(x, y, 3) / 64 * 64 : pattern(x / 2 * 2, y / 2, c);
}
static uint32_t deep(uint32_t x, uint32_t y, uint32_t c) {
  return pattern(x, y, c) * 256 + c;
}
static uint32_t deep_alpha(uint32_t x, uint32_t y, uint32_t c) {
  return c ? pattern(x, y, 2) * 256 + 9 : pattern(x, y, 0) * 256 + pattern(x, y, 1);
}
static uint32_t deep_even(uint32_t x, uint32_t y, uint32_t c) {
  return pattern(x, y, c) * 257;
}

static const struct Integer {
  const char *file;
  uint32_t channels;
  uint32_t (*expect)(uint32_t x, uint32_t y, uint32_t c);
  bool sixteen;
} INTEGERS[] = {
    {"png_interlaced.png", 3, exact, false},
    {"png_palette4.png", 4, palette, false},
    {"png_palette8.png", 3, palette, false},
    {"png_grey1.png", 1, one_bit, false},
    {"png_grey2.png", 1, two_bits, false},
    {"png_greyalpha16.png", 2, deep_alpha, true},
    {"png_rgb16.png", 3, deep, true},
    {"png_linear.png", 3, exact, false},
    {"png_rgba.png", 4, exact, false},
    {"tga_bottom.tga", 3, exact, false},
    {"tga_top.tga", 3, exact, false},
    {"tga_right.tga", 3, exact, false},
    {"tga_32.tga", 4, exact, false},
    {"tga_32_empty_alpha.tga", 3, exact, false},
    {"tga_rle.tga", 3, in_fours, false},
    {"tga_grey.tga", 1, exact, false},
    {"tga_grey_rle.tga", 1, in_fours, false},
    {"tga_palette.tga", 3, palette, false},
    {"tga_palette_rle.tga", 3, palette_in_fours, false},
    {"tga_16.tga", 3, five_bits, false},
    {"bmp_24.bmp", 3, exact, false},
    {"bmp_24_top.bmp", 3, exact, false},
    {"bmp_32.bmp", 3, exact, false},
    {"bmp_4.bmp", 3, palette, false},
    {"bmp_8.bmp", 3, palette, false},
    {"bmp_565.bmp", 3, bits565, false},
    {"pnm_p1.pbm", 1, one_bit_black, false},
    {"pnm_p2.pgm", 1, exact, false},
    {"pnm_p3.ppm", 3, exact, false},
    {"pnm_p4.pbm", 1, one_bit_black, false},
    {"pnm_p5_16.pgm", 1, deep_even, true},
    {"pnm_p6.ppm", 3, exact, false},
    {"gif.gif", 3, palette, false},
    {"gif_interlaced.gif", 3, palette, false},
    {"gif_transparent.gif", 4, palette_clear, false},
    {"gif_offset.gif", 4, offset, false},
    {"qoi_rgb.qoi", 3, qoi, false},
    {"qoi_rgba.qoi", 4, qoi, false},
    {"webp_rgb.webp", 3, exact, false},
    {"webp_rgba.webp", 4, exact, false},
};

static const char *corpus(const char *file) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/test/fuzz/corpus/image/%s", VELO_SOURCE_DIR, file);
  return path;
}

static vlImage *read_ok(vlContext *context, const char *file) {
  vlImage *image;
  vlError error;
  if (vl_image_read(context, corpus(file), &image, &error) != VL_OK)
    fail_msg("%s", error.message);
  return image;
}

static void test_integers(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  for (size_t i = 0; i < sizeof INTEGERS / sizeof *INTEGERS; i++) {
    const struct Integer *t = &INTEGERS[i];
    vlImage *image = read_ok(context, t->file);
    if (image->channels != t->channels ||
        image->type != (t->sixteen ? VL_PIXEL_U16 : VL_PIXEL_U8))
      fail_msg("%s", t->file);
    bool linear = strcmp(t->file, "png_linear.png") == 0;
    assert_int_equal(image->encoding, linear ? VL_ENCODING_LINEAR : VL_ENCODING_SRGB);
    bool screen = t->expect == offset;
    assert_true(image->width == (screen ? 17 : 13) && image->height == (screen ? 14 : 9));
    for (uint32_t y = 0; y < image->height; y++)
      for (uint32_t x = 0; x < image->width; x++)
        for (uint32_t c = 0; c < image->channels; c++) {
          size_t at = ((size_t)y * image->width + x) * image->channels + c;
          uint32_t got =
              t->sixteen ? ((uint16_t *)image->pixels)[at] : ((uint8_t *)image->pixels)[at];
          if (got != t->expect(x, y, c))
            fail_msg("%s: %u at %u,%u,%u, not %u", t->file, got, x, y, c, t->expect(x, y, c));
        }
    vl_image_destroy(image);
  }
  end_context(context);
}

static void test_long_gif(void **state) { /* fills the table of 4096 codes several times */
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = read_ok(context, "gif_full_table.gif");
  uint64_t sum = 0;
  for (size_t i = 0; i < (size_t)image->width * image->height; i++)
    sum += ((uint8_t *)image->pixels)[3 * i];
  assert_int_equal(sum, 1525370);
  vl_image_destroy(image);
  end_context(context);
}

static void test_floats(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const char *const HDR[] = {"hdr_flat.hdr", "hdr_upward.hdr", "hdr_old_runs.hdr"};
  for (int i = 0; i < 3; i++) {
    vlImage *image = read_ok(context, HDR[i]);
    for (uint32_t y = 0; y < 9; y++)
      for (uint32_t x = 0; x < 13; x++)
        for (uint32_t c = 0; c < 3; c++) {
          uint32_t from = i == 2 && x < 12 ? 0 : x;
          double expect = ldexp(pattern(from, y, c) | (c ? 0 : 128), (int)(y % 3) - 8);
          assert_true(vl_image_get(image, x, y, c) == (float)expect);
        }
    vl_image_destroy(image);
  }
  static const char *const PFM[] = {"pfm_big.pfm", "pfm_little.pfm", "pfm_grey.pfm"};
  for (int i = 0; i < 3; i++) {
    vlImage *image = read_ok(context, PFM[i]);
    assert_int_equal(image->channels, i == 2 ? 1 : 3);
    for (uint32_t y = 0; y < 9; y++)
      for (uint32_t x = 0; x < 13; x++)
        for (uint32_t c = 0; c < image->channels; c++)
          assert_true(vl_image_get(image, x, y, c) == (float)(pattern(x, y, c) / 64.0 - 1.0));
    vl_image_destroy(image);
  }
  end_context(context);
}

static void test_jpeg(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const char *const FILES[] = {"jpeg_rgb.jpg", "jpeg_progressive.jpg", "jpeg_grey.jpg",
                                      "jpeg_cmyk.jpg"};
  for (int i = 0; i < 4; i++) {
    vlImage *image = read_ok(context, FILES[i]);
    assert_true(image->width == 29 && image->height == 23 &&
                image->channels == (i == 2 ? 1 : 3));
    double worst = 0.0;
    for (uint32_t y = 0; y < 23; y++)
      for (uint32_t x = 0; x < 29; x++)
        for (uint32_t c = 0; c < image->channels; c++) {
          double expect = x * 4 + y * 2 + c * 30;
          if (i == 3)
            expect = 255 - expect;
          worst =
              fmax(worst,
                   fabs(((uint8_t *)image->pixels)[((size_t)y * 29 + x) * image->channels + c] -
                        expect));
        }
    if (worst > 6.0)
      fail_msg("%s is off by %g", FILES[i], worst);
    vl_image_destroy(image);
  }
  end_context(context);
}

static void test_exr(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const struct {
    const char *file;
    vlPixelType type;
    double tolerance;
  } FILES[] = {
      {"exr_half_none.exr", VL_PIXEL_F16, 0.0},    {"exr_half_rle.exr", VL_PIXEL_F16, 0.0},
      {"exr_half_zips.exr", VL_PIXEL_F16, 0.0},    {"exr_half_zip.exr", VL_PIXEL_F16, 0.0},
      {"exr_half_piz.exr", VL_PIXEL_F16, 0.0},     {"exr_half_pxr24.exr", VL_PIXEL_F16, 0.0},
      {"exr_half_b44.exr", VL_PIXEL_F16, 0.3},     {"exr_half_b44a.exr", VL_PIXEL_F16, 0.3},
      {"exr_float_pxr24.exr", VL_PIXEL_F32, 1e-4}, {"exr_float_piz.exr", VL_PIXEL_F32, 0.0},
      {"exr_tiled_piz.exr", VL_PIXEL_F16, 0.0},    {"exr_tiled_zip.exr", VL_PIXEL_F16, 0.0},
      {"exr_mip.exr", VL_PIXEL_F32, 0.0},          {"exr_window.exr", VL_PIXEL_F16, 0.0},
      {"exr_multipart.exr", VL_PIXEL_F16, 0.0},    {"exr_mixed.exr", VL_PIXEL_F32, 0.0},
      {"exr_attributes.exr", VL_PIXEL_F32, 0.0},   {"exr_half_dwaa.exr", VL_PIXEL_F16, 0.06},
      {"exr_float_dwab.exr", VL_PIXEL_F32, 0.06},  {"exr_tiled_dwaa.exr", VL_PIXEL_F16, 0.06},
  };
  for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++) {
    vlImage *image = read_ok(context, FILES[i].file);
    assert_true(image->width == 37 && image->height == 21 && image->channels == 4);
    if (image->type != FILES[i].type)
      fail_msg("%s", FILES[i].file);
    assert_string_equal(vl_image_channel_name(image, 0), "R");
    assert_string_equal(vl_image_channel_name(image, 3),
                        strcmp(FILES[i].file, "exr_mixed.exr") ? "A" : "Z");
    double worst = 0.0;
    for (uint32_t y = 0; y < 21; y++)
      for (uint32_t x = 0; x < 37; x++)
        for (uint32_t c = 0; c < 4; c++)
          worst = fmax(worst,
                       fabs(vl_image_get(image, x, y, c) - (x * (c + 1) + y * 3) % 64 / 32.0));
    if (worst > FILES[i].tolerance)
      fail_msg("%s is off by %g", FILES[i].file, worst);
    vlAttribute a;
    if (strcmp(FILES[i].file, "exr_window.exr") == 0) {
      assert_int_equal(vl_image_find_attribute(image, "dataWindow", &a), VL_OK);
      assert_true(a.numbers[0] == 5 && a.numbers[1] == -7 && a.numbers[2] == 41 &&
                  a.numbers[3] == 13);
      assert_int_equal(vl_image_find_attribute(image, "displayWindow", &a), VL_OK);
      assert_true(a.numbers[0] == -10 && a.numbers[1] == -20 && a.numbers[2] == 53 &&
                  a.numbers[3] == 43);
    } else {
      assert_int_equal(vl_image_find_attribute(image, "dataWindow", &a), VL_ERROR_MISSING);
    }
    vl_image_destroy(image);
  }
  end_context(context);
}

/* Whatever lies in the corpus: an image or a clear refusal, and nothing left behind. */
static void test_all(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  DIR *directory = opendir(corpus(""));
  assert_non_null(directory);
  int count = 0;
  for (struct dirent *entry; (entry = readdir(directory));) {
    if (entry->d_name[0] == '.')
      continue;
    long before = failing.blocks;
    vlImage *image;
    vlError error;
    vlResult result = vl_image_read(context, corpus(entry->d_name), &image, &error);
    if (result != VL_OK) {
      assert_null(image);
      assert_true(result == VL_ERROR_SCENE || result == VL_ERROR_UNSUPPORTED);
      assert_int_equal(error.code, result);
      assert_non_null(strstr(error.message, entry->d_name));
    }
    vl_image_destroy(image);
    assert_int_equal(failing.blocks, before);
    count++;
  }
  closedir(directory);
  assert_true(count >= 60);
  end_context(context);
}

/* Every reader with an allocator that fails at the n-th call. */
static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  DIR *directory = opendir(corpus(""));
  assert_non_null(directory);
  for (struct dirent *entry; (entry = readdir(directory));) {
    if (entry->d_name[0] == '.')
      continue;
    long before = failing.blocks;
    vlResult result = VL_ERROR_MEMORY;
    long n = 0;
    for (; result == VL_ERROR_MEMORY && n < 300; n++) {
      vlImage *image;
      vlError error;
      fail_after(&failing, n);
      result = vl_image_read(context, corpus(entry->d_name), &image, &error);
      fail_after(&failing, -1);
      if (result != VL_OK && result != VL_ERROR_MEMORY)
        fail_msg("%s: %s", entry->d_name, error.message);
      vl_image_destroy(image);
      assert_int_equal(failing.blocks, before);
    }
    assert_in_range(n, 2, 299);
  }
  closedir(directory);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_integers),      cmocka_unit_test(test_long_gif),
      cmocka_unit_test(test_floats),        cmocka_unit_test(test_jpeg),
      cmocka_unit_test(test_exr),           cmocka_unit_test(test_all),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
