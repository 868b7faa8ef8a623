/* render/feature_grid.hot.c: adds the features of one sample of each pixel to the pixels that
 * count the sample. */
#include "render/feature_grid.h"

enum { N = VL_LANES, COUNT = VL_FEATURES + 1 };

/* The sums of N pixels of a row, in registers: the features, then the weights. */
typedef struct Sums {
  float value[COUNT][N];
} Sums;

/* Adds the hits at N grid points from `at` on, whose weights are x[] and y[]. */
static inline void add_hits(const vlFeatureGrid *g, size_t at, const float *x, const float *y,
                            Sums *sums) {
  float weight[N];
  /* must vectorise (gcc) */
  VL_SIMD for (int i = 0; i < N; i++) {
    weight[i] = x[i] * y[i];
    sums->value[VL_FEATURES][i] += weight[i];
  }
  for (int k = 0; k < VL_FEATURES; k++) {
    const float *value = g->value[k] + at;
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < N; i++) sums->value[k][i] += weight[i] * value[i];
  }
}

static void add(vlFeatureGrid *g, const vlFeatureRegion *r) {
  const uint32_t bx = r->border[0], by = r->border[1];
  for (uint32_t y = 0; y < r->height; y++)
    for (uint32_t x = 0; x < r->width; x += N) {
      const size_t to = (size_t)y * VL_FEATURE_SIDE + x;
      Sums own;
      for (int k = 0; k < COUNT; k++)
        memcpy(own.value[k], g->sums[k] + to, sizeof own.value[k]);
      for (uint32_t v = 0; v <= 2 * by; v++)
        for (uint32_t u = 0; u <= 2 * bx; u++) {
          const size_t at = (size_t)(y + v) * r->stride + x + u;
          add_hits(g, at, g->x[2 * bx - u] + at, g->y[2 * by - v] + at, &own);
        }
      for (int k = 0; k < COUNT; k++)
        memcpy(g->sums[k] + to, own.value[k], sizeof own.value[k]);
    }
}

const vlFeatureKernels vl_feature_kernel_table = {add};
