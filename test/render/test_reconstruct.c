/* test/render/test_reconstruct.c: pixels that share samples: weights follow the filter and sum
 * to 1 over the pixels; the sums of a block are those of a direct double loop; which films
 * share. */
#include <math.h>
#include <stdlib.h>

#include "base/context.h"
#include "filter/filter.h"
#include "render/reconstruct.h"
#include "unit.h"
#include "velo/filter_kinds.h"

enum { WIDTH = 13, HEIGHT = 9 };

static vlSharedGrid grid_;
static vlFilterTable table_;

static uint32_t state_ = 1;
static float random_number(void) {
  state_ = state_ * 1664525u + 1013904223u;
  return (float)(state_ >> 8) * 0x1p-24f;
}

static vlContext *make_context(void) {
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  return context;
}

/* Filters that share: defaults, other sizes, unequal radii. */
static const vlPixelFilter filters[] = {
    {.kind = VL_PIXEL_FILTER_TRIANGLE, .radius_x = 1, .radius_y = 1},
    {.kind = VL_PIXEL_FILTER_TRIANGLE, .radius_x = 2, .radius_y = 0.7f},
    {.kind = VL_PIXEL_FILTER_GAUSSIAN, .radius_x = 1.5f, .radius_y = 1.5f, .sigma = 0.5f},
    {.kind = VL_PIXEL_FILTER_BOX, .radius_x = 0.5f, .radius_y = 2.5f},
    {.kind = VL_PIXEL_FILTER_BLACKMAN_HARRIS, .radius_x = 2.2f, .radius_y = 1},
};
enum { FILTERS = sizeof filters / sizeof *filters };

/* A sample's weights in the pixels around are the filter there, scaled to an integral of 1;
 * they sum to 1 in the mean, for a triangle of radius 1 always. */
static void weights(void **state) {
  (void)state;
  vlContext *context = make_context();
  for (int k = 0; k < FILTERS; k++) {
    const vlPixelFilter *f = &filters[k];
    assert_int_equal(vl_filter_compile(context, f, &table_), VL_OK);
    vlReconstruction r = vl_reconstruction_of(&table_);
    double integral[2] = {0, 0};
    enum { STEPS = 20000 };
    for (int axis = 0; axis < 2; axis++) {
      double radius = axis ? f->radius_y : f->radius_x;
      for (int i = 0; i < STEPS; i++)
        integral[axis] +=
            vl_filter_value(f, axis, radius * (2 * (i + 0.5) / STEPS - 1)) * 2 * radius / STEPS;
    }
    double mean = 0;
    enum { SIDE = 64 };
    for (int i = 0; i < SIDE * SIDE; i++) {
      float x = ((float)(i % SIDE) + 0.5f) / SIDE, y = ((float)(i / SIDE) + 0.5f) / SIDE;
      double sum = 0;
      for (int32_t dy = -3; dy <= 3; dy++)
        for (int32_t dx = -3; dx <= 3; dx++) {
          double w = vl_shared_weight(&r, x, y, dx, dy), u = x - 0.5 - dx, v = y - 0.5 - dy;
          bool inside = fabs(u) < f->radius_x && fabs(v) < f->radius_y;
          double exact = inside ? vl_filter_value(f, 0, u) * vl_filter_value(f, 1, v) /
                                      (integral[0] * integral[1])
                                : 0;
          if (fabs(w - exact) > 1e-5)
            fail_msg("filter %d at %g, %g: %g, not %g", k, u, v, w, exact);
          bool reaches = (uint32_t)abs(dx) <= r.border[0] && (uint32_t)abs(dy) <= r.border[1];
          assert_true(reaches || w == 0);
          sum += w;
        }
      if (k == 0)
        assert_true(fabs(sum - 1) < 1e-6);
      mean += sum / (SIDE * SIDE);
    }
    double correlation = vl_reconstruction_correlation(&r);
    if (k == 0)
      /* 1/4 one pixel away: (1/6) / (2/3) */
      assert_true(fabs(correlation - 1.125 * 1.125) < 1e-3);
    assert_true(correlation > 1 && correlation < 25);
    if (fabs(mean - 1) > 2e-3)
      fail_msg("filter %d: weights sum to %g", k, mean);
    vl_filter_free(context, &table_);
  }
  vl_context_destroy(context);
}

/* Rows of a block are the sums over all samples of the block and its border. */
static void sums(void **state) {
  (void)state;
  vlContext *context = make_context();
  for (int k = 0; k < FILTERS; k++) {
    assert_int_equal(vl_filter_compile(context, &filters[k], &table_), VL_OK);
    vlReconstruction r = vl_reconstruction_of(&table_);
    const vlSharedBlock block = {.x0 = 40, .y0 = 7, .width = WIDTH, .height = HEIGHT};
    uint32_t stride = WIDTH + 2 * r.border[0], rows = HEIGHT + 2 * r.border[1],
             count = stride * rows;
    static float values[VL_SHARED_GRID][4], points[VL_SHARED_GRID][2];
    for (uint32_t i = 0; i < count; i++) {
      for (int c = 0; c < 4; c++)
        values[i][c] = random_number();
      for (int c = 0; c < 2; c++)
        points[i][c] = random_number();
      vlSharedTaps taps;
      _Alignas(64) float x[VL_PAD(1)] = {points[i][0]}, y[VL_PAD(1)] = {points[i][1]};
      for (int axis = 0; axis < 2; axis++)
        vl_shared_taps(&r, vl_filter_kernels(vl_isa_best()), axis, 1, axis ? y : x,
                       taps.along[axis][0], VL_SHARED_LANES);
      bool counts = i % 50 != 3;
      if (!counts) {
        values[i][0] = NAN;
        points[i][0] = 99;
      } /* no weight in any pixel */
      vl_shared_store(&r, &grid_, i, values[i], &taps, 0, counts);
      for (int c = 0; c < 4 && !counts; c++)
        values[i][c] = 0;
    }
    float color[4][WIDTH * HEIGHT], weight[WIDTH * HEIGHT];
    float *const rows_of[4] = {color[0], color[1], color[2], color[3]};
    const uint32_t first = 2, last = HEIGHT - 1;
    vl_shared_gather(&r, &grid_, &block, first, last, rows_of, weight);
    for (uint32_t y = first; y < last; y++)
      for (uint32_t x = 0; x < WIDTH; x++) {
        double sum[5] = {0};
        for (uint32_t i = 0; i < count; i++) {
          int32_t dx = (int32_t)(x + r.border[0]) - (int32_t)(i % stride);
          int32_t dy = (int32_t)(y + r.border[1]) - (int32_t)(i / stride);
          double w = vl_shared_weight(&r, points[i][0], points[i][1], dx, dy);
          for (int c = 0; c < 4; c++)
            sum[c] += w * values[i][c];
          sum[4] += w;
        }
        uint32_t at = (y - first) * WIDTH + x;
        assert_true(fabs(weight[at] - sum[4]) < 1e-5 * sum[4]);
        for (int c = 0; c < 4; c++)
          assert_true(fabs(color[c][at] - sum[c] / sum[4]) < 1e-5);
      }
    vl_filter_free(context, &table_);
  }
  vl_context_destroy(context);
}

/* A sample of the border counts where it has a weight in a pixel of the block, and nowhere
 * else. */
static void border(void **state) {
  (void)state;
  vlContext *context = make_context();
  for (int k = 0; k < FILTERS; k++) {
    assert_int_equal(vl_filter_compile(context, &filters[k], &table_), VL_OK);
    vlReconstruction r = vl_reconstruction_of(&table_);
    const vlSharedBlock block = {.x0 = 40, .y0 = 7, .width = 3, .height = 2};
    const uint32_t *b = r.border;
    uint32_t skipped = 0;
    for (int i = 0; i < 40000; i++) {
      uint32_t u = (uint32_t)(random_number() * (float)(block.width + 2 * b[0]));
      uint32_t v = (uint32_t)(random_number() * (float)(block.height + 2 * b[1]));
      float x = random_number(), y = random_number(), max = 0;
      for (uint32_t j = b[1]; j < b[1] + block.height; j++)
        for (uint32_t l = b[0]; l < b[0] + block.width; l++)
          max = fmaxf(max, vl_shared_weight(&r, x, y, (int32_t)l - (int32_t)u,
                                            (int32_t)j - (int32_t)v));
      bool counts = vl_shared_counts(&r, &block, u, v, x, y);
      if (counts != (max > 0))
        fail_msg("filter %d at %u, %u: weight %g, counts %d", k, u, v, (double)max, counts);
      skipped += !counts;
    }
    if (r.skips != (skipped > 0))
      fail_msg("filter %d: %u samples need not be traced", k, skipped);
    vl_filter_free(context, &table_);
  }
  vl_context_destroy(context);
}

static void rules(void **state) {
  (void)state;
  vlFilmDef film = vl_default_film_def(8, 8);
  vlRenderDef def = vl_default_render_def();
  for (int k = 0; k < FILTERS; k++) {
    film.filter = filters[k];
    assert_true(vl_shares_samples(&film, &def));
  }
  static const struct {
    vlPixelFilterKind kind;
    float radius;
  } own[] = {{VL_PIXEL_FILTER_BOX, 0.5f},
             {VL_PIXEL_FILTER_MITCHELL, 2},
             {VL_PIXEL_FILTER_LANCZOS, 2},
             {VL_PIXEL_FILTER_TRIANGLE, 0.4f},
             {VL_PIXEL_FILTER_GAUSSIAN, 2.6f}};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
    film.filter = vl_default_pixel_filter(own[i].kind);
    film.filter.radius_x = film.filter.radius_y = own[i].radius;
    assert_false(vl_shares_samples(&film, &def));
  }
  film.filter = filters[0];
  def.centred = true;
  assert_false(vl_shares_samples(&film, &def));
  def.centred = false;
  film.buckets = 8;
  assert_false(vl_shares_samples(&film, &def));
  film.buckets = 0;
  def.share_samples = false;
  assert_false(vl_shares_samples(&film, &def));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(weights), cmocka_unit_test(sums),
                                     cmocka_unit_test(border), cmocka_unit_test(rules)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
