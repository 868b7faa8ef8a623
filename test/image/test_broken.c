/* test/image/test_broken.c: damaged image files: cut off at every byte, with changed bytes,
 * with sizes larger than their data. Each is rejected clearly (or gives an image, when the
 * damage cannot be detected), in little time and memory. */
#include "sample_images.h"

#include <dirent.h>
#include <zlib.h>

static const char *corpus(const char *file) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/test/fuzz/corpus/image/%s", VELO_SOURCE_DIR, file);
  return path;
}

/* From a block of exactly its size, so that a sanitizer sees a read past the end. The one zero
 * byte after it is promised. */
static vlResult read_bytes(vlContext *context, const void *data, size_t size, vlImage **image,
                           vlError *error) {
  char *exact = malloc(size + 1);
  memcpy(exact, data, size);
  exact[size] = 0;
  vlResult result = vl_image_read_memory(context, "file", exact, size, image, error);
  free(exact);
  if (result != VL_OK) {
    assert_null(*image);
    if (result != VL_ERROR_SCENE && result != VL_ERROR_UNSUPPORTED)
      fail_msg("%d: %s", result, error->message);
    assert_int_equal(error->code, result);
    assert_int_equal(strncmp(error->message, "file: ", 6), 0);
  }
  return result;
}

static void test_cut(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const char *const FILES[] = {
      "png_interlaced.png", "png_palette4.png", "tga_rle.tga",          "tga_bottom.tga",
      "bmp_4.bmp",          "bmp_24.bmp",       "gif_interlaced.gif",   "qoi_rgba.qoi",
      "pnm_p6.ppm",         "hdr_flat.hdr",     "pfm_big.pfm",          "exr_half_zip.exr",
      "exr_tiled_piz.exr",  "jpeg_rgb.jpg",     "jpeg_progressive.jpg", "webp_rgb.webp",
      "webp_lossy.webp"};
  for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++) {
    size_t size;
    uint8_t *data = slurp(corpus(FILES[i]), &size);
    size_t step = size > 1500 ? 7 : 1;
    for (size_t cut = 0; cut < size; cut += step) {
      vlImage *image;
      vlError error;
      long before = failing.blocks;
      /* Only what comes after the last pixel may be missing: a PNG's or JPEG's end mark, QOI's
       * padding, a GIF's end. */
      if (read_bytes(context, data, cut, &image, &error) == VL_OK && cut + 24 < size)
        fail_msg("%s cut to %zu", FILES[i], cut);
      vl_image_destroy(image);
      assert_int_equal(failing.blocks, before);
    }
    free(data);
  }
  end_context(context);
}

static void test_damaged(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  DIR *directory = opendir(corpus(""));
  assert_non_null(directory);
  uint32_t seed = 11;
  for (struct dirent *entry; (entry = readdir(directory));) {
    if (entry->d_name[0] == '.')
      continue;
    size_t size;
    uint8_t *data = slurp(corpus(entry->d_name), &size), *work = malloc(size);
    for (int i = 0; i < 60; i++) {
      memcpy(work, data, size);
      size_t head = size < 400 ? size : 400;
      for (uint32_t k = 0; k < 1 + noise(&seed) % 4; k++)
        work[noise(&seed) % (noise(&seed) % 2 ? head : size)] =
            (uint8_t)(noise(&seed) % 3 ? noise(&seed) : 255);
      vlImage *image;
      vlError error;
      read_bytes(context, work, size, &image, &error);
      vl_image_destroy(image);
    }
    free(data);
    free(work);
  }
  closedir(directory);
  size_t peak;
  vl_context_memory(context, &peak);
  assert_true(peak < 256u << 20);
  end_context(context);
}

/* ---- promises ---------------------------------------------------------------------------- */

static void put_be32(uint8_t *p, uint32_t v) {
  p[0] = (uint8_t)(v >> 24);
  p[1] = (uint8_t)(v >> 16);
  p[2] = (uint8_t)(v >> 8);
  p[3] = (uint8_t)v;
}

static void expect_promise(vlContext *context, const char *what, const void *data,
                           size_t size) {
  vlImage *image;
  vlError error;
  size_t peak_before, peak;
  vl_context_memory(context, &peak_before);
  vlResult result = read_bytes(context, data, size, &image, &error);
  vl_context_memory(context, &peak);
  if (result != VL_ERROR_SCENE || !strstr(error.message, "promises"))
    fail_msg("%s: %s", what, result ? error.message : "read");
  if (peak > peak_before + 1000000)
    fail_msg("%s: took %zu bytes", what, peak);
}

static void test_promises(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  size_t size;
  uint8_t *d = slurp(corpus("png_rgba.png"), &size);
  for (int k = 0; k < 3; k++) {
    put_be32(d + 16, k == 1 ? 1 : 60000);
    put_be32(d + 20, k == 0 ? 1u << 20 : 0x7fffffff);
    put_be32(d + 29, (uint32_t)crc32(0, d + 12, 17));
    expect_promise(context, "png", d, size);
  }
  free(d);
  d = slurp(corpus("tga_top.tga"), &size);
  d[12] = d[13] = d[14] = d[15] = 0xff;
  expect_promise(context, "tga", d, size);
  d[2] = 10;
  expect_promise(context, "tga with runs", d, size);
  free(d);
  d = slurp(corpus("bmp_24.bmp"), &size);
  memset(d + 18, 0x7f, 4);
  memset(d + 22, 0x7f, 4);
  expect_promise(context, "bmp", d, size);
  free(d);
  d = slurp(corpus("gif.gif"), &size);
  memset(d + 6, 0xff, 4);
  expect_promise(context, "gif", d, size);
  free(d);
  d = slurp(corpus("qoi_rgb.qoi"), &size);
  memset(d + 4, 0xff, 8);
  expect_promise(context, "qoi", d, size);
  free(d);
  d = slurp(corpus("jpeg_rgb.jpg"), &size);
  for (size_t i = 0; i + 9 < size; i++) {
    if (d[i] != 0xff || d[i + 1] != 0xc0)
      continue;
    memset(d + i + 5, 0xfe, 4);
    break;
  }
  expect_promise(context, "jpeg", d, size);
  free(d);
  expect_promise(context, "pfm", "PF\n100000 100000\n-1.0\n123456789", 31);
  expect_promise(context, "pnm", "P6\n2000000000 2000000000 255\n123456789", 38);
  expect_promise(context, "pnm text", "P3\n2000000000 2000000000 255\n1 2 3 4 5", 38);
  const char *hdr =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n\x02\x02\x12\x34";
  expect_promise(context, "hdr", hdr, strlen(hdr));
  d = slurp(corpus("exr_half_zip.exr"), &size);
  for (size_t i = 0; i + 40 < size; i++) {
    if (memcmp(d + i, "dataWindow\0box2i", 17) != 0)
      continue;
    d[i + 21 + 10] = d[i + 21 + 14] = 0x10; /* maxima gain 2^20 */
    break;
  }
  expect_promise(context, "exr", d, size);
  free(d);
  end_context(context);
}

/* A bomb of honest deflate is let through only in proportion. */
static void test_ratio(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const uint8_t head[] =
      "\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\x13\x88\0\0\x13\x88\x08\0\0\0\0";
  size_t raw = 5001u * 5000u;
  uint8_t *zeros = calloc(raw, 1), *file = calloc(100000, 1);
  memcpy(file, head, 29);
  put_be32(file + 29, (uint32_t)crc32(0, file + 12, 17));
  uLongf packed = 90000;
  assert_int_equal(compress2(file + 41, &packed, zeros, raw, 9), Z_OK);
  put_be32(file + 33, (uint32_t)packed);
  memcpy(file + 37, "IDAT", 4);
  put_be32(file + 41 + packed, (uint32_t)crc32(0, file + 37, (uInt)packed + 4));
  vlImage *image;
  vlError error;
  /* 25 MB from 24 kB: it is all there */
  assert_int_equal(read_bytes(context, file, 45 + packed, &image, &error), VL_OK);
  assert_int_equal(image->width, 5000);
  vl_image_destroy(image);
  free(zeros);
  free(file);
  end_context(context);
}

static void test_not_images(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image;
  vlError error;
  static const char *const TEXTS[] = {"",
                                      "x",
                                      "hello, world, this is no image at all",
                                      "<html></html>",
                                      "\x89PNG\r\n\x1a\n",
                                      "P6",
                                      "BM",
                                      "GIF89a",
                                      "qoif",
                                      "#?RADIANCE\n",
                                      "\xff\xd8\xff",
                                      "v/1\x01",
                                      "PF\n",
                                      "P1 \n",
                                      "RIFF....WEBPVP8L...."};
  for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++)
    assert_int_equal(read_bytes(context, TEXTS[i], strlen(TEXTS[i]), &image, &error),
                     VL_ERROR_SCENE);
  end_context(context);
}

/* ---- OpenEXR files made byte by byte ----------------------------------------------------- */

typedef struct Bytes {
  uint8_t data[4096];
  size_t size;
} Bytes;

static void add(Bytes *b, const void *data, size_t size) {
  memcpy(b->data + b->size, data, size);
  b->size += size;
}
static void add_int(Bytes *b, int32_t v) {
  add(b, &v, 4);
}
static void add_attribute(Bytes *b, const char *name, const char *type, const void *data,
                          int32_t size) {
  add(b, name, strlen(name) + 1);
  add(b, type, strlen(type) + 1);
  add_int(b, size);
  add(b, data, (size_t)size);
}

/* Uncompressed, 3x2 pixels: channels Z (float) and id (uint, sampled every `sampling`
 * pixels). */
static void make_exr(Bytes *b, int32_t sampling, int32_t version) {
  b->size = 0;
  add(b, "\x76\x2f\x31\x01", 4);
  add_int(b, version);
  Bytes list = {.size = 0};
  add(&list, "Z", 2);
  const int32_t z[4] = {2, 0, 1, 1}, id[4] = {0, 0, sampling, sampling};
  add(&list, z, 16);
  add(&list, "id", 3);
  add(&list, id, 16);
  add(&list, "", 1);
  add_attribute(b, "channels", "chlist", list.data, (int32_t)list.size);
  add_attribute(b, "compression", "compression", "\0", 1);
  /* OpenEXR wants it to suit the sampling */
  const int32_t whole[4] = {-1, 5, 1, 6}, even[4] = {-2, 6, 1, 7};
  const int32_t *window = sampling == 1 ? whole : even;
  add_attribute(b, "dataWindow", "box2i", window, 16);
  add_attribute(b, "displayWindow", "box2i", window, 16);
  add_attribute(b, "lineOrder", "lineOrder", "\0", 1);
  const float one = 1.0f, zero[2] = {0.0f, 0.0f};
  add_attribute(b, "pixelAspectRatio", "float", &one, 4);
  add_attribute(b, "screenWindowCenter", "v2f", zero, 8);
  add_attribute(b, "screenWindowWidth", "float", &one, 4);
  add(b, "", 1);
  uint64_t at = b->size + 16, line = 8 + 24;
  add(b, &at, 8);
  at += line;
  add(b, &at, 8);
  for (int32_t y = 0; y < 2; y++) {
    add_int(b, 5 + y);
    add_int(b, 24);
    for (int32_t x = 0; x < 3; x++) {
      float depth = (float)(x + 10 * y) + 0.5f;
      add(b, &depth, 4);
    }
    for (int32_t x = 0; x < 3; x++)
      add_int(b, 1000 * y + x);
  }
}

static void test_made_exr(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image;
  vlError error;
  Bytes b;
  make_exr(&b, 1, 2);
  assert_int_equal(read_bytes(context, b.data, b.size, &image, &error), VL_OK);
  assert_true(image->type == VL_PIXEL_F32 && image->width == 3 && image->height == 2 &&
              image->channels == 2);
  assert_string_equal(vl_image_channel_name(image, 0), "Z");
  for (uint32_t y = 0; y < 2; y++)
    for (uint32_t x = 0; x < 3; x++) {
      assert_true(vl_image_get(image, x, y, 0) == (float)(x + 10 * y) + 0.5f);
      assert_true(vl_image_get(image, x, y, 1) == (float)(1000 * y + x));
    }
  vlAttribute a;
  assert_int_equal(vl_image_find_attribute(image, "dataWindow", &a), VL_OK);
  assert_true(a.numbers[0] == -1 && a.numbers[3] == 6);
  vl_image_destroy(image);
  make_exr(&b, 2, 2);
  assert_int_equal(read_bytes(context, b.data, b.size, &image, &error), VL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "subsampled"));
  make_exr(&b, 1, 2 | 0x800); /* deep */
  assert_true(read_bytes(context, b.data, b.size, &image, &error) != VL_OK);
  end_context(context);
}

/* Old run lengths may be chained: 1 1 1 n, then 1 1 1 m counts m times 256 more. */
static void test_made_hdr(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image;
  vlError error;
  static const char head[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 600\n";
  static const uint8_t pixels[] = {10, 20, 30, 128, 1, 1, 1, 87, 1, 1, 1, 2};
  uint8_t file[128];
  memcpy(file, head, sizeof head - 1);
  memcpy(file + sizeof head - 1, pixels, sizeof pixels); /* 1 + 87 + 512 pixels */
  assert_int_equal(read_bytes(context, file, sizeof head - 1 + sizeof pixels, &image, &error),
                   VL_OK);
  for (uint32_t x = 0; x < 600; x++)
    assert_true(vl_image_get(image, x, 0, 2) == 30.0f / 256.0f);
  vl_image_destroy(image);
  file[sizeof head - 1 + 7] = 88; /* one too many */
  assert_int_equal(read_bytes(context, file, sizeof head - 1 + sizeof pixels, &image, &error),
                   VL_ERROR_SCENE);
  end_context(context);
}

/* The library must not write to the terminal, whatever it is fed. */
static void test_silent(void **state) {
  (void)state;
  char path[1024];
  in_folder("output", path);
  fflush(stdout);
  fflush(stderr);
  int out = dup(1), err = dup(2);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  dup2(fileno(file), 1);
  dup2(fileno(file), 2);
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const char *const FILES[] = {"exr_half_zip.exr", "exr_tiled_zip.exr", "png_rgba.png",
                                      "jpeg_progressive.jpg", "jpeg_rgb.jpg"};
  for (int i = 0; i < 5; i++) {
    size_t size;
    uint8_t *data = slurp(corpus(FILES[i]), &size);
    for (size_t at = 4; at < size; at += 3) {
      vlImage *image;
      vlError error;
      uint8_t old = data[at];
      data[at] = (uint8_t)~old;
      vl_image_read_memory(context, "file", data, at % 2 ? size : at, &image, &error);
      vl_image_destroy(image);
      data[at] = old;
    }
    free(data);
  }
  end_context(context);
  fflush(stdout);
  fflush(stderr);
  dup2(out, 1);
  dup2(err, 2);
  close(out);
  close(err);
  long written = ftell(file);
  fseek(file, 0, SEEK_END);
  written = ftell(file);
  fclose(file);
  assert_int_equal(written, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_cut),        cmocka_unit_test(test_damaged),
      cmocka_unit_test(test_promises),   cmocka_unit_test(test_ratio),
      cmocka_unit_test(test_not_images), cmocka_unit_test(test_made_exr),
      cmocka_unit_test(test_made_hdr),   cmocka_unit_test(test_silent),
  };
  return cmocka_run_group_tests(tests, NULL, remove_folder);
}
