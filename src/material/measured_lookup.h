/* material/measured_lookup.h: lookups in measured materials: functions that are bilinear
 * over the unit square and linear between the tabulated angles. This file evaluates them,
 * samples them (first y by its marginal density, then x within the row), and inverts the
 * sampling. Between tabulated angles the density is a mixture of slices, so its integrals are
 * mixed with the same weights as its values. The functions are inline and take values, for the
 * hot loops. */
#ifndef MATERIAL_MEASURED_LOOKUP_H
#define MATERIAL_MEASURED_LOOKUP_H

#include "material/measured_tables.h"
#include "math/approx.h"
#include "math/vec.h"
#include "math/warp.h"

/* Up to 4 slices (2 azimuths x 2 elevations) and their weights. */
typedef struct vlMeasuredSlices {
  uint32_t count;
  uint32_t slice[4];
  float weight[4];
} vlMeasuredSlices;

/* The interval [i, i + 1] of ascending knots that contains x, and the position t of x in the
 * interval, clamped to [0, 1]. If there is one knot, i and t are 0. */
typedef struct vlMeasuredKnot {
  uint32_t i;
  float t;
} vlMeasuredKnot;
static inline vlMeasuredKnot vl_measured_knot(const float *knots, uint32_t n, float x) {
  if (n < 2)
    return (vlMeasuredKnot){0, 0.0f};
  uint32_t low = vl_find_interval(knots, n - 1, x);
  return (vlMeasuredKnot){
      low, vl_clamp((x - knots[low]) / (knots[low + 1] - knots[low]), 0.0f, 1.0f)};
}

static inline vlMeasuredSlices vl_measured_slices(const vlMeasured *m, float phi, float theta) {
  vlMeasuredSlices s = {0, {0}, {0}};
  vlMeasuredKnot p = vl_measured_knot(m->phi, m->phis, phi),
                 q = vl_measured_knot(m->theta, m->thetas, theta);
  for (uint32_t a = 0; a < 2; a++)
    for (uint32_t b = 0; b < 2; b++) {
      float weight = (a ? p.t : 1.0f - p.t) * (b ? q.t : 1.0f - q.t);
      if (!(weight > 0.0f))
        continue;
      s.slice[s.count] = (p.i + a) * m->thetas + q.i + b;
      s.weight[s.count++] = weight;
    }
  return s;
}

/* Element i of the mixture of slices. Each slice has `size` elements. */
static inline float vl_measured_mix(const float *data, size_t size, vlMeasuredSlices s,
                                    size_t i) {
  float sum = 0.0f;
  for (uint32_t k = 0; k < s.count; k++)
    sum += s.weight[k] * data[s.slice[k] * size + i];
  return sum;
}

/* The cell of the grid that contains the point (x, y), and the position (s, t) of the point in
 * the cell. */
typedef struct vlMeasuredCell {
  size_t at; /* index of the cell's first node within a slice */
  uint32_t column, row;
  float s, t;
} vlMeasuredCell;
static inline vlMeasuredCell vl_measured_cell(const vlMeasuredTable *table, float x, float y) {
  float px = vl_clamp(x, 0.0f, 1.0f) * (float)(table->width - 1);
  float py = vl_clamp(y, 0.0f, 1.0f) * (float)(table->height - 1);
  uint32_t column = (uint32_t)px, row = (uint32_t)py;
  column = column < table->width - 2 ? column : table->width - 2;
  row = row < table->height - 2 ? row : table->height - 2;
  return (vlMeasuredCell){(size_t)row * table->width + column, column, row, px - (float)column,
                          py - (float)row};
}

static inline float vl_measured_between(float a, float b, float t) {
  return (1.0f - t) * a + t * b;
}

/* Value of one slice at a point. */
static inline float vl_measured_in(const vlMeasuredTable *table, const float *slice,
                                   vlMeasuredCell c) {
  const float *a = slice + c.at, *b = a + table->width;
  return vl_measured_between(vl_measured_between(a[0], a[1], c.s),
                             vl_measured_between(b[0], b[1], c.s), c.t);
}
/* Value of the mixture of slices at a point. */
static inline float vl_measured_at(const vlMeasuredTable *table, vlMeasuredSlices s, float x,
                                   float y) {
  vlMeasuredCell c = vl_measured_cell(table, x, y);
  size_t size = (size_t)table->width * table->height;
  float sum = 0.0f;
  for (uint32_t k = 0; k < s.count; k++)
    sum += s.weight[k] * vl_measured_in(table, table->values + s.slice[k] * size, c);
  return sum;
}

/* Solves for the t in [0, 1] at which the integral of a + (b - a) t reaches `part` (stable for
 * any a and b). vl_measured_part is the integral. */
static inline float vl_measured_solve(float a, float b, float part) {
  float root = __builtin_sqrtf(vl_max(a * a + 2.0f * part * (b - a), 0.0f)), down = a + root;
  return down > 0.0f ? vl_clamp(2.0f * part / down, 0.0f, 1.0f) : 0.5f;
}
static inline float vl_measured_part(float a, float b, float t) {
  return t * (a + 0.5f * (b - a) * t);
}

/* A line of constant y between two rows of the mixture: for each slice, the start and the
 * weight of both rows. */
typedef struct vlMeasuredLine {
  uint32_t count;
  size_t at[8];
  float weight[8];
} vlMeasuredLine;
static inline vlMeasuredLine vl_measured_line(vlMeasuredSlices s, size_t size, size_t row,
                                              uint32_t width, float t) {
  vlMeasuredLine line = {2 * s.count, {0}, {0}};
  for (uint32_t k = 0; k < s.count; k++) {
    line.at[2 * k] = s.slice[k] * size + row;
    line.weight[2 * k] = s.weight[k] * (1.0f - t);
    line.at[2 * k + 1] = s.slice[k] * size + row + width;
    line.weight[2 * k + 1] = s.weight[k] * t;
  }
  return line;
}
static inline float vl_measured_on(const vlMeasuredLine *line, const float *data, size_t i) {
  float sum = 0.0f;
  for (uint32_t k = 0; k < line->count; k++)
    sum += line->weight[k] * data[line->at[k] + i];
  return sum;
}

/* A point of the square, and the sampling density there. */
typedef struct vlMeasuredPoint {
  float x, y, pdf;
} vlMeasuredPoint;

/* Samples a point from a random point (u, v) of the unit square: v gives y, and u gives x. */
static inline vlMeasuredPoint vl_measured_sample(const vlMeasuredTable *table,
                                                 vlMeasuredSlices slices, float u, float v) {
  uint32_t w = table->width, h = table->height, low = 0, high = h - 1;
  size_t size = (size_t)w * h;
  while (high - low > 1) {
    uint32_t mid = (low + high) / 2;
    if (vl_measured_mix(table->rows, h, slices, mid) <= v)
      low = mid;
    else
      high = mid;
  }
  size_t first = (size_t)low * w, end = w - 1;
  float part = (v - vl_measured_mix(table->rows, h, slices, low)) * (float)(h - 1);
  float t =
      vl_measured_solve(vl_measured_mix(table->columns, size, slices, first + end),
                        vl_measured_mix(table->columns, size, slices, first + w + end), part);
  vlMeasuredLine line = vl_measured_line(slices, size, first, w, t);
  float wanted = u * vl_measured_on(&line, table->columns, end);
  uint32_t left = 0, right = w - 1;
  while (right - left > 1) {
    uint32_t mid = (left + right) / 2;
    if (vl_measured_on(&line, table->columns, mid) <= wanted)
      left = mid;
    else
      right = mid;
  }
  float a = vl_measured_on(&line, table->values, left),
        b = vl_measured_on(&line, table->values, left + 1);
  float s = vl_measured_solve(
      a, b, (wanted - vl_measured_on(&line, table->columns, left)) * (float)(w - 1));
  return (vlMeasuredPoint){((float)left + s) / (float)(w - 1),
                           ((float)low + t) / (float)(h - 1), vl_measured_between(a, b, s)};
}

/* Albedo at normal incidence at the wavelength of a channel; in RGB mode, of the channel. */
static inline float vl_measured_albedo(const vlMeasured *m, int channel, float lambda) {
  if (!m->lambda)
    return channel < 3 ? m->albedo[channel] : 0.0f;
  vlMeasuredKnot k = vl_measured_knot(m->lambda, m->lambdas, lambda);
  return k.t > 0.0f ? vl_measured_between(m->albedo[k.i], m->albedo[k.i + 1], k.t)
                    : m->albedo[k.i];
}

/* The inverse of vl_measured_sample: the (u, v) from which (x, y) is sampled, and its
 * density. */
static inline vlMeasuredPoint vl_measured_invert(const vlMeasuredTable *table,
                                                 vlMeasuredSlices slices, float x, float y) {
  uint32_t w = table->width, h = table->height;
  size_t size = (size_t)w * h, end = w - 1;
  vlMeasuredCell c = vl_measured_cell(table, x, y);
  size_t first = (size_t)c.row * w;
  float t = c.t;
  float v =
      vl_measured_mix(table->rows, h, slices, c.row) +
      vl_measured_part(vl_measured_mix(table->columns, size, slices, first + end),
                       vl_measured_mix(table->columns, size, slices, first + w + end), t) /
          (float)(h - 1);
  vlMeasuredLine line = vl_measured_line(slices, size, first, w, t);
  float a = vl_measured_on(&line, table->values, c.column),
        b = vl_measured_on(&line, table->values, c.column + 1),
        all = vl_measured_on(&line, table->columns, end);
  float u = vl_measured_on(&line, table->columns, c.column) +
            vl_measured_part(a, b, c.s) / (float)(w - 1);
  return (vlMeasuredPoint){all > 0.0f ? vl_clamp(u / all, 0.0f, 1.0f) : 0.0f,
                           vl_clamp(v, 0.0f, 1.0f), vl_measured_between(a, b, c.s)};
}

#endif
