/* filter/filter.hot.c: sampling pixel filters in batches. Compiled once per instruction set. */
#include "filter/filter.h"

#include "math/vec.h"
#include "velo/filter_kinds.h"

enum { CHUNK = 128 };

static void sample_box(const vlFilterAxis *axis, uint32_t n, const float *u, float *d) {
  float width = 2.0f * axis->radius;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    d[i] = (u[i] - 0.5f) * width;
  }
}

static void sample_triangle(const vlFilterAxis *axis, uint32_t n, const float *u, float *d) {
  float radius = axis->radius;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    float t = 2.0f * u[i] - 1.0f;
    d[i] = __builtin_copysignf(radius * (1.0f - __builtin_sqrtf(1.0f - vl_abs(t))), t);
  }
}

static void sample_table(const vlFilterAxis *axis, uint32_t n, const float *u, float *d,
                         float *w) {
  _Alignas(64) float start[CHUNK], scale[CHUNK];
  _Alignas(64) int32_t base[CHUNK], last[CHUNK];
  const float *edges = axis->x, *values = axis->f;
  for (uint32_t i = 0; i < n; i++) {
    start[i] = axis->start[0];
    scale[i] = axis->scale[0];
    base[i] = axis->base[0];
    last[i] = axis->last[0];
    w[i] = axis->sign[0];
  }
  for (uint32_t k = 1; k < axis->segments; k++) {
    float from = axis->start[k], bins = axis->scale[k], sign = axis->sign[k];
    int32_t first = axis->base[k], max = axis->last[k];
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      int in = vl_abs(2.0f * u[i] - 1.0f) >= from;
      start[i] = in ? from : start[i];
      scale[i] = in ? bins : scale[i];
      base[i] = in ? first : base[i];
      last[i] = in ? max : last[i];
      w[i] = in ? sign : w[i];
    }
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    float t = 2.0f * u[i] - 1.0f, at = (vl_abs(t) - start[i]) * scale[i];
    int32_t bin = (int32_t)at;
    bin = bin < last[i] ? bin : last[i];
    bin = bin > 0 ? bin : 0;
    float s = vl_clamp(at - (float)bin, 0.0f, 1.0f);
    int32_t k = base[i] + bin;
    float x0 = edges[k], x1 = edges[k + 1], a = values[k], b = values[k + 1];
    /* inverse of the cumulated linear density from a to b */
    float q = s * (a + b) / (a + __builtin_sqrtf(a * a + s * (b * b - a * a)) + 1e-30f);
    q = q < 1.0f ? q : 1.0f;
    d[i] = __builtin_copysignf(x0 + (x1 - x0) * q, t);
  }
}

static void sample(const vlFilterTable *filter, uint32_t n, const float *u, const float *v,
                   float *dx, float *dy, float *weight) {
  uint32_t count = VL_PAD(n);
  const vlFilterAxis *x = &filter->axis[0], *y = &filter->axis[1];
  if (filter->kind == VL_PIXEL_FILTER_BOX || filter->kind == VL_PIXEL_FILTER_TRIANGLE) {
    for (uint32_t i = 0; i < count; i++)
      weight[i] = 1.0f;
    if (filter->kind == VL_PIXEL_FILTER_BOX) {
      sample_box(x, count, u, dx);
      sample_box(y, count, v, dy);
    } else {
      sample_triangle(x, count, u, dx);
      sample_triangle(y, count, v, dy);
    }
    return;
  }
  for (uint32_t k = 0; k < count; k += CHUNK) {
    uint32_t m = count - k < CHUNK ? count - k : CHUNK;
    _Alignas(64) float wx[CHUNK], wy[CHUNK];
    sample_table(x, m, u + k, dx + k, wx);
    sample_table(y, m, v + k, dy + k, wy);
    for (uint32_t i = 0; i < m; i++)
      weight[k + i] = wx[i] * wy[i];
  }
}

static void curve(const vlFilterCurve *c, uint32_t n, const float *at, float shift,
                  float *out) {
  const float *values = c->values;
  float per_step = c->per_step, steps = c->steps;
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float t = vl_abs(at[i] - shift) * per_step, inside = t <= steps ? 1.0f : 0.0f;
    t = t < steps ? t : steps;
    int32_t k = (int32_t)t;
    out[i] = inside * (values[k] + (t - (float)k) * (values[k + 1] - values[k]));
  }
}

const vlFilterKernels vl_filter_kernel_table = {sample, curve};
