/* test/color/test_kernels.c: colour kernels: the same bits on every instruction set and as the
 * inline functions; wavelengths follow their density; an image of a constant spectrum has the
 * exact colour. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "color/kernels.h"
#include "unit.h"

enum { N = 1000, PAD = VL_PAD(N) };

typedef struct batch {
  float u[PAD], r[PAD], g[PAD], b[PAD];
  float lambda[4][PAD], inv_pdf[4][PAD], out[4][PAD];
} batch;

static uint32_t seed = 1;
static float uniform(void) {
  seed = seed * 747796405u + 2891336453u;
  uint32_t word = ((seed >> ((seed >> 28) + 4)) ^ seed) * 277803737u;
  return (float)((word >> 22 ^ word) >> 8) * 0x1p-24f;
}

/* The density at a wavelength, 1 / nm; 0 outside of 360 to 830 nm. */
static float visible_pdf(float lambda) {
  const float *k = vl_visible_knots;
  int i = 0;
  while (i < VL_VISIBLE_KNOTS - 2 && lambda >= k[4 * i + 5])
    i++;
  float pdf = k[4 * i + 2] + 0.5f * k[4 * i + 3] * (lambda - k[4 * i + 1]);
  return lambda < 360.0f || lambda > 830.0f ? 0.0f : pdf;
}

#define ROWS(a) \
  { a[0], a[1], a[2], a[3] }

/* All kernels one after another; results go into all[] for comparison. */
enum { RESULTS = 19 };
static float all[3][RESULTS][PAD];
static batch input;

static void run(const vlColorKernels *k, float (*result)[PAD]) {
  static batch x;
  x = input;
  float *lambda[4] = ROWS(x.lambda), *inv_pdf[4] = ROWS(x.inv_pdf);
  const float *l[4] = ROWS(x.lambda), *p[4] = ROWS(x.inv_pdf), *o[4] = ROWS(x.out);
  int at = 0;
#define KEEP(a) memcpy(result[at++], a, sizeof x.u)
#define KEEP4(a) KEEP(a[0]), KEEP(a[1]), KEEP(a[2]), KEEP(a[3])
  k->uniform_wavelengths(400, 300, N, x.u, lambda, inv_pdf);
  KEEP4(x.lambda);
  KEEP4(x.inv_pdf);
  k->visible_wavelengths(N, x.u, lambda, inv_pdf);
  KEEP4(x.lambda);
  KEEP4(x.inv_pdf);
  float m[9];
  vl_rgb_from_xyz(VL_SPACE_SRGB, m);
  k->rgb_from_radiance(vl_cie_xyz0, m, N, o, l, p, x.r, x.g, x.b);
  KEEP(x.r);
  KEEP(x.g);
  KEEP(x.b);
  assert_int_equal(at, RESULTS);
}

static void fill(void) {
  for (int i = 0; i < PAD; i++) {
    input.u[i] = uniform();
    for (int c = 0; c < 4; c++)
      input.out[c][i] = uniform();
  }
  input.u[0] = 0;
  input.u[1] = 0x1.fffffep-1f;
}

static void test_bits(void **state) {
  (void)state;
  fill();
  vlIsa best = vl_isa_best();
  run(vl_color_kernels(VL_ISA_BASE), all[0]);
  for (int isa = VL_ISA_V3; isa <= (int)best; isa++) {
    run(vl_color_kernels((vlIsa)isa), all[1]);
    for (int i = 0; i < RESULTS; i++) {
      if (memcmp(all[0][i], all[1][i], sizeof all[0][i]) != 0)
        fail_msg("set v%d: result %d differs", isa, i);
    }
  }
}

/* Each wavelength is compared with that of the inline function in the header, which other code
 * uses. */
static void test_inline(void **state) {
  (void)state;
  fill();
  run(vl_color_kernels(vl_isa_best()), all[0]);
  float(*x)[PAD] = all[0];
  for (int i = 0; i < N; i++)
    for (int c = 0; c < 4; c++) {
      float lambda = x[8 + c][i], v = input.u[i] + 0.25f * (float)c, inv_pdf;
      v = v >= 1 ? v - 1 : v;
      assert_true(x[c][i] == 400 + 300 * v && x[4 + c][i] == 300);
      assert_true(lambda >= 360 && lambda <= 830);
      assert_true(lambda == vl_visible_lambda(v, &inv_pdf) && x[12 + c][i] == inv_pdf);
      assert_float_equal(x[12 + c][i] * visible_pdf(lambda), 1.0, 2e-4);
    }
}

static void test_dense(void **state) {
  (void)state;
  float dense[VL_LAMBDA_COUNT];
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    dense[i] = uniform();
  assert_true(vl_dense_at(dense, 359.9f) == 0 && vl_dense_at(dense, 830.1f) == 0);
  assert_true(vl_dense_at(dense, 830) == dense[470] && vl_dense_at(dense, 360) == dense[0]);
}

/* The share of wavelengths below l is the integral of the density up to l. */
static void test_density(void **state) {
  (void)state;
  double sum = 0;
  for (int i = 0; i < 4700; i++) {
    float pdf = visible_pdf(360.05f + 0.1f * (float)i);
    assert_true(pdf > 2.3e-4f); /* narrow spectral lines get no extreme weights */
    sum += (double)pdf * 0.1;
  }
  assert_float_equal(sum, 1.0, 1e-5);
  assert_true(visible_pdf(359.9f) == 0 && visible_pdf(830.1f) == 0);
  sum = 0;
  int at = 0;
  float inv_pdf;
  for (int i = 0; i < 1000; i++) {
    double l = (double)vl_visible_lambda((float)(i + 1) / 1001.0f, &inv_pdf);
    for (; 360.05 + 0.1 * at < l; at++)
      sum += (double)visible_pdf(360.05f + 0.1f * (float)at) * 0.1;
    assert_float_equal(sum, (i + 1) / 1001.0, 4e-4);
  }
  assert_true(vl_visible_lambda(0, &inv_pdf) == 360 &&
              vl_visible_lambda(0x1.fffffep-1f, &inv_pdf) > 829.9f);
  for (int k = 0; k + 1 < VL_VISIBLE_KNOTS; k++) { /* no jump between two segments */
    const float *row = vl_visible_knots + 4 * k;
    float before = row[4] - 0x1p-24f;
    assert_float_equal(vl_visible_lambda(before, &inv_pdf), row[5], 1e-3);
    assert_float_equal(inv_pdf * row[6], 1.0, 1e-3);
    assert_float_equal(row[4] - row[0], (row[2] + row[6]) / 2 * (row[5] - row[1]), 1e-6);
  }
}

/* Random wavelengths in intervals of 10 nm against the density, by chi^2: each of the four has
 * it. */
static void test_samples(void **state) {
  (void)state;
  enum { BINS = 47, ROUNDS = 100 };
  static batch x;
  float *lambda[4] = ROWS(x.lambda), *inv_pdf[4] = ROWS(x.inv_pdf);
  double count[4][BINS] = {{0}};
  for (int round = 0; round < ROUNDS; round++) {
    for (int i = 0; i < PAD; i++)
      x.u[i] = uniform();
    vl_color_kernels(vl_isa_best())->visible_wavelengths(PAD, x.u, lambda, inv_pdf);
    for (int c = 0; c < 4; c++)
      for (int i = 0; i < PAD; i++)
        count[c][(int)fminf((lambda[c][i] - 360) / 10, BINS - 1)]++;
  }
  for (int c = 0; c < 4; c++) {
    double chi2 = 0;
    for (int b = 0; b < BINS; b++) {
      double expected = 0;
      for (int i = 0; i < 100; i++)
        expected += (double)visible_pdf(360.05f + 10 * (float)b + 0.1f * (float)i) * 0.1;
      expected *= (double)PAD * ROUNDS;
      chi2 += (count[c][b] - expected) * (count[c][b] - expected) / expected;
    }
    assert_true(chi2 < 90); /* 46 degrees of freedom: exceeded with probability 1e-4 */
  }
}

/* The density of the pbrt book 4.5.4 (Radziszewski et al. 2009), for comparison. */
static float luminance_lambda(float u, float *inv_pdf) {
  float t = 0.85691062f - 1.82750197f * u;
  *inv_pdf = 253.819720f / (1 - t * t);
  return 538 - 138.888889f * atanhf(t);
}

/* Variance of one sample's linear sRGB, relative to the squared mean, as the mean over R, G, B:
 * a reflectance under daylight, seen at four rotated wavelengths. */
static double colour_noise(float (*sample)(float, float *), const float reflectance[3]) {
  enum { STEPS = 4096 };
  static batch x;
  const vlColorKernels *k = vl_color_kernels(vl_isa_best());
  const float *l[4] = ROWS(x.lambda), *p[4] = ROWS(x.inv_pdf), *o[4] = ROWS(x.out);
  float m[9], *rgb[3] = {x.r, x.g, x.b};
  const float *light = vl_space_illuminant(VL_SPACE_SRGB);
  vlSigmoid s = vl_rgb_table_lookup(vl_rgb_table(VL_SPACE_SRGB), reflectance[0], reflectance[1],
                                    reflectance[2]);
  vl_rgb_from_xyz(VL_SPACE_SRGB, m);
  double sum[3] = {0}, squares[3] = {0}, noise = 0;
  for (int first = 0; first < STEPS; first += PAD) {
    int n = STEPS - first < PAD ? STEPS - first : PAD;
    for (int i = 0; i < PAD; i++)
      for (int c = 0; c < 4; c++) {
        const float u = ((float)(first + i) + 0.5f) / STEPS + 0.25f * (float)c;
        const float lambda = x.lambda[c][i] = sample((float)fmod(u, 1), &x.inv_pdf[c][i]);
        x.out[c][i] = vl_sigmoid(s, lambda) * vl_dense_at(light, lambda);
      }
    k->rgb_from_radiance(vl_cie_xyz0, m, PAD, o, l, p, x.r, x.g, x.b);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < n; i++) {
        sum[c] += (double)rgb[c][i];
        squares[c] += (double)rgb[c][i] * (double)rgb[c][i];
      }
  }
  for (int c = 0; c < 3; c++)
    noise += (squares[c] * STEPS / (sum[c] * sum[c]) - 1) / 3;
  return noise;
}

static void test_colour_noise(void **state) {
  (void)state;
  static const struct {
    float reflectance[3];
    double max; /* relative variance */
  } rows[] = {{{0.8f, 0.8f, 0.8f}, 0.004},
              {{0.8f, 0.5f, 0.3f}, 0.004},
              {{0.63f, 0.065f, 0.05f}, 0.025},
              {{0.1f, 0.15f, 0.7f}, 0.025}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double noise = colour_noise(vl_visible_lambda, rows[i].reflectance);
    double before = colour_noise(luminance_lambda, rows[i].reflectance);
    assert_true(noise < rows[i].max && before > 8 * rows[i].max);
  }
}

/* A grey light of the space's illuminant, luminance 1, seen through random wavelengths: (1, 1,
 * 1) on average; stratified u gives it almost exactly. */
static void test_white(void **state) {
  (void)state;
  static batch x;
  const vlColorKernels *k = vl_color_kernels(vl_isa_best());
  float *lambda[4] = ROWS(x.lambda), *inv_pdf[4] = ROWS(x.inv_pdf);
  const float *l[4] = ROWS(x.lambda), *p[4] = ROWS(x.inv_pdf), *o[4] = ROWS(x.out);
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    vlSpectrum white = vl_spectrum_rgb(1, 1, 1);
    white.space = (vlColorSpace)space;
    float scale = (float)(1 / vl_spectrum_photometric(&white, NULL)), m[9];
    for (int i = 0; i < PAD; i++)
      x.u[i] = ((float)i + 0.5f) / (float)PAD;
    k->visible_wavelengths(PAD, x.u, lambda, inv_pdf);
    const float *light = vl_space_illuminant((vlColorSpace)space);
    for (int c = 0; c < 4; c++)
      for (int i = 0; i < PAD; i++)
        x.out[c][i] = scale * vl_dense_at(light, x.lambda[c][i]);
    vl_rgb_from_xyz((vlColorSpace)space, m);
    k->rgb_from_radiance(vl_cie_xyz0, m, PAD, o, l, p, x.r, x.g, x.b);
    double sum[3] = {0};
    for (int i = 0; i < PAD; i++) {
      sum[0] += (double)x.r[i] / PAD;
      sum[1] += (double)x.g[i] / PAD;
      sum[2] += (double)x.b[i] / PAD;
    }
    for (int c = 0; c < 3; c++)
      assert_float_equal(sum[c], 1.0, 2e-3);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bits),    cmocka_unit_test(test_inline),
      cmocka_unit_test(test_dense),   cmocka_unit_test(test_density),
      cmocka_unit_test(test_samples), cmocka_unit_test(test_colour_noise),
      cmocka_unit_test(test_white),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
