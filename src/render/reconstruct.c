/* render/reconstruct.c: see reconstruct.h. */
#include "render/reconstruct.h"

#include <math.h>
#include <string.h>

#include "base/context.h"
#include "film/filter.h"

vlResult vl_filter_curve_make(vlContext *context, const vlPixelFilter *f, int axis, vlFilterCurve *curve) {
  double radius = axis ? f->radius_y : f->radius_x, sum = 0;
  uint32_t steps = (uint32_t)ceil(radius) * VL_FILTER_STEPS;
  double step = radius / steps;
  *curve = (vlFilterCurve){.steps = steps, .per_step = 1 / step};
  curve->values = vl_alloc_array(context, (size_t)steps + 2, sizeof *curve->values);
  if (!curve->values) return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < steps; i++) sum += vl_filter_value(f, axis, (i + 0.5) * step);
  for (uint32_t i = 0; i < steps + 2; i++)
    curve->values[i] = vl_filter_value(f, axis, fmin(i * step, radius)) / (2 * sum * step);
  return VL_OK;
}

static uint32_t border_of(double radius) {
  return (uint32_t)ceil(radius - 0.5);
}

static bool filter_shares(const vlPixelFilter *f) {
  bool positive = f->kind == VL_PIXEL_FILTER_BOX || f->kind == VL_PIXEL_FILTER_TRIANGLE ||
                  f->kind == VL_PIXEL_FILTER_GAUSSIAN || f->kind == VL_PIXEL_FILTER_BLACKMAN_HARRIS;
  bool wide = f->radius_x > 0.5f || f->radius_y > 0.5f, own = f->radius_x >= 0.5f && f->radius_y >= 0.5f;
  return positive && wide && own && border_of(f->radius_x) <= VL_SHARED_BORDER &&
         border_of(f->radius_y) <= VL_SHARED_BORDER;
}

bool vl_shares_samples(const vlFilmDef *film, const vlRenderDef *def) {
  return def->share_samples && !def->centred && !film->buckets && filter_shares(&film->filter);
}

vlResult vl_reconstruction_make(vlContext *context, const vlPixelFilter *filter, vlReconstruction *r) {
  *r = (vlReconstruction){.border = {border_of(filter->radius_x), border_of(filter->radius_y)}};
  vlResult result = vl_filter_curve_make(context, filter, 0, &r->curve[0]);
  return result == VL_OK ? vl_filter_curve_make(context, filter, 1, &r->curve[1]) : result;
}

void vl_reconstruction_free(vlContext *context, vlReconstruction *r) {
  for (int i = 0; i < 2; i++) vl_free(context, r->curve[i].values);
  *r = (vlReconstruction){.border = {0, 0}};
}

void vl_shared_store(const vlReconstruction *r, vlSharedGrid *g, uint32_t at, const float color[4], float x, float y) {
  for (int c = 0; c < 4; c++) g->color[c][at] = color[c];
  float along[2][2 * VL_SHARED_BORDER + 1];
  vl_shared_row(r, 0, x, along[0]);
  vl_shared_row(r, 1, y, along[1]);
  for (uint32_t k = 0; k <= 2 * r->border[0]; k++) g->x[k][at] = along[0][k];
  for (uint32_t k = 0; k <= 2 * r->border[1]; k++) g->y[k][at] = along[1][k];
}

/* Adds one neighbour of each pixel of a row. n: pixels; x, y: its filter values there. */
static void add_neighbour(uint32_t n, const float *restrict x, const float *restrict y, const float *restrict red,
                          const float *restrict green, const float *restrict blue, const float *restrict alpha,
                          float sums[5][VL_SHARED_SIDE]) {
  for (uint32_t i = 0; i < n; i++) {
    float w = x[i] * y[i];
    sums[0][i] += w * red[i];
    sums[1][i] += w * green[i];
    sums[2][i] += w * blue[i];
    sums[3][i] += w * alpha[i];
    sums[4][i] += w;
  }
}

void vl_shared_gather(const vlReconstruction *r, const vlSharedGrid *g, const vlSharedBlock *block, uint32_t first,
                      uint32_t last, float *const color[4], float *weight) {
  uint32_t bx = r->border[0], by = r->border[1], stride = block->width + 2 * bx;
  for (uint32_t j = first; j < last; j++) {
    float sums[5][VL_SHARED_SIDE];
    memset(sums, 0, sizeof sums);
    for (uint32_t v = 0; v <= 2 * by; v++)
      for (uint32_t u = 0; u <= 2 * bx; u++) { /* the sample of pixel (i + u - bx, j + v - by) */
        size_t at = (size_t)(j + v) * stride + u;
        add_neighbour(block->width, g->x[2 * bx - u] + at, g->y[2 * by - v] + at, g->color[0] + at, g->color[1] + at,
                      g->color[2] + at, g->color[3] + at, sums);
      }
    for (uint32_t i = 0; i < block->width; i++) {
      size_t to = (size_t)(j - first) * block->width + i;
      float inv = sums[4][i] > 0.0f ? 1.0f / sums[4][i] : 0.0f;
      for (int c = 0; c < 4; c++) color[c][to] = sums[c][i] * inv;
      weight[to] = sums[4][i];
    }
  }
}
