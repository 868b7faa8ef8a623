/* render/reconstruct.c: see reconstruct.h. */
#include "render/reconstruct.h"

#include <math.h>
#include <string.h>

#include "schema/schema.h"

static uint32_t border_of(double radius) {
  return (uint32_t)ceil(radius - 0.5);
}

static bool filter_shares(const vlPixelFilter *f) {
  const vlKindRow *row = vl_kind_row(&vl_pixel_filter_family, (int)f->kind);
  bool positive = row && row->traits & VL_FILTER_TRAIT_POSITIVE;
  bool wide = f->radius_x > 0.5f || f->radius_y > 0.5f,
       own = f->radius_x >= 0.5f && f->radius_y >= 0.5f;
  return positive && wide && own && border_of(f->radius_x) <= VL_SHARED_BORDER &&
         border_of(f->radius_y) <= VL_SHARED_BORDER;
}

bool vl_shares_samples(const vlFilmDef *film, const vlRenderDef *def) {
  return def->share_samples && !def->centred && !film->buckets && filter_shares(&film->filter);
}

vlReconstruction vl_reconstruction_of(const vlFilterTable *filter) {
  vlReconstruction r = {.curve = {filter->curve[0], filter->curve[1]}};
  for (int axis = 0; axis < 2; axis++) {
    r.border[axis] = border_of(filter->axis[axis].radius);
    r.skips = r.skips || filter->axis[axis].radius < (float)r.border[axis] + 0.5f;
  }
  return r;
}

/* Along one axis: two pixels d apart have the correlation (f * f)(d) / (f * f)(0), f being the
 * filter. */
static double correlation_along(const vlFilterCurve *f, uint32_t border) {
  enum { STEPS = 64 };
  double all = 0;
  int32_t reach = 2 * (int32_t)border;
  for (int32_t d = -reach; d <= reach; d++) {
    double product = 0, square = 0;
    for (int32_t i = -(reach + 1) * STEPS; i < (reach + 1) * STEPS; i++) {
      float x = ((float)i + 0.5f) / STEPS;
      double at = (double)vl_filter_curve_at(f, x);
      product += at * (double)vl_filter_curve_at(f, x + (float)d);
      square += at * at;
    }
    all += product / square * (product / square);
  }
  return all;
}

double vl_reconstruction_correlation(const vlReconstruction *r) {
  return correlation_along(&r->curve[0], r->border[0]) *
         correlation_along(&r->curve[1], r->border[1]);
}

void vl_shared_taps(const vlReconstruction *r, const vlFilterKernels *kernels, int axis,
                    uint32_t n, const float *at, float *rows, size_t stride) {
  for (uint32_t k = 0; k <= 2 * r->border[axis]; k++)
    kernels->curve(&r->curve[axis], n, at, 0.5f + (float)k - (float)r->border[axis],
                   rows + k * stride);
}

/* Whether a sample counts in the pixel of the block that is nearest along an axis. position:
 * its pixel, from the grid's edge; at: its film point, from its pixel's corner. The same bits
 * as its weight. */
static bool reaches(const vlFilterCurve *curve, uint32_t border, uint32_t pixels,
                    uint32_t position, float at) {
  int32_t first = (int32_t)border, last = (int32_t)(border + pixels) - 1,
          own = (int32_t)position;
  int32_t nearest = own < first ? first : own > last ? last : own;
  return vl_filter_curve_at(curve, at - (0.5f + (float)(nearest - own))) > 0.0f;
}

bool vl_shared_counts(const vlReconstruction *r, const vlSharedBlock *block, uint32_t x,
                      uint32_t y, float film_x, float film_y) {
  return reaches(&r->curve[0], r->border[0], block->width, x, film_x) &&
         reaches(&r->curve[1], r->border[1], block->height, y, film_y);
}

void vl_shared_skip(const vlReconstruction *r, vlSharedGrid *g, uint32_t at) {
  for (int c = 0; c < 4; c++)
    g->color[c][at] = 0.0f;
  for (uint32_t k = 0; k <= 2 * r->border[0]; k++)
    g->x[k][at] = 0.0f;
  for (uint32_t k = 0; k <= 2 * r->border[1]; k++)
    g->y[k][at] = 0.0f;
  g->skipped[at] = true;
}

void vl_shared_store(const vlReconstruction *r, vlSharedGrid *g, uint32_t at,
                     const float color[4], const vlSharedTaps *taps, uint32_t lane,
                     bool counts) {
  for (int c = 0; c < 4; c++)
    g->color[c][at] = counts ? color[c] : 0.0f;
  for (uint32_t k = 0; k <= 2 * r->border[0]; k++)
    g->x[k][at] = counts ? taps->along[0][k][lane] : 0.0f;
  for (uint32_t k = 0; k <= 2 * r->border[1]; k++)
    g->y[k][at] = taps->along[1][k][lane];
}

/* Adds one neighbour of each pixel of a row. n: pixels; x, y: its filter values there. */
static void add_neighbour(uint32_t n, const float *restrict x, const float *restrict y,
                          const float *restrict red, const float *restrict green,
                          const float *restrict blue, const float *restrict alpha,
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

void vl_shared_gather(const vlReconstruction *r, const vlSharedGrid *g,
                      const vlSharedBlock *block, uint32_t first, uint32_t last,
                      float *const color[4], float *weight) {
  uint32_t bx = r->border[0], by = r->border[1], stride = block->width + 2 * bx;
  for (uint32_t j = first; j < last; j++) {
    float sums[5][VL_SHARED_SIDE];
    memset(sums, 0, sizeof sums);
    for (uint32_t v = 0; v <= 2 * by; v++)
      /* the sample of pixel (i + u - bx, j + v - by) */
      for (uint32_t u = 0; u <= 2 * bx; u++) {
        size_t at = (size_t)(j + v) * stride + u;
        add_neighbour(block->width, g->x[2 * bx - u] + at, g->y[2 * by - v] + at,
                      g->color[0] + at, g->color[1] + at, g->color[2] + at, g->color[3] + at,
                      sums);
      }
    for (uint32_t i = 0; i < block->width; i++) {
      size_t to = (size_t)(j - first) * block->width + i;
      float inv = sums[4][i] > 0.0f ? 1.0f / sums[4][i] : 0.0f;
      for (int c = 0; c < 4; c++)
        color[c][to] = sums[c][i] * inv;
      weight[to] = sums[4][i];
    }
  }
}
