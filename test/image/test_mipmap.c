/* test/image/test_mipmap.c: mipmaps: sizes, means, 8-bit storage, encodings, memory. */
#include "sample_images.h"

#include "image/mipmap.h"

static vlMipmap *make(const vlImage *image, uint32_t count) {
  vlMipmapDef def = {.channel = {0, 1, 2, 3}, .count = count};
  vlMipmap *map;
  assert_int_equal(vl_mipmap_create(image, &def, &map), VL_OK);
  return map;
}

/* The mean of a linear image is the same on all levels. */
static void test_means(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const uint32_t SIZES[][2] = {{64, 64}, {64, 16}, {37, 21}, {1, 9},
                                      {100, 1}, {7, 300}, {1, 1}};
  for (int s = 0; s < 7; s++)
    for (uint32_t channels = 1; channels <= 4; channels++) {
      vlImage *image = make_image(context, SIZES[s][0], SIZES[s][1], channels, VL_PIXEL_F32,
                                  VL_ENCODING_LINEAR);
      vlMipmap *map = make(image, channels);
      assert_false(map->is_bytes);
      uint32_t w = SIZES[s][0], h = SIZES[s][1];
      double first[4] = {0};
      for (uint32_t l = 0; l < map->level_count; l++) {
        assert_true(map->levels[l].width == w && map->levels[l].height == h);
        for (uint32_t c = 0; c < channels; c++) {
          double sum = 0.0;
          for (uint32_t y = 0; y < h; y++)
            for (uint32_t x = 0; x < w; x++)
              sum += vl_mip_texel(map, l, x, y, c);
          sum /= (double)w * h;
          if (l == 0)
            first[c] = sum;
          assert_true(fabs(sum - first[c]) < 1e-5 * first[c]);
        }
        if (l + 1 == map->level_count)
          assert_true(w == 1 && h == 1);
        w = w > 1 ? w / 2 : 1;
        h = h > 1 ? h / 2 : 1;
      }
      vl_mipmap_destroy(map);
      vl_image_destroy(image);
    }
  end_context(context);
}

static void test_weights(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImageDef def = vl_default_image_def(5, 1, 1);
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  const float v[5] = {1, 10, 100, 1000, 10000};
  memcpy(vl_image_pixels(image), v, sizeof v);
  vlMipmap *map = make(image, 1);
  assert_int_equal(map->level_count, 3); /* 5, 2, 1 */
  assert_true(fabsf(vl_mip_texel(map, 1, 0, 0, 0) - (1 + 10 + 50) / 2.5f) < 1e-4f);
  assert_true(fabsf(vl_mip_texel(map, 1, 1, 0, 0) - (50 + 1000 + 10000) / 2.5f) < 1e-2f);
  vl_mipmap_destroy(map);
  vl_image_destroy(image);
  end_context(context);
}

static void test_bytes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 32, 24, 4, VL_PIXEL_U8, VL_ENCODING_SRGB);
  vlMipmap *map = make(image, 4);
  assert_true(map->is_bytes);
  assert_memory_equal(map->levels[0].bytes, image->pixels, 32 * 24 * 4);
  assert_true(vl_mipmap_bytes(map) < sizeof *map + 32 * 24 * 4 * 3 / 2);
  /* against means straight from level 0: one rounding, in the code */
  for (uint32_t l = 1; l < map->level_count; l++)
    for (uint32_t y = 0; y < map->levels[l].height; y++)
      for (uint32_t x = 0; x < map->levels[l].width; x++)
        for (uint32_t c = 0; c < 4; c++) {
          double sum = 0.0, area = 0.0, w = 32.0 / map->levels[l].width,
                 h = 24.0 / map->levels[l].height;
          if (w != floor(w) || h != floor(h))
            continue;
          for (uint32_t j = (uint32_t)(y * h); j < (uint32_t)((y + 1) * h); j++)
            for (uint32_t i = (uint32_t)(x * w); i < (uint32_t)((x + 1) * w); i++, area++)
              sum += vl_image_get(image, i, j, c);
          uint8_t code = map->levels[l].bytes[(y * map->levels[l].width + x) * 4 + c];
          double low = code ? map->decode[c][code - 1] : -1.0,
                 high = code < 255 ? map->decode[c][code + 1] : 2.0;
          assert_true(sum / area > low && sum / area < high);
          double middle = 0.5 * (sum / area - map->decode[c][code]);
          assert_true(fabs(middle) <=
                      0.5 * fmax(high - map->decode[c][code], map->decode[c][code] - low));
        }
  vl_mipmap_destroy(map);

  /* Flat images stay flat to the code, on every level, under every encoding. */
  static const vlEncoding ENCODINGS[] = {VL_ENCODING_LINEAR, VL_ENCODING_SRGB,
                                         VL_ENCODING_GAMMA};
  for (int e = 0; e < 3; e++)
    for (int v = 0; v < 256; v += 5) {
      memset(image->pixels, v, 32 * 24 * 4);
      vlMipmapDef def = {.channel = {2, 1},
                         .count = 2,
                         .own_encoding = true,
                         .encoding = ENCODINGS[e],
                         .gamma = 2.2f};
      assert_int_equal(vl_mipmap_create(image, &def, &map), VL_OK);
      for (uint32_t l = 0; l < map->level_count; l++)
        for (uint32_t i = 0; i < map->levels[l].width * map->levels[l].height * 2; i++)
          assert_int_equal(map->levels[l].bytes[i], v);
      double t = v / 255.0, light = e == 0         ? t
                                    : e == 2       ? pow(t, 2.2f)
                                    : t <= 0.04045 ? t / 12.92
                                                   : pow((t + 0.055) / 1.055, 2.4);
      assert_true(fabs(vl_mip_texel(map, 2, 0, 0, 1) - light) < 1e-6);
      vl_mipmap_destroy(map);
    }
  vl_image_destroy(image);

  /* 16 bits under another encoding. */
  image = make_image(context, 8, 8, 1, VL_PIXEL_U16, VL_ENCODING_SRGB);
  vlMipmapDef def = {
      .count = 1, .own_encoding = true, .encoding = VL_ENCODING_LINEAR, .only_finest = true};
  assert_int_equal(vl_mipmap_create(image, &def, &map), VL_OK);
  assert_int_equal(map->level_count, 1);
  assert_true(fabs(vl_mip_texel(map, 0, 3, 7, 0) - ((uint16_t *)image->pixels)[59] / 65535.0) <
              1e-7);
  vl_mipmap_destroy(map);
  def.channel[0] = 1;
  assert_int_equal(vl_mipmap_create(image, &def, &map), VL_ERROR_ARGUMENT);
  assert_null(map);
  vl_image_destroy(image);
  end_context(context);
}

static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  for (int type = 0; type < 2; type++) {
    vlImage *image =
        make_image(context, 20, 30, 3, type ? VL_PIXEL_F32 : VL_PIXEL_U8, VL_ENCODING_SRGB);
    long before = failing.blocks;
    vlResult result = VL_ERROR_MEMORY;
    long n = 0;
    for (; result != VL_OK && n < 100; n++) {
      vlMipmapDef def = {.channel = {0, 1, 2}, .count = 3};
      vlMipmap *map;
      fail_after(&failing, n);
      result = vl_mipmap_create(image, &def, &map);
      fail_after(&failing, -1);
      if (result != VL_OK)
        assert_true(result == VL_ERROR_MEMORY && !map);
      vl_mipmap_destroy(map);
      assert_int_equal(failing.blocks, before);
    }
    assert_in_range(n, 8, 30);
    vl_image_destroy(image);
  }
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_means),
      cmocka_unit_test(test_weights),
      cmocka_unit_test(test_bytes),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
