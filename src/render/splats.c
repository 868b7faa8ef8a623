/* render/splats.c: see splats.h. */
#include "render/splats.h"

#include <math.h>
#include <string.h>

#include "film/sums.h"
#include "filter/filter.h"

static void add(vlSplatSum *sum, float value) {
  vlInt128 units = vl_film_product(value, INT64_C(1) << VL_WEIGHT_BITS);
  uint64_t low = (uint64_t)units, high = (uint64_t)(units >> 64);
  uint64_t old = atomic_fetch_add_explicit(&sum->low, low, memory_order_relaxed);
  high += old + low < old;
  if (high)
    atomic_fetch_add_explicit(&sum->high, high, memory_order_relaxed);
}

/* ---- adding ------------------------------------------------------------------------------ */

/* The pixels of the crop window, along one axis and from its edge, whose filter covers a film
 * point. */
typedef struct Taps {
  uint32_t first, count;
} Taps;

static Taps find_taps(const vlSplats *s, int axis, float at) {
  double x = at, radius = s->filter->axis[axis].radius;
  int32_t low = (int32_t)(axis ? s->y0 : s->x0),
          high = low + (int32_t)(axis ? s->height : s->width);
  int32_t first = (int32_t)floor(x - 0.5 - radius) + 1, last = (int32_t)floor(x - 0.5 + radius);
  if (first < low)
    first = low;
  if (last >= high)
    last = high - 1;
  return (Taps){(uint32_t)(first - low), last < first ? 0 : (uint32_t)(last - first + 1)};
}

/* Adds one color. */
static bool add_one(vlSplats *s, float x, float y, const float color[3]) {
  float max = fmaxf(fabsf(color[0]), fmaxf(fabsf(color[1]), fabsf(color[2])));
  float sum = color[0] + color[1] + color[2];
  if (!(max < 0x1p35f && sum == sum))
    return false;
  Taps across = find_taps(s, 0, x), down = find_taps(s, 1, y);
  double value[2 * VL_MAX_FILTER_RADIUS + 1];
  for (uint32_t i = 0; i < across.count; i++)
    value[i] = (double)vl_filter_curve_at(
        &s->filter->curve[0], (float)((double)x - (s->x0 + across.first + i) - 0.5));
  for (uint32_t j = 0; j < down.count; j++) {
    vlSplat *row = s->pixels + (size_t)(down.first + j) * s->width + across.first;
    double wy = (double)vl_filter_curve_at(&s->filter->curve[1],
                                           (float)((double)y - (s->y0 + down.first + j) - 0.5));
    for (uint32_t i = 0; i < across.count; i++)
      for (int c = 0; c < 3; c++)
        add(&row[i].color[c], (float)(wy * value[i] * (double)color[c]));
  }
  return true;
}

/* The pixels of a pass's splats are anywhere in the image, so most are not in the cache. */
static void prefetch(const vlSplats *s, float x, float y) {
  Taps across = find_taps(s, 0, x), down = find_taps(s, 1, y);
  if (!across.count)
    return;
  for (uint32_t j = 0; j < down.count; j++) {
    const vlSplat *row = s->pixels + (size_t)(down.first + j) * s->width + across.first;
    for (uint32_t i = 0; i < across.count; i++)
      __builtin_prefetch(row + i, 1);
  }
}

uint32_t vl_splats_add(vlSplats *s, uint32_t n, const float *x, const float *y,
                       float *const color[3]) {
  enum { AHEAD = 4 };
  uint32_t bad = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (i + AHEAD < n)
      prefetch(s, x[i + AHEAD], y[i + AHEAD]);
    bad += !add_one(s, x[i], y[i], (const float[3]){color[0][i], color[1][i], color[2][i]});
  }
  return bad;
}

void vl_splats_take(vlSplats *s, uint32_t n, const int32_t *px, const int32_t *py,
                    const float *weight, float *r, float *g, float *b) {
  for (uint32_t i = 0; i < n; i++) {
    vlSplat *from =
        &s->pixels[(size_t)((uint32_t)py[i] - s->y0) * s->width + ((uint32_t)px[i] - s->x0)];
    float *const to[3] = {r + i, g + i, b + i};
    for (int c = 0; c < 3; c++) {
      uint64_t low = atomic_load_explicit(&from->color[c].low, memory_order_relaxed);
      uint64_t high = atomic_load_explicit(&from->color[c].high, memory_order_relaxed);
      if (!(low | high))
        continue;
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

vlResult vl_splats_make(vlContext *context, const vlFilm *film, vlSplats *s) {
  const uint32_t *crop = vl_film_def(film)->crop;
  memset(s, 0, sizeof *s);
  s->x0 = crop[0];
  s->y0 = crop[1];
  s->width = crop[2] - crop[0];
  s->height = crop[3] - crop[1];
  s->filter = vl_film_filter(film);
  s->pixels = vl_alloc_zero(context, (size_t)s->width * s->height, sizeof *s->pixels);
  return s->pixels ? VL_OK : VL_ERROR_MEMORY;
}

void vl_splats_free(vlContext *context, vlSplats *s) {
  vl_free(context, s->pixels);
  *s = (vlSplats){0};
}
