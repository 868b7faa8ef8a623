/* raw/demosaic.c: bilinear interpolation of a mosaic of any pattern. */
#include "raw/demosaic.h"

#include <stdlib.h>

enum { CELLS = VL_RAW_MAX_CELLS, SIDE = VL_RAW_MAX_SIDE };

typedef struct Demosaic {
  const vlRawDef *def;
  const float *mosaic;
  float *result;
  uint32_t colors;
  int radius;
  uint8_t planes[CELLS]; /* of each cell: the index of its colour */
} Demosaic;

/* Index of the colour of the pixel (x, y), which may be up to a window outside of the image. */
static uint32_t plane_at(const Demosaic *d, int x, int y) {
  uint32_t columns = d->def->pattern_columns, rows = d->def->pattern_rows;
  uint32_t column = (uint32_t)(x + (int)columns * SIDE) % columns;
  uint32_t row = (uint32_t)(y + (int)rows * SIDE) % rows;
  return d->planes[row * columns + column];
}

/* Whether a quarter of the window around a cell has every colour. */
static bool is_complete(const Demosaic *d, int x, int y, int step_x, int step_y, int radius) {
  uint32_t there = 0;
  for (int dy = 0; dy <= radius; dy++)
    for (int dx = 0; dx <= radius; dx++)
      there |= 1u << plane_at(d, x + step_x * dx, y + step_y * dy);
  return there == (1u << d->colors) - 1;
}

static bool is_enough(const Demosaic *d, int radius) {
  for (int y = 0; y < (int)d->def->pattern_rows; y++)
    for (int x = 0; x < (int)d->def->pattern_columns; x++)
      for (int step_y = -1; step_y <= 1; step_y += 2)
        for (int step_x = -1; step_x <= 1; step_x += 2)
          if (!is_complete(d, x, y, step_x, step_y, radius))
            return false;
  return true;
}

/* The weighted sums over the window of one pixel, by colour. */
static void add_window(const Demosaic *d, int x, int y, float sums[VL_RAW_MAX_COLORS],
                       float weights[VL_RAW_MAX_COLORS]) {
  int width = (int)d->def->width, height = (int)d->def->height, r = d->radius;
  int x0 = x < r ? -x : -r, x1 = x + r < width ? r : width - 1 - x;
  int y0 = y < r ? -y : -r, y1 = y + r < height ? r : height - 1 - y;
  for (int dy = y0; dy <= y1; dy++) {
    const float *row = d->mosaic + (size_t)(y + dy) * d->def->width;
    for (int dx = x0; dx <= x1; dx++) {
      uint32_t plane = plane_at(d, x + dx, y + dy);
      float weight = (float)((r + 1 - abs(dx)) * (r + 1 - abs(dy)));
      sums[plane] += weight * row[x + dx];
      weights[plane] += weight;
    }
  }
}

static void interpolate_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Demosaic *d = user;
  for (uint32_t x = 0; x < d->def->width; x++) {
    size_t at = (size_t)y * d->def->width + x;
    float *result = d->result + at * d->colors;
    float sums[VL_RAW_MAX_COLORS] = {0.0f}, weights[VL_RAW_MAX_COLORS] = {0.0f};
    add_window(d, (int)x, (int)y, sums, weights);
    for (uint32_t k = 0; k < d->colors; k++)
      result[k] = weights[k] > 0.0f ? sums[k] / weights[k] : 0.0f;
    result[d->planes[vl_raw_cell(d->def, x, y)]] = d->mosaic[at];
  }
}

void vl_raw_demosaic(vlContext *context, const vlRawDef *def, const float *mosaic,
                     float *result) {
  Demosaic d = {.def = def, .mosaic = mosaic, .result = result};
  d.colors = vl_raw_planes(def, d.planes);
  while (!is_enough(&d, d.radius))
    d.radius++;
  vl_parallel_for(context, def->height, interpolate_row, &d);
}
