/* filter/filter.c: pixel filters (pbrt book 8.8) and their tables for sampling, in double. The
 * shape of each kind is in its file. */
#include "filter/filter.h"

#include <math.h>
#include <string.h>

#include "base/context.h"
#include "filter/kinds.row.h"
#include "filter/value.h"
#include "schema/schema.h"
#include "velo/filter_kinds.h"

/* ---- shapes ------------------------------------------------------------------------------ */

#define DECLARE(kind, row, value) vlFilterValue value;
VL_PIXEL_FILTER_FUNCTIONS(DECLARE)

double vl_filter_value(const vlPixelFilter *filter, int axis, double x) {
  double radius = axis ? filter->radius_y : filter->radius_x;
  x = fabs(x);
  if (x > radius)
    return 0.0;
  const vlFilterAt at = {x, radius, x / radius};
  switch ((vlPixelFilterKind)filter->kind) {
#define CASE(kind, row, value) \
  case kind:                   \
    return value(filter, at);
    VL_PIXEL_FILTER_FUNCTIONS(CASE)
#undef CASE
  }
  return 0.0;
}

/* ---- tables ------------------------------------------------------------------------------ */

typedef struct Shape {
  const vlPixelFilter *filter;
  int axis;
} Shape;

static double magnitude(Shape s, double x) {
  return fabs(vl_filter_value(s.filter, s.axis, x));
}
/* Integral of |f| over [a, b], where f does not change sign: Gauss-Legendre, 4 points. */
static double mass_between(Shape s, double a, double b) {
  double c = 0.5 * (a + b), h = 0.5 * (b - a);
  return h * (0.3478548451374538 * (magnitude(s, c - h * 0.8611363115940526) +
                                    magnitude(s, c + h * 0.8611363115940526)) +
              0.6521451548625461 * (magnitude(s, c - h * 0.3399810435848563) +
                                    magnitude(s, c + h * 0.3399810435848563)));
}

enum { STEPS = 256, LOBES = 48 };
typedef struct Lobe {
  double a, b, sign;
  bool flat_a, flat_b; /* f is zero at that end, or ends there: bins of equal mass would be too
                          wide where f is curved */
  double sum[STEPS + 1]; /* mass up to a + (b - a) k / STEPS */
} Lobe;

static void lobe_integrate(Shape s, Lobe *lobe) {
  double step = (lobe->b - lobe->a) / STEPS;
  lobe->sum[0] = 0.0;
  for (int k = 0; k < STEPS; k++)
    lobe->sum[k + 1] =
        lobe->sum[k] + mass_between(s, lobe->a + step * k, lobe->a + step * (k + 1));
}
/* The x at which the lobe's mass reaches m: a search for the step, then Newton's method inside
 * the step. */
static double lobe_invert(Shape s, const Lobe *lobe, double m) {
  int low = 0, high = STEPS;
  while (high - low > 1) {
    int mid = (low + high) / 2;
    if (lobe->sum[mid] <= m)
      low = mid;
    else
      high = mid;
  }
  double step = (lobe->b - lobe->a) / STEPS, x0 = lobe->a + step * low, left = x0,
         right = x0 + step;
  double whole = lobe->sum[low + 1] - lobe->sum[low], want = m - lobe->sum[low];
  double x = whole > 0.0 ? x0 + step * (want / whole) : x0;
  for (int k = 0; k < 12; k++) {
    double error = mass_between(s, x0, x) - want, slope = magnitude(s, x);
    if (error > 0.0)
      right = x;
    else
      left = x;
    double next = slope > 0.0 ? x - error / slope : left;
    next = next > left && next < right ? next : 0.5 * (left + right);
    if (fabs(next - x) <= 1e-12 * lobe->b)
      return next;
    x = next;
  }
  return x;
}

/* The root of f between a and b, where f changes sign (sign * f > 0 at a). */
static double find_root(Shape s, double a, double b, double sign) {
  for (int i = 0; i < 60; i++) {
    double mid = 0.5 * (a + b);
    if (vl_filter_value(s.filter, s.axis, mid) * sign > 0.0)
      a = mid;
    else
      b = mid;
  }
  return b;
}
/* The minimum of |f| between a and b. */
static double find_least(Shape s, double a, double b) {
  for (int i = 0; i < 100; i++) {
    double p = a + (b - a) / 3.0, q = b - (b - a) / 3.0;
    if (magnitude(s, p) < magnitude(s, q))
      b = q;
    else
      a = p;
  }
  return 0.5 * (a + b);
}

/* Finds the lobes of [0, radius], separated by the points where f changes sign or touches zero;
 * a grid brackets them. Returns their number; 0: too many, or f is not above zero at its
 * centre. */
static int find_lobes(Shape s, double radius, Lobe *lobes) {
  enum { GRID = 1024 };
  double step = radius / GRID, top = vl_filter_value(s.filter, s.axis, 0.0), sign = 1.0,
         start = 0.0, last = 0.0;
  int count = 0;
  bool flat = false;
  if (!(top > 0.0))
    return 0;
  for (int k = 1; k <= GRID; k++) {
    double x = step * k, f = vl_filter_value(s.filter, s.axis, x);
    double cut = -1.0;
    if (fabs(f) >= 1e-12 * top && f * sign < 0.0) {
      cut = find_root(s, last, x, sign);
    } else if (k > 1 && k < GRID) {
      double before = vl_filter_value(s.filter, s.axis, x - step),
             after = vl_filter_value(s.filter, s.axis, x + step);
      bool same = before * sign > 0.0 && after * sign > 0.0,
           dip = fabs(f) < fabs(before) && fabs(f) <= fabs(after);
      double min = same && dip ? find_least(s, x - step, x + step) : -1.0;
      if (min > 0.0 && magnitude(s, min) < 1e-6 * top)
        cut = min;
    }
    if (fabs(f) >= 1e-12 * top)
      last = x;
    if (cut <= start)
      continue;
    if (count == LOBES - 1)
      return 0;
    bool change = f * sign < 0.0;
    lobes[count++] =
        (Lobe){.a = start, .b = cut, .sign = sign, .flat_a = flat, .flat_b = !change};
    start = cut;
    flat = !change;
    if (change)
      sign = -sign;
  }
  lobes[count++] =
      (Lobe){.a = start, .b = radius, .sign = sign, .flat_a = flat, .flat_b = true};
  return count;
}

/* Adds a segment: bins of equal mass between m0 and m1 of the lobe. */
static void add_segment(Shape s, vlFilterAxis *axis, const Lobe *lobe, double m0, double m1,
                        double before, double total, uint32_t bins, double weight) {
  uint32_t k = axis->segments++;
  axis->start[k] = (float)((before + m0) / total);
  axis->scale[k] = (float)(bins * total / (m1 - m0));
  axis->sign[k] = (float)weight;
  axis->base[k] = (int32_t)axis->edges;
  axis->last[k] = (int32_t)bins - 1;
  double end = lobe->sum[STEPS];
  for (uint32_t i = 0; i <= bins; i++) {
    double m = m0 + (m1 - m0) * i / bins;
    double x = i == 0 && m0 <= 0.0      ? lobe->a
               : i == bins && m1 >= end ? lobe->b
                                        : lobe_invert(s, lobe, m);
    axis->x[axis->edges] = (float)x;
    axis->f[axis->edges++] = (float)magnitude(s, x);
  }
}

static bool compile_axis(const vlPixelFilter *filter, int which, vlFilterAxis *axis) {
  enum { BINS = 512, TAIL_BINS = 32, MIN_BINS = 64 };
  double radius = which ? filter->radius_y : filter->radius_x;
  memset(axis, 0, sizeof *axis);
  axis->radius = (float)radius;
  if (filter->kind == VL_PIXEL_FILTER_BOX || filter->kind == VL_PIXEL_FILTER_TRIANGLE)
    return true;
  if (filter->kind == VL_PIXEL_FILTER_GAUSSIAN && radius > 8.0 * filter->sigma)
    radius = 8.0 * filter->sigma;
  Shape s = {filter, which};
  static const Lobe none;
  Lobe lobes[LOBES];
  for (int i = 0; i < LOBES; i++)
    lobes[i] = none;
  int count = find_lobes(s, radius, lobes);
  double total = 0.0, integral = 0.0, before = 0.0;
  for (int i = 0; i < count; i++) {
    lobe_integrate(s, &lobes[i]);
    total += lobes[i].sum[STEPS];
    integral += lobes[i].sign * lobes[i].sum[STEPS];
  }
  if (count == 0 || !(integral > 0.1 * total) || !(total < 1e30))
    return false;
  double ratio = integral == total ? 1.0 : total / integral;
  for (int i = 0; i < count; i++) {
    double mass = lobes[i].sum[STEPS], weight = lobes[i].sign * ratio;
    uint32_t bins = (uint32_t)(BINS * mass / total);
    bins = bins < MIN_BINS ? MIN_BINS : bins;
    if (!(mass > 1e-9 * total)) { /* nothing to sample */
      before += mass;
      continue;
    }
    double cuts[6] = {
        0.0, mass * 0x1p-12, mass * 0x1p-6, mass * (1.0 - 0x1p-6), mass * (1.0 - 0x1p-12),
        mass};
    for (int k = 0; k < 5; k++) {
      bool body = k == 2;
      if (!body && !(k < 2 ? lobes[i].flat_a : lobes[i].flat_b))
        continue;
      double m0 = body && !lobes[i].flat_a ? 0.0 : cuts[k],
             m1 = body && !lobes[i].flat_b ? mass : cuts[k + 1];
      add_segment(s, axis, &lobes[i], m0, m1, before, total, body ? bins : TAIL_BINS, weight);
    }
    before += mass;
  }
  return true;
}

/* ---- the whole table --------------------------------------------------------------------- */

static bool is_valid(const vlPixelFilter *filter) {
  const vlKindRow *row = vl_kind_row(&vl_pixel_filter_family, (int)filter->kind);
  double wrong;
  for (uint32_t i = 0; row && i < row->parameter_count; i++)
    if (!vl_parameter_fits(&row->parameters[i], filter, &wrong))
      return false;
  return row != NULL;
}

static vlResult make_curve(vlContext *context, const vlPixelFilter *f, int axis,
                           vlFilterCurve *curve) {
  double radius = axis ? f->radius_y : f->radius_x, sum = 0;
  uint32_t steps = (uint32_t)ceil(radius) * VL_FILTER_STEPS;
  double step = radius / steps;
  *curve = (vlFilterCurve){.steps = (float)steps, .per_step = (float)(1 / step)};
  curve->values = vl_alloc_array(context, (size_t)steps + 2, sizeof *curve->values);
  if (!curve->values)
    return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < steps; i++)
    sum += vl_filter_value(f, axis, (i + 0.5) * step);
  for (uint32_t i = 0; i < steps + 2; i++)
    curve->values[i] =
        (float)(vl_filter_value(f, axis, fmin(i * step, radius)) / (2 * sum * step));
  return VL_OK;
}

vlResult vl_filter_compile(vlContext *context, const vlPixelFilter *filter,
                           vlFilterTable *table) {
  bool same = filter->radius_x == filter->radius_y;
  table->kind = filter->kind;
  table->curve[0].values = table->curve[1].values = NULL;
  if (!is_valid(filter) || !compile_axis(filter, 0, &table->axis[0]))
    return VL_ERROR_ARGUMENT;
  if (same)
    table->axis[1] = table->axis[0];
  else if (!compile_axis(filter, 1, &table->axis[1]))
    return VL_ERROR_ARGUMENT;
  vlResult result = make_curve(context, filter, 0, &table->curve[0]);
  if (same)
    table->curve[1] = table->curve[0];
  else if (result == VL_OK)
    result = make_curve(context, filter, 1, &table->curve[1]);
  if (result != VL_OK)
    vl_filter_free(context, table);
  return result;
}

void vl_filter_free(vlContext *context, vlFilterTable *table) {
  if (table->curve[1].values != table->curve[0].values)
    vl_free(context, table->curve[1].values);
  vl_free(context, table->curve[0].values);
  table->curve[0].values = table->curve[1].values = NULL;
}
