/* test/image/test_denoise.c: tests the denoiser on images with a known ground truth. Pixels
 * without noise do not change, noise is removed, edges that features show are kept, and values
 * that are not finite are replaced. The bits depend neither on the number of threads nor on the
 * instruction set. */
#include "sample_images.h"

#include "velo/denoise.h"

enum { W = 150, H = 61, CHANNELS = 14 };
static const char *const names[CHANNELS] = {"R",
                                            "G",
                                            "B",
                                            "A",
                                            "error.R",
                                            "error.G",
                                            "error.B",
                                            "feature.albedo.R",
                                            "feature.albedo.G",
                                            "feature.albedo.B",
                                            "feature.N.X",
                                            "feature.N.Y",
                                            "feature.N.Z",
                                            "feature.disparity.Y"};

static vlImage *make(vlContext *context, uint32_t channels) {
  vlImageDef def = vl_default_image_def(W, H, channels);
  def.names = names;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  return image;
}
static float *at(vlImage *image, uint32_t x, uint32_t y) {
  return (float *)vl_image_pixels(image) + ((size_t)y * W + x) * vl_image_channels(image);
}

/* The reflectance of a striped texture; the second function gives the light on it. */
static float albedo(uint32_t x, uint32_t y) {
  return (x / 3 + y / 5) % 2 ? 0.6f : 0.4f;
}
static float light(uint32_t x, uint32_t y) {
  return 1.0f + 0.004f * (float)x + 0.01f * (float)y;
}

/* Makes the image of the texture in that light, with noise of standard deviation sigma. */
static vlImage *textured(vlContext *context, float sigma) {
  vlImage *image = make(context, CHANNELS);
  uint32_t seed = 7;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      float *p = at(image, x, y);
      for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int k = 0; k < 12; k++)
          sum += (float)noise(&seed) * 0x1p-24f;
        p[c] = albedo(x, y) * light(x, y) + sigma * (sum - 6.0f);
        p[4 + c] = sigma;
        p[7 + c] = albedo(x, y);
      }
      p[3] = 1.0f;
      p[12] = 1.0f;
      p[13] = 0.25f;
    }
  return image;
}

static vlImage *clean_of(const vlImage *image, vlDenoiseStats *stats) {
  vlImage *clean;
  vlError error;
  if (vl_denoise(image, NULL, &clean, stats, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(vl_image_width(clean), W);
  assert_int_equal(vl_image_height(clean), H);
  return clean;
}

/* Mean squared error of the image against the texture in that light. */
static double squared_error(vlImage *image) {
  double sum = 0;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++)
      for (int c = 0; c < 3; c++) {
        double d = (double)at(image, x, y)[c] - (double)(albedo(x, y) * light(x, y));
        sum += d * d;
      }
  return sum / (3.0 * W * H);
}

static void test_constant_stays(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  /* the second time with standard errors that claim large noise */
  for (int noisy = 0; noisy < 2; noisy++) {
    vlImage *image = make(context, 7);
    for (uint32_t y = 0; y < H; y++)
      for (uint32_t x = 0; x < W; x++) {
        float *p = at(image, x, y);
        p[0] = 0.5f;
        p[1] = 3.0f;
        p[2] = 1e-3f;
        p[3] = 0.75f;
        for (int c = 0; c < 3; c++)
          p[4 + c] = noisy ? 0.4f * p[c] : 0.0f;
      }
    const vlAttribute spp = {
        .name = "samplesPerPixel", .type = VL_ATTRIBUTE_INT, .numbers = {16}};
    assert_int_equal(vl_image_set_attribute(image, &spp), VL_OK);
    vlDenoiseStats stats;
    vlImage *clean = clean_of(image, &stats);
    assert_int_equal(stats.not_finite, 0);
    assert_false(stats.features);
    assert_int_equal(vl_image_channels(clean), 4);
    for (uint32_t y = 0; y < H; y++)
      for (uint32_t x = 0; x < W; x++)
        for (int c = 0; c < 4; c++) {
          double a = at(image, x, y)[c], b = at(clean, x, y)[c];
          if (!(fabs(a - b) <= 1e-5 * a))
            fail_msg("pixel %u, %u, channel %d: %g, not %g", x, y, c, b, a);
        }
    vlAttribute found;
    assert_int_equal(vl_image_find_attribute(clean, "samplesPerPixel", &found), VL_OK);
    vl_image_destroy(image);
    vl_image_destroy(clean);
  }
  end_context(context);
}

/* In an image without noise, edges are kept although no feature shows them. */
static void test_edges_stay(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.0f);
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++)
      memset(at(image, x, y) + 7, 0, 7 * sizeof(float));
  vlImage *clean = clean_of(image, NULL);
  double worst = 0;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++)
      worst = fmax(worst, fabs((double)at(clean, x, y)[0] / (double)at(image, x, y)[0] - 1));
  if (worst > 1e-2)
    fail_msg("largest relative change %g", worst);
  if (squared_error(clean) > 1e-6)
    fail_msg("mean squared error %g", squared_error(clean));
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

/* Noise far above the texture's steps is removed; the texture is kept, because the albedo
 * feature shows it. */
static void test_noise_goes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.3f);
  vlDenoiseStats stats;
  vlImage *clean = clean_of(image, &stats);
  assert_true(stats.features && stats.seconds > 0);
  double before = squared_error(image), after = squared_error(clean);
  if (!(after < before / 20))
    fail_msg("mean squared error %g, was %g", after, before);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

/* The light on an even ground. */
static float ground(uint32_t x, uint32_t y) {
  return 1.0f + 0.001f * (float)(x + y);
}

/* Noise of low frequencies: the means of 8 x 8 pixels of an even ground, over which the light
 * falls off, are nearer to the truth than a window of 15 x 15 pixels can bring them. */
static void test_low_frequencies(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  enum { BLOCK = 8 };
  const float sigma = 0.3f;
  vlImage *image = make(context, CHANNELS);
  uint32_t seed = 11;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      float *p = at(image, x, y);
      for (int c = 0; c < 3; c++) {
        float sum = 0;
        for (int k = 0; k < 12; k++)
          sum += (float)noise(&seed) * 0x1p-24f;
        p[c] = ground(x, y) + sigma * (sum - 6.0f);
        p[4 + c] = sigma;
      }
      p[12] = 1.0f;
      p[13] = 0.25f;
    }
  vlImage *clean = clean_of(image, NULL);
  double squares = 0;
  uint32_t blocks = 0;
  for (uint32_t y = 0; y + BLOCK <= H; y += BLOCK)
    for (uint32_t x = 0; x + BLOCK <= W; x += BLOCK)
      for (int c = 0; c < 3; c++, blocks++) {
        double sum = 0;
        for (uint32_t i = 0; i < BLOCK * BLOCK; i++) {
          uint32_t column = x + i % BLOCK, row = y + i / BLOCK;
          sum += (double)(at(clean, column, row)[c] - ground(column, row));
        }
        squares += sum * sum;
      }
  double error = sqrt(squares / blocks) / (BLOCK * BLOCK);
  if (!(error < 0.05 * (double)sigma))
    fail_msg("error of the means: %g of the pixels'", error / (double)sigma);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

/* The image times a power of two gives the result times it, to the bit. */
static void test_exposure(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.3f), *clean = clean_of(image, NULL);
  static const float factors[] = {0x1p-24f, 0x1p-9f, 0x1p16f};
  for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
    float factor = factors[k];
    vlImage *scaled = textured(context, 0.3f);
    for (uint32_t y = 0; y < H; y++)
      for (uint32_t x = 0; x < W; x++)
        for (int c = 0; c < 3; c++) {
          at(scaled, x, y)[c] *= factor;
          at(scaled, x, y)[4 + c] *= factor;
        }
    vlImage *result = clean_of(scaled, NULL);
    for (uint32_t y = 0; y < H; y++)
      for (uint32_t x = 0; x < W; x++)
        for (int c = 0; c < 3; c++)
          if (at(result, x, y)[c] != factor * at(clean, x, y)[c])
            fail_msg("factor %g, pixel %u, %u: %g, not %g", (double)factor, x, y,
                     (double)at(result, x, y)[c], (double)(factor * at(clean, x, y)[c]));
    vl_image_destroy(scaled);
    vl_image_destroy(result);
  }
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

/* No specks on an even wall whose pixels have few samples with much light, and share them with
 * their neighbours: dark pixels' standard errors are too small. */
static void test_specks(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  enum { SAMPLES = 24, LIT = 4 };
  static float sum[H + 2][W + 2], squares[H + 2][W + 2];
  uint32_t seed = 5;
  for (uint32_t y = 0; y < H + 2; y++)
    for (uint32_t x = 0; x < W + 2; x++) {
      sum[y][x] = squares[y][x] = 0;
      for (int k = 0; k < SAMPLES; k++) {
        float light = noise(&seed) % LIT == 0 ? (float)LIT : 0.0f;
        sum[y][x] += light;
        squares[y][x] += light * light;
      }
    }
  vlImage *image = make(context, CHANNELS);
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      float total = 0, square = 0, weights = 0, weights2 = 0;
      for (uint32_t k = 0; k < 9; k++) {
        float w = (k % 3 == 1 ? 2.0f : 1.0f) * (k / 3 == 1 ? 2.0f : 1.0f) / 16;
        total += w * sum[y + k / 3][x + k % 3];
        square += w * w * squares[y + k / 3][x + k % 3];
        weights += w * SAMPLES;
        weights2 += w * w * SAMPLES;
      }
      float mean = total / weights;
      float variance =
          square / (weights * weights) - mean * mean * weights2 / (weights * weights);
      float *p = at(image, x, y);
      for (int c = 0; c < 3; c++) {
        p[c] = mean;
        p[4 + c] = sqrtf(fmaxf(variance, 0));
        p[7 + c] = 0.5f;
      }
      p[12] = 1.0f;
      p[13] = 0.25f;
    }
  vlImage *clean = clean_of(image, NULL);
  int specks = 0;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++)
      specks += fabsf(at(clean, x, y)[0] - 1.0f) > 0.15f;
  if (specks > 6)
    fail_msg("%d specks", specks);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

/* A pixel that is thousands of times brighter than its neighbours, because of one sample, does
 * not brighten them. */
static void test_outlier(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.05f);
  for (int c = 0; c < 3; c++)
    at(image, 70, 30)[c] = at(image, 70, 30)[4 + c] = 5000.0f;
  vlImage *clean = clean_of(image, NULL);
  for (uint32_t y = 22; y < 39; y++)
    for (uint32_t x = 62; x < 79; x++)
      if (!(at(clean, x, y)[0] < 3.0f))
        fail_msg("pixel %u, %u: %g", x, y, (double)at(clean, x, y)[0]);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  end_context(context);
}

static void test_not_finite(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.01f);
  at(image, 0, 0)[0] = NAN;
  at(image, 149, 60)[1] = INFINITY;
  at(image, 80, 20)[5] = INFINITY; /* the standard error of that pixel */
  for (uint32_t y = 30; y < 36; y++)
    for (uint32_t x = 30; x < 36; x++)
      at(image, x, y)[2] = NAN;
  at(image, 100, 10)[9] = NAN; /* only a feature: the pixel's colour is valid */
  vlDenoiseStats stats;
  vlImage *clean = clean_of(image, &stats);
  assert_int_equal(stats.not_finite, 3 + 36);
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      const float *p = at(image, x, y);
      bool valid = isfinite(p[0] + p[1] + p[2] + p[4] + p[5] + p[6]);
      for (int c = 0; c < 3; c++) {
        float v = at(clean, x, y)[c], truth = albedo(x, y) * light(x, y);
        if (!(fabsf(v - truth) < (valid ? 0.15f : 0.3f)))
          fail_msg("pixel %u, %u: %g, not %g", x, y, (double)v, (double)truth);
      }
    }
  vl_image_destroy(clean);

  for (uint32_t y = 0; y < H; y++) /* with one sample per pixel the standard error is unknown */
    for (uint32_t x = 0; x < W; x++)
      at(image, x, y)[4] = INFINITY;
  vlError error;
  assert_int_equal(vl_denoise(image, NULL, &clean, NULL, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "2 samples"));
  assert_null(clean);
  vl_image_destroy(image);
  end_context(context);
}

static void test_bits(void **state) {
  (void)state;
  static const struct {
    uint32_t threads;
    vlIsa isa;
  } machines[] = {{1, VL_ISA_BASE}, {3, VL_ISA_BASE}, {2, VL_ISA_V3}, {1, VL_ISA_V4}};
  float *first = NULL;
  size_t size = (size_t)W * H * 4 * sizeof(float);
  for (size_t i = 0; i < sizeof machines / sizeof *machines; i++) {
    vlContextDef def = vl_default_context_def();
    def.threads = machines[i].threads;
    def.isa = machines[i].isa;
    vlContext *context;
    if (vl_context_create(&def, &context) != VL_OK)
      continue; /* this machine does not have the instruction set */
    vlImage *image = textured(context, 0.3f), *clean = clean_of(image, NULL);
    if (!first) {
      first = malloc(size);
      memcpy(first, vl_image_pixels(clean), size);
    }
    assert_memory_equal(first, vl_image_pixels(clean), size);
    vl_image_destroy(image);
    vl_image_destroy(clean);
    vl_context_destroy(context);
  }
  free(first);
}

static void test_wrong_arguments(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = textured(context, 0.1f), *short_image = make(context, 6), *clean;
  vlDenoiseDef def = vl_default_denoise_def();
  vlError error;
  assert_int_equal(vl_denoise(NULL, NULL, &clean, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_denoise(image, NULL, NULL, NULL, NULL), VL_ERROR_ARGUMENT);
  def.cookie = 0;
  assert_int_equal(vl_denoise(image, &def, &clean, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_denoise(short_image, NULL, &clean, NULL, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "error.B"));
  def = vl_default_denoise_def();
  def.denoiser = VL_DENOISER_OIDN;
  def.library = "/nowhere/libOpenImageDenoise.so";
  assert_int_equal(vl_denoise(short_image, &def, &clean, NULL, &error), VL_ERROR_MISSING);
  assert_non_null(strstr(error.message, def.library));
  vl_image_destroy(image);
  vl_image_destroy(short_image);
  end_context(context);
}

static vlResult without_memory(vlContext *context, void *user) {
  (void)user;
  vlImageDef def = vl_default_image_def(9, 5, CHANNELS);
  def.names = names;
  vlImage *image = NULL, *clean = NULL;
  vlResult result = vl_image_create(context, &def, &image);
  if (result == VL_OK)
    result = vl_denoise(image, NULL, &clean, NULL, NULL);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  return result;
}
static void test_out_of_memory(void **state) {
  (void)state;
  fail_everywhere(without_memory, NULL, 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_constant_stays), cmocka_unit_test(test_edges_stay),
      cmocka_unit_test(test_noise_goes),     cmocka_unit_test(test_low_frequencies),
      cmocka_unit_test(test_exposure),       cmocka_unit_test(test_specks),
      cmocka_unit_test(test_outlier),        cmocka_unit_test(test_not_finite),
      cmocka_unit_test(test_bits),           cmocka_unit_test(test_wrong_arguments),
      cmocka_unit_test(test_out_of_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
