/* render/feature_grid.hot.c: adds the features of one sample of each pixel to the pixels that
 * count the sample, and finds where samples differ. */
#include "render/feature_grid.h"

enum { N = VL_LANES, COUNT = VL_FEATURES + 1, DISPARITY = VL_FEATURES - 1 };

/* Differences of albedo and normal, and relative ones of the disparity, that are variation. */
static const float MAX_DIFFERENCE = 0.02f, MAX_DISPARITY = 0.01f;

/* The sums of N pixels of a row, in registers: the features, then the weights. */
typedef struct Sums {
  float value[COUNT][N];
} Sums;

/* Adds the hits at N grid points from `at` on, whose weights are x[] and y[], to N pixels.
 * counts: 1 or 0 for each. */
static inline void add_hits(const vlFeatureGrid *g, size_t at, const float *x, const float *y,
                            const float *counts, Sums *sums) {
  float weight[N];
  /* must vectorise (gcc) */
  VL_SIMD for (int i = 0; i < N; i++) {
    weight[i] = x[i] * y[i] * counts[i];
    sums->value[VL_FEATURES][i] += weight[i];
  }
  for (int k = 0; k < VL_FEATURES; k++) {
    const float *value = g->value[k] + at;
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < N; i++) sums->value[k][i] += weight[i] * value[i];
  }
}

static bool any(const float counts[N]) {
  float sum = 0.0f;
  for (int i = 0; i < N; i++)
    sum += counts[i];
  return sum > 0.0f;
}

static void add(vlFeatureGrid *g, const vlFeatureRegion *r) {
  const uint32_t bx = r->border[0], by = r->border[1];
  for (uint32_t y = 0; y < r->height; y++)
    for (uint32_t x = 0; x < r->width; x += N) {
      const size_t to = (size_t)y * VL_FEATURE_SIDE + x;
      const float *counts = g->counts + to;
      if (!any(counts))
        continue;
      Sums own;
      for (int k = 0; k < COUNT; k++)
        memcpy(own.value[k], g->sums[k] + to, sizeof own.value[k]);
      for (uint32_t v = 0; v <= 2 * by; v++)
        for (uint32_t u = 0; u <= 2 * bx; u++) {
          const size_t at = (size_t)(y + v) * r->stride + x + u;
          add_hits(g, at, g->x[2 * bx - u] + at, g->y[2 * by - v] + at, counts, &own);
        }
      for (int k = 0; k < COUNT; k++)
        memcpy(g->sums[k] + to, own.value[k], sizeof own.value[k]);
    }
}

/* A difference that is not a number is variation, too. */
static void compare(vlFeatureGrid *g, uint32_t n) {
  for (int k = 0; k < VL_FEATURES; k++) {
    const float *value = g->value[k], *first = g->first[k];
    const float fixed = k < DISPARITY ? MAX_DIFFERENCE : 0.0f,
                relative = k < DISPARITY ? 0.0f : MAX_DISPARITY;
    float *varies = g->varies;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      float d = value[i] - first[i], size = d < 0.0f ? -d : d;
      varies[i] = size <= fixed + relative * first[i] ? varies[i] : 1.0f;
    }
  }
}

const vlFeatureKernels vl_feature_kernel_table = {add, compare};
