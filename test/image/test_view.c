/* test/image/test_view.c: views: from linear light to display values, against the published
 * formulas computed with libm. */
#include "sample_images.h"

static double srgb(double v) {
  v = v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0;
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

/* Khronos PBR Neutral, as its specification writes it. */
static void neutral(const double in[3], double out[3]) {
  double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
  double x = fmin(in[0], fmin(in[1], in[2])), f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
  double p = fmax(in[0], fmax(in[1], in[2])) - f;
  double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks), g = 1 / (kd * (p - pn) + 1);
  for (int c = 0; c < 3; c++)
    out[c] = p <= ks ? in[c] - f : (in[c] - f) * pn / p * g + pn * (1 - g);
}

static void agx(const double in[3], double out[3]) {
  static const double A[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                 {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                 {0.0423756549057051, 0.0784336, 0.879142973793104}};
  static const double B[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                 {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                 {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
  double v[3];
  for (int i = 0; i < 3; i++) {
    double s = fmax(A[i][0] * in[0] + A[i][1] * in[1] + A[i][2] * in[2], 1e-30);
    double x = fmin(fmax((log2(s) + 12.47393) / 16.499999, 0.0), 1.0);
    v[i] = 15.5 * pow(x, 6) - 40.14 * pow(x, 5) + 31.96 * pow(x, 4) - 6.868 * pow(x, 3) +
           0.4298 * x * x + 0.1191 * x - 0.00232;
  }
  for (int i = 0; i < 3; i++)
    out[i] = B[i][0] * v[0] + B[i][1] * v[1] + B[i][2] * v[2];
}

static void expect(vlView view, const float *light, double exposure, double out[3]) {
  double in[3];
  for (int c = 0; c < 3; c++)
    in[c] = light[c] * exp2(exposure);
  if (view == VL_VIEW_KHRONOS_NEUTRAL || view == VL_VIEW_AGX)
    for (int c = 0; c < 3; c++)
      in[c] = fmax(in[c], 0.0);
  if (view == VL_VIEW_KHRONOS_NEUTRAL) {
    neutral(in, out);
    for (int c = 0; c < 3; c++)
      out[c] = srgb(out[c]);
  } else if (view == VL_VIEW_AGX) {
    agx(in, out);
  } else {
    for (int c = 0; c < 3; c++)
      out[c] = view == VL_VIEW_RAW ? in[c] : srgb(in[c]);
  }
  for (int c = 0; c < 3; c++)
    out[c] = 255.0 * fmin(fmax(out[c], 0.0), 1.0);
}

static void test_formulas(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImageDef def = vl_default_image_def(4096, 1, 3);
  vlImage *image, *seen;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *p = vl_image_pixels(image);
  uint32_t seed = 5;
  for (int i = 0; i < 4096 * 3; i++) {
    double stops = (double)noise(&seed) / 16777216.0 * 24.0 - 14.0;
    p[i] = (float)(i % 50 == 0 ? -0.1 : exp2(stops));
  }
  static const float EXPOSURES[] = {0.0f, 1.5f, -3.0f};
  for (int view = VL_VIEW_STANDARD; view <= VL_VIEW_RAW; view++)
    for (int e = 0; e < 3; e++) {
      uint64_t bad = 77;
      assert_int_equal(vl_image_view(image, (vlView)view, EXPOSURES[e], &bad, &seen), VL_OK);
      assert_int_equal(bad, 0);
      assert_true(seen->type == VL_PIXEL_U8 && seen->encoding == VL_ENCODING_SRGB &&
                  seen->channels == 3);
      const uint8_t *q = vl_image_const_pixels(seen);
      for (int i = 0; i < 4096; i++) {
        double want[3];
        expect((vlView)view, p + 3 * i, EXPOSURES[e], want);
        for (int c = 0; c < 3; c++)
          if (fabs(q[3 * i + c] - want[c]) > 0.502)
            fail_msg("view %d: %d, not %g", view, q[3 * i + c], want[c]);
      }
      vl_image_destroy(seen);
    }
  vl_image_destroy(image);
  end_context(context);
}

static void test_known(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImageDef def = vl_default_image_def(5, 1, 1);
  vlImage *image, *seen;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *p = vl_image_pixels(image);
  const float values[5] = {0.0f, 0.18f, 1.0f, 1000.0f, 0.5f};
  memcpy(p, values, sizeof values);
  static const uint8_t WANT[4][5] = {
      {0, 118, 255, 255, 188}, /* sRGB */
      {0, 104, 230, 255, 180}, /* grey loses 0.04 below the knee; white stays below 1 */
      {0, 0, 0, 255, 0},       /* AgX: see below */
      {0, 46, 255, 255, 128},
  };
  for (int view = 0; view < 4; view++) {
    assert_int_equal(vl_image_view(image, (vlView)view, 0.0f, NULL, &seen), VL_OK);
    assert_int_equal(seen->channels, 1);
    const uint8_t *q = vl_image_const_pixels(seen);
    if (view == VL_VIEW_AGX) { /* monotonous from black to white, middle grey near the middle */
      assert_int_equal(q[0], 0);
      assert_in_range(q[1], 105, 130);
      assert_true(q[1] < q[4] && q[4] < q[2] && q[2] < q[3]);
      assert_in_range(q[3], 250, 255);
    } else if (view == VL_VIEW_KHRONOS_NEUTRAL) {
      double want[3];
      for (int i = 0; i < 5; i++) {
        const float grey[3] = {p[i], p[i], p[i]};
        expect(VL_VIEW_KHRONOS_NEUTRAL, grey, 0.0, want);
        assert_true(fabs(q[i] - want[0]) <= 0.502);
      }
      assert_true(q[2] < 255 && q[3] >= 254);
    } else {
      assert_memory_equal(q, WANT[view], 5);
    }
    vl_image_destroy(seen);
  }
  /* What is not finite is black and counted. */
  p[0] = NAN;
  p[1] = INFINITY;
  p[2] = -INFINITY;
  p[3] = 3e38f; /* finite, and so it stays under any exposure */
  uint64_t bad;
  for (int view = 0; view < 4; view++) {
    assert_int_equal(vl_image_view(image, (vlView)view, 10.0f, &bad, &seen), VL_OK);
    assert_int_equal(bad, 3);
    const uint8_t *q = vl_image_const_pixels(seen);
    assert_true(q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] >= 250);
    vl_image_destroy(seen);
  }
  assert_int_equal(vl_image_view(image, (vlView)9, 0.0f, NULL, &seen), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_view(image, VL_VIEW_AGX, NAN, NULL, &seen), VL_ERROR_ARGUMENT);
  vl_image_destroy(image);
  end_context(context);
}

static void test_out_of_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *image = make_image(context, 4, 4, 3, VL_PIXEL_F16, VL_ENCODING_LINEAR);
  long before = failing.blocks;
  vlResult result = VL_ERROR_MEMORY;
  long n = 0;
  for (; result != VL_OK && n < 100; n++) {
    vlImage *seen;
    fail_after(&failing, n);
    result = vl_image_view(image, VL_VIEW_STANDARD, 0.0f, NULL, &seen);
    fail_after(&failing, -1);
    if (result != VL_OK)
      assert_int_equal(result, VL_ERROR_MEMORY);
    vl_image_destroy(seen);
    assert_int_equal(failing.blocks, before);
  }
  assert_in_range(n, 3, 20);
  vl_image_destroy(image);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_formulas),
      cmocka_unit_test(test_known),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
