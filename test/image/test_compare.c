/* test/image/test_compare.c: comparison of images: checks the sums against a plain computation,
 * and FLIP against a direct evaluation of its paper's formulas (two-dimensional kernels, double
 * precision, libm). Also checks properties of FLIP. */
#include "sample_images.h"

#include "image/flip.h"

static vlImage *plain(vlContext *context, uint32_t width, uint32_t height, float r, float g,
                      float b) {
  vlImageDef def = vl_default_image_def(width, height, 3);
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *p = vl_image_pixels(image);
  for (size_t i = 0; i < (size_t)width * height; i++) {
    p[3 * i] = r;
    p[3 * i + 1] = g;
    p[3 * i + 2] = b;
  }
  return image;
}

static vlImageDiff compare(const vlImage *a, const vlImage *b) {
  vlImageDiff diff;
  vlError error;
  if (vl_image_compare(a, b, &diff, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  return diff;
}

static void test_numbers(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *a = plain(context, 10, 10, 0.5f, 0.25f, 1.0f),
          *b = plain(context, 10, 10, 0.75f, 0.25f, 0.5f);
  vlImageDiff d = compare(a, b);
  double mse = (0.0625 + 0.25) / 3.0, rel = (0.0625 / 0.26 + 0.25 / 1.01) / 3.0;
  assert_true(fabs(d.mse - mse) < 1e-12 && fabs(d.rel_mse - rel) < 1e-12);
  assert_true(fabs(d.psnr + 10.0 * log10(mse)) < 1e-9);
  assert_true(d.max_abs == 0.5 && d.differing == 100 && d.not_finite == 0);
  double la = 0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722,
         lb = 0.2126 * 0.75 + 0.7152 * 0.25 + 0.0722 * 0.5;
  assert_true(fabs(d.mean_ratio - lb / la) < 1e-12);
  float *p = vl_image_pixels(b);
  memcpy(p, a->pixels, 300 * sizeof(float));
  p[0] = NAN;
  p[7] = INFINITY;
  p[12] = 0.6f;
  d = compare(a, b);
  assert_int_equal(d.not_finite, 2);
  assert_int_equal(d.differing, 1);
  assert_true(fabs(d.mse - 0.01 / (3.0 * 98.0)) < 1e-8);
  assert_true(isfinite(d.flip) && isfinite(d.mean_ratio));
  vl_image_destroy(b);

  /* Grey against colour compares R = G = B; sizes and missing colours are refused. */
  b = make_image(context, 10, 10, 1, VL_PIXEL_U8, VL_ENCODING_SRGB);
  compare(a, b);
  vl_image_destroy(b);
  b = plain(context, 10, 11, 0, 0, 0);
  vlImageDiff diff;
  vlError error;
  assert_int_equal(vl_image_compare(a, b, &diff, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "10x11"));
  vl_image_destroy(b);
  vl_image_destroy(a);
  end_context(context);
}

static void test_extremes(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *noisy = make_image(context, 40, 30, 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
  vlImageDiff d = compare(noisy, noisy);
  assert_true(d.flip == 0.0 && d.mse == 0.0 && isinf(d.psnr) && d.mean_ratio == 1.0 &&
              d.differing == 0);
  vlImage *black = plain(context, 40, 30, 0, 0, 0), *white = plain(context, 40, 30, 1, 1, 1);
  d = compare(black, white);
  /* HyAB distance 100; only differences of hue are larger */
  assert_true(d.flip > 0.96 && d.flip < 0.98);
  assert_true(isinf(d.mean_ratio) || d.mean_ratio > 1e30);
  vlImage *green = plain(context, 40, 30, 0, 1, 0), *blue = plain(context, 40, 30, 0, 0, 1);
  d = compare(green, blue);
  assert_true(fabs(d.flip - 1.0) < 1e-5); /* FLIP's definition scales this difference to 1 */
  assert_true(compare(blue, green).flip == d.flip);
  vlImageDiff one = compare(noisy, black), other = compare(black, noisy);
  assert_true(fabs(one.flip - other.flip) < 1e-7);
  vl_image_destroy(green);
  vl_image_destroy(blue);
  vl_image_destroy(black);
  vl_image_destroy(white);
  vl_image_destroy(noisy);
  end_context(context);
}

/* ---- the paper's formulas ---------------------------------------------------------------- */

enum { W = 24, H = 18 };
typedef double Plane[H][W];

static double at(Plane p, int x, int y) {
  x = x < 0 ? 0 : x >= W ? W - 1 : x;
  y = y < 0 ? 0 : y >= H ? H - 1 : y;
  return p[y][x];
}

static const double XN = 0.950428545, ZN = 1.088900371;
static void xyz(const double c[3], double o[3]) {
  o[0] = 0.41238656 * c[0] + 0.35759149 * c[1] + 0.18045049 * c[2];
  o[1] = 0.21263682 * c[0] + 0.71518298 * c[1] + 0.07218020 * c[2];
  o[2] = 0.01933062 * c[0] + 0.11919716 * c[1] + 0.95037259 * c[2];
}
static void rgb(const double c[3], double o[3]) {
  double m[3][3], inv[3][3]; /* inverts the matrix of xyz() */
  for (int k = 0; k < 3; k++) {
    double unit[3] = {k == 0, k == 1, k == 2}, column[3];
    xyz(unit, column);
    for (int i = 0; i < 3; i++)
      m[i][k] = column[i];
  }
  double det = 0;
  for (int i = 0; i < 3; i++)
    det += m[0][i] *
           (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      inv[k][i] = (m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] -
                   m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3]) /
                  det;
  for (int i = 0; i < 3; i++)
    o[i] = inv[i][0] * c[0] + inv[i][1] * c[1] + inv[i][2] * c[2];
}
static double f_lab(double t) {
  return t > pow(6.0 / 29.0, 3) ? cbrt(t) : t / (3 * pow(6.0 / 29.0, 2)) + 4.0 / 29.0;
}
static void hunt(const double c[3], double o[3]) {
  double v[3];
  xyz(c, v);
  double x = f_lab(v[0] / XN), y = f_lab(v[1]), z = f_lab(v[2] / ZN), l = 116 * y - 16;
  o[0] = l;
  o[1] = 0.01 * l * 500 * (x - y);
  o[2] = 0.01 * l * 200 * (y - z);
}
static double hyab(const double a[3], const double b[3]) {
  return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

static void filter(Plane in, Plane out, double a1, double b1, double a2, double b2) {
  double ppd = 67.0206, sum = 0, w[41][41];
  int r = (int)ceil(3 * sqrt(0.04 / (2 * M_PI * M_PI)) * ppd);
  for (int y = -r; y <= r; y++)
    for (int x = -r; x <= r; x++) {
      double z = (x * x + y * y) / (ppd * ppd);
      sum += w[y + r][x + r] = a1 * sqrt(M_PI / b1) * exp(-M_PI * M_PI * z / b1) +
                               a2 * sqrt(M_PI / b2) * exp(-M_PI * M_PI * z / b2);
    }
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      out[y][x] = 0;
      for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++)
          out[y][x] += w[j + r][i + r] / sum * at(in, x + i, y + j);
    }
}

static void features(Plane in, int point, Plane out) {
  double sd = 0.5 * 0.082 * 67.0206, w[41][41], plus = 0, minus = 0;
  int r = (int)ceil(3 * sd);
  for (int y = -r; y <= r; y++)
    for (int x = -r; x <= r; x++) {
      double g = exp(-(x * x + y * y) / (2 * sd * sd)),
             v = point ? (x * x / (sd * sd) - 1) * g : -x * g;
      w[y + r][x + r] = v;
      *(v > 0 ? &plus : &minus) += v;
    }
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      double fx = 0, fy = 0;
      for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
          double v = w[j + r][i + r], n = v > 0 ? v / plus : v / -minus, t = w[i + r][j + r],
                 m = t > 0 ? t / plus : t / -minus;
          fx += n * at(in, x + i, y + j);
          fy += m * at(in, x + i, y + j);
        }
      out[y][x] = hypot(fx, fy);
    }
}

static void direct(const float *a, const float *b, double *flip) {
  static Plane ycc[2][3], filtered[2][3], luminance[2], edge[2], point[2];
  for (int k = 0; k < 2; k++) {
    for (int n = 0; n < W * H; n++) {
      const float *p = (k ? b : a) + 3 * n;
      double c[3] = {p[0], p[1], p[2]}, v[3];
      xyz(c, v);
      ycc[k][0][n / W][n % W] = 116 * v[1] - 16;
      ycc[k][1][n / W][n % W] = 500 * (v[0] / XN - v[1]);
      ycc[k][2][n / W][n % W] = 200 * (v[1] - v[2] / ZN);
      luminance[k][n / W][n % W] = v[1];
    }
    filter(ycc[k][0], filtered[k][0], 1, 0.0047, 0, 1e-5);
    filter(ycc[k][1], filtered[k][1], 1, 0.0053, 0, 1e-5);
    filter(ycc[k][2], filtered[k][2], 34.1, 0.04, 13.5, 0.025);
    features(luminance[k], 0, edge[k]);
    features(luminance[k], 1, point[k]);
  }
  const double pure_green[3] = {0, 1, 0}, pure_blue[3] = {0, 0, 1};
  double g[3], u[3];
  hunt(pure_green, g);
  hunt(pure_blue, u);
  double max = pow(hyab(g, u), 0.7), knee = 0.4 * max;
  for (int n = 0; n < W * H; n++) {
    int y = n / W, x = n % W;
    double lab[2][3];
    for (int k = 0; k < 2; k++) {
      double v[3], c[3], luma = (filtered[k][0][y][x] + 16) / 116;
      v[0] = (filtered[k][1][y][x] / 500 + luma) * XN;
      v[1] = luma;
      v[2] = (luma - filtered[k][2][y][x] / 200) * ZN;
      rgb(v, c);
      for (int i = 0; i < 3; i++)
        c[i] = fmin(fmax(c[i], 0), 1);
      hunt(c, lab[k]);
    }
    double d = pow(hyab(lab[0], lab[1]), 0.7);
    d = d < knee ? 0.95 / knee * d : 0.95 + (d - knee) / (max - knee) * 0.05;
    double f = fmax(fabs(edge[0][y][x] - edge[1][y][x]), fabs(point[0][y][x] - point[1][y][x]));
    flip[n] = pow(d, 1 - sqrt(f / sqrt(2)));
  }
}

static void test_direct(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  float a[W * H * 3], b[W * H * 3], got[W * H];
  double want[W * H];
  uint32_t seed = 21;
  for (int kind = 0; kind < 3; kind++) {
    for (int n = 0; n < W * H; n++)
      for (int c = 0; c < 3; c++) {
        float v = (float)noise(&seed) / 16777216.0f;
        a[3 * n + c] = kind == 0 ? v : (float)(n % W) / W; /* noise; a gradient */
        b[3 * n + c] = kind == 0 ? 1.0f - v * v
                       : kind == 1
                           ? a[3 * n + c] * 0.8f +
                                 (n == 200 ? 0.2f : 0.0f) /* darker, with one bright pixel */
                           : (n % W > W / 2 ? (c == 0 ? 1.0f : 0.1f) : a[3 * n + c]);
      }
    assert_int_equal(vl_flip(context, W, H, a, b, got), VL_OK);
    direct(a, b, want);
    double mean = 0;
    for (int n = 0; n < W * H; n++) {
      if (fabs(got[n] - want[n]) > 2e-4)
        fail_msg("kind %d pixel %d: %g, not %g", kind, n, got[n], want[n]);
      mean += want[n] / (W * H);
    }
    assert_true(mean > 0.02 && mean < 0.95);
  }
  end_context(context);
}

static void test_heat(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlImage *a = plain(context, 30, 20, 0, 1, 0), *b = plain(context, 30, 20, 0, 0, 1), *heat;
  vlImageDiff d;
  assert_int_equal(vl_image_compare(a, a, &d, &heat, NULL), VL_OK);
  const uint8_t *p = vl_image_const_pixels(heat);
  assert_true(heat->width == 30 && heat->height == 20 && heat->channels == 3 &&
              heat->type == VL_PIXEL_U8);
  assert_true(p[0] <= 2 && p[1] <= 2 && p[2] <= 5); /* magma begins at black */
  vl_image_destroy(heat);
  assert_int_equal(vl_image_compare(a, b, &d, &heat, NULL), VL_OK);
  p = vl_image_const_pixels(heat);
  /* and ends at (252, 253, 191) */
  assert_true(p[0] >= 248 && p[1] >= 245 && p[2] >= 180 && p[2] <= 196);
  vl_image_destroy(heat);
  vl_image_destroy(a);
  vl_image_destroy(b);
  end_context(context);
}

static void test_small_and_memory(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  static const uint32_t SIZES[][2] = {{1, 1}, {1, 50}, {50, 1}, {3, 2}};
  for (int i = 0; i < 4; i++) {
    vlImage *a =
        make_image(context, SIZES[i][0], SIZES[i][1], 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
    vlImage *b = plain(context, SIZES[i][0], SIZES[i][1], 0.2f, 0.5f, 0.7f);
    vlImageDiff d = compare(a, b);
    assert_true(d.flip > 0.0 && d.flip <= 1.0);
    vl_image_destroy(a);
    vl_image_destroy(b);
  }
  vlImage *a = make_image(context, 9, 9, 3, VL_PIXEL_U8, VL_ENCODING_SRGB);
  long before = failing.blocks;
  vlResult result = VL_ERROR_MEMORY;
  long n = 0;
  for (; result != VL_OK && n < 100; n++) {
    vlImage *heat;
    vlImageDiff d;
    vlError error;
    fail_after(&failing, n);
    result = vl_image_compare(a, a, &d, &heat, &error);
    fail_after(&failing, -1);
    if (result != VL_OK)
      assert_int_equal(result, VL_ERROR_MEMORY);
    vl_image_destroy(heat);
    assert_int_equal(failing.blocks, before);
  }
  assert_in_range(n, 7, 20);
  vl_image_destroy(a);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_numbers),          cmocka_unit_test(test_extremes),
      cmocka_unit_test(test_direct),           cmocka_unit_test(test_heat),
      cmocka_unit_test(test_small_and_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
