/* render/splats.c: see splats.h. */
#include "render/splats.h"

#include <math.h>
#include <string.h>

#include "film/sums.h"

static void add(vlSplatSum *sum, float value) {
  vlInt128 units = vl_film_product(value, INT64_C(1) << VL_WEIGHT_BITS);
  uint64_t low = (uint64_t)units, high = (uint64_t)(units >> 64);
  uint64_t old = atomic_fetch_add_explicit(&sum->low, low, memory_order_relaxed);
  high += old + low < old;
  if (high) atomic_fetch_add_explicit(&sum->high, high, memory_order_relaxed);
}

/* The pixels along one axis whose filter covers a film point, from the crop window's edge, and the filter's values. */
typedef struct Taps {
  uint32_t first, count;
  double value[2 * VL_FILTER_RADIUS_MAX + 1];
} Taps;

static void find_taps(const vlSplats *s, int axis, float at, uint32_t edge, uint32_t size, Taps *taps) {
  const vlPixelFilter *f = s->filter;
  double x = at, radius = axis ? f->radius_y : f->radius_x;
  int32_t first = (int32_t)floor(x - 0.5 - radius) + 1, low = (int32_t)edge, high = (int32_t)(edge + size);
  if (first < low) first = low;
  taps->first = (uint32_t)(first - low);
  taps->count = 0;
  for (int32_t p = first; p < high && p + 0.5 <= x + radius; p++)
    taps->value[taps->count++] = vl_filter_value(f, axis, x - p - 0.5);
}

bool vl_splats_add(vlSplats *s, float x, float y, const float color[3]) {
  float most = fmaxf(fabsf(color[0]), fmaxf(fabsf(color[1]), fabsf(color[2])));
  float sum = color[0] + color[1] + color[2];
  if (!(most < 0x1p35f && sum == sum)) return false;
  Taps across, down;
  find_taps(s, 0, x, s->x0, s->width, &across);
  find_taps(s, 1, y, s->y0, s->height, &down);
  for (uint32_t j = 0; j < down.count; j++) {
    vlSplat *row = s->pixels + (size_t)(down.first + j) * s->width + across.first;
    double wy = down.value[j] * s->scale[1];
    for (uint32_t i = 0; i < across.count; i++) {
      double w = wy * across.value[i] * s->scale[0];
      for (int c = 0; c < 3; c++) add(&row[i].color[c], (float)(w * (double)color[c]));
    }
  }
  return true;
}

void vl_splats_take(vlSplats *s, uint32_t n, const int32_t *px, const int32_t *py, const float *weight, float *r,
                    float *g, float *b) {
  for (uint32_t i = 0; i < n; i++) {
    vlSplat *from = &s->pixels[(size_t)((uint32_t)py[i] - s->y0) * s->width + ((uint32_t)px[i] - s->x0)];
    float *const to[3] = {r + i, g + i, b + i};
    for (int c = 0; c < 3; c++) {
      uint64_t low = atomic_load_explicit(&from->color[c].low, memory_order_relaxed);
      uint64_t high = atomic_load_explicit(&from->color[c].high, memory_order_relaxed);
      if (!(low | high)) continue;
      double sum = ((double)(int64_t)high * 0x1p64 + (double)low) * 0x1p-50;
      *to[c] += (float)(sum / (double)weight[i]);
      atomic_store_explicit(&from->color[c].low, 0, memory_order_relaxed);
      atomic_store_explicit(&from->color[c].high, 0, memory_order_relaxed);
    }
  }
}

void vl_splats_clear(vlSplats *s) {
  memset((void *)s->pixels, 0, (size_t)s->width * s->height * sizeof *s->pixels);
}

static double filter_integral(const vlPixelFilter *f, int axis) {
  enum { STEPS = 4096 };
  double radius = (double)(axis ? f->radius_y : f->radius_x), sum = 0;
  for (int i = 0; i < STEPS; i++) sum += vl_filter_value(f, axis, (i + 0.5) / STEPS * radius);
  return 2 * radius * sum / STEPS;
}

vlResult vl_splats_make(vlContext *context, const vlFilmDef *film, vlSplats *s) {
  memset(s, 0, sizeof *s);
  s->x0 = film->crop[0], s->y0 = film->crop[1];
  s->width = film->crop[2] - film->crop[0], s->height = film->crop[3] - film->crop[1];
  s->filter = &film->filter;
  for (int i = 0; i < 2; i++) s->scale[i] = 1 / filter_integral(&film->filter, i);
  s->pixels = vl_alloc_zero(context, (size_t)s->width * s->height, sizeof *s->pixels);
  return s->pixels ? VL_OK : VL_ERROR_MEMORY;
}

void vl_splats_free(vlContext *context, vlSplats *s) {
  vl_free(context, s->pixels);
  s->pixels = NULL;
}
