/* test/trace/test_sampler_variance.c: the benefit of samplers: the error of pixel integrals
 * relative to independent random numbers, its rate of convergence, and its distribution over
 * the image with zsobol. */
#include "sampler/sampler.h"
#include "statistics.h"
#include "unit.h"
#include "velo/sampler.h"

enum { WIDTH = 32, PIXELS = WIDTH * WIDTH, KINDS = VL_SAMPLER_ZSOBOL + 1 };

typedef double Function(double x, double y);
static double product(double x, double y) {
  return x * y;
}
static double gaussian(double x, double y) {
  return exp(-4 * ((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6)));
}
static double disk(double x, double y) {
  return x * x + y * y < 0.5 ? 1 : 0;
}
static double edge(double x, double y) {
  return y > 0.3 + 0.37 * x ? 1 : 0;
}
static Function *const FUNCTIONS[4] = {product, gaussian, disk, edge};

static double integral(Function *f) {
  enum { N = 2000 };
  double sum = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      sum += f((i + 0.5) / N, (j + 0.5) / N);
  return sum / ((double)N * N);
}

/* error[pixel] of the mean of f over spp samples. Returns the root mean square. */
static double errors(vlSamplerKind kind, uint32_t spp, uint32_t dimension, Function *f,
                     double exact, double *error) {
  enum { BATCH = 1024 };
  static int32_t px[BATCH], py[BATCH];
  static uint32_t index[BATCH];
  static float u[BATCH], v[BATCH];
  vlSampler s;
  vl_sampler_init(&s, kind, 99, WIDTH, WIDTH, spp);
  double sum2 = 0;
  for (int p = 0; p < PIXELS; p++)
    error[p] = -exact;
  for (uint64_t first = 0; first < (uint64_t)PIXELS * spp; first += BATCH) {
    for (uint32_t i = 0; i < BATCH; i++) {
      uint64_t k = first + i, p = k / spp % PIXELS;
      px[i] = (int32_t)(p % WIDTH);
      py[i] = (int32_t)(p / WIDTH);
      index[i] = (uint32_t)(k % spp);
    }
    vl_sampler_kernels(vl_isa_best())->get_2d(&s, BATCH, px, py, index, dimension, u, v);
    for (uint32_t i = 0; i < BATCH && first + i < (uint64_t)PIXELS * spp; i++)
      error[py[i] * WIDTH + px[i]] += f(u[i], v[i]) / spp;
  }
  for (int p = 0; p < PIXELS; p++)
    sum2 += error[p] * error[p];
  return sqrt(sum2 / PIXELS);
}

static double error_[PIXELS];

static void test_beats_independent(void **state) {
  (void)state;
  /* Root mean square error relative to independent at 64 and 100 samples, at most; halton high
   * up is just random. */
  static const double MAX_RATIO[KINDS][4] = {
      [VL_SAMPLER_STRATIFIED] = {0.17, 0.22, 0.40, 0.40},
      [VL_SAMPLER_NROOKS] = {0.50, 0.30, 0.70, 0.60},
      [VL_SAMPLER_MULTI_JITTERED] = {0.26, 0.09, 0.34, 0.30},
      [VL_SAMPLER_HAMMERSLEY] = {0.25, 0.06, 0.28, 0.42},
      [VL_SAMPLER_HALTON] = {0.19, 0.15, 0.38, 0.41},
      [VL_SAMPLER_SOBOL] = {0.12, 0.13, 0.38, 0.34},
      [VL_SAMPLER_ZSOBOL] = {0.11, 0.17, 0.38, 0.36}};
  for (int f = 0; f < 4; f++) {
    double exact = integral(FUNCTIONS[f]);
    for (uint32_t spp = 64; spp <= 100; spp += 36)
      for (uint32_t dimension = 0; dimension < 50; dimension += 40) {
        double base =
            errors(VL_SAMPLER_INDEPENDENT, spp, dimension, FUNCTIONS[f], exact, error_);
        for (int kind = VL_SAMPLER_STRATIFIED; kind < KINDS; kind++) {
          if (kind == VL_SAMPLER_HALTON && dimension > 4)
            continue;
          double ratio =
              errors((vlSamplerKind)kind, spp, dimension, FUNCTIONS[f], exact, error_) / base;
          double limit = MAX_RATIO[kind][f];
          if (getenv("VELO_TEST_VERBOSE"))
            print_message("f %d spp %u dim %u kind %d: %.3f\n", f, spp, dimension, kind, ratio);
          if (ratio > limit)
            fail_msg("kind %d, function %d, %u spp, dimension %u: %g > %g", kind, f, spp,
                     dimension, ratio, limit);
        }
      }
  }
}

/* Error ~ N^-1.5 for smooth functions, ~ N^-0.75 for edges, in the powers of two (Owen
 * 1997). */
static void test_decay(void **state) {
  (void)state;
  static const vlSamplerKind KIND[2] = {VL_SAMPLER_SOBOL, VL_SAMPLER_ZSOBOL};
  for (int k = 0; k < 2; k++)
    for (int f = 0; f < 4; f++) {
      double exact = integral(FUNCTIONS[f]);
      double few = errors(KIND[k], 16, 4, FUNCTIONS[f], exact, error_);
      double many = errors(KIND[k], 1024, 4, FUNCTIONS[f], exact, error_);
      double slope = log(many / few) / log(1024.0 / 16.0);
      if (getenv("VELO_TEST_VERBOSE"))
        print_message("kind %d f %d: N^%.2f (%g -> %g)\n", KIND[k], f, slope, few, many);
      if (slope > (f < 2 ? -1.3 : -0.65))
        fail_msg("kind %d, function %d: error falls as N^%g only", KIND[k], f, slope);
    }
}

/* The error of blocks of pixels is far below that of independent pixels: what is left is high
 * frequency. */
static void test_blue_noise(void **state) {
  (void)state;
  static const uint32_t SPP[3] = {1, 4, 16};
  for (int f = 0; f < 4; f++)
    for (int k = 0; k < 3; k++) {
      double exact = integral(FUNCTIONS[f]), blocks[2];
      double pixel[2];
      for (int z = 0; z < 2; z++) {
        pixel[z] = errors(z ? VL_SAMPLER_ZSOBOL : VL_SAMPLER_SOBOL, SPP[k], 6, FUNCTIONS[f],
                          exact, error_);
        double sum2 = 0;
        for (int by = 0; by < WIDTH; by += 4)
          for (int bx = 0; bx < WIDTH; bx += 4) {
            double sum = 0;
            for (int i = 0; i < 16; i++)
              sum += error_[(by + i / 4) * WIDTH + bx + i % 4];
            sum2 += sum * sum / 256;
          }
        blocks[z] = sqrt(sum2 / (PIXELS / 16));
      }
      if (getenv("VELO_TEST_VERBOSE"))
        print_message("f %d spp %u: 4x4 blocks, zsobol/sobol %.3f, pixels %.3f\n", f, SPP[k],
                      blocks[1] / blocks[0], pixel[1] / pixel[0]);
      assert_true(blocks[1] < (f < 2 ? 0.5 : 0.75) * blocks[0]);
      assert_true(pixel[1] < 1.2 * pixel[0]);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_beats_independent),
      cmocka_unit_test(test_decay),
      cmocka_unit_test(test_blue_noise),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
