/* conformance/sampling.h: the laws of samplers (numbers in [0, 1), even, pairs not correlated,
 * as many in each cell as the kind promises) and of pixel filters (they integrate to 1, and
 * spread light as their formula says). */
#ifndef TEST_CONFORMANCE_SAMPLING_H
#define TEST_CONFORMANCE_SAMPLING_H

#include "conformance.h"
#include "filter/filter.case.h"
#include "filter/filter.h"
#include "sampler/sampler.case.h"
#include "sampler/sampler.h"
#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"

/* ---- samplers ---------------------------------------------------------------------------- */

enum { SETS = 64, SET = 64, SIDE = 8 }; /* pixels; samples of each; cells along a side */

#define SAMPLER_CASE(kind, name) &name##_sampler,
static const SamplerCase *const sampler_cases[] = {VL_SAMPLER_KINDS(SAMPLER_CASE)};

typedef struct Numbers2 {
  double u[SETS][SET], v[SETS][SET], other[SETS][SET];
  uint32_t count;
  uint32_t width;   /* of the film; SETS / width pixels high */
  uint32_t samples; /* of each pixel, up to SET */
} Numbers2;

static void take_numbers(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  static float u[VL_OWN_BATCH];
  static float v[VL_OWN_BATCH];
  static float other[VL_OWN_BATCH];
  Numbers2 *n = user;
  vl_trace_numbers(trace, 0, u, v);
  vl_trace_numbers(trace, 1, other, NULL);
  for (uint32_t i = 0; i < paths->count; i++) {
    uint32_t pixel = (uint32_t)paths->y[i] * n->width + (uint32_t)paths->x[i];
    uint32_t index = paths->index[i];
    assert_true(pixel < SETS && index < n->samples);
    n->u[pixel][index] = (double)u[i];
    n->v[pixel][index] = (double)v[i];
    n->other[pixel][index] = (double)other[i];
    n->count++;
  }
}

/* Renders with a tracer that takes numbers. After `sequence` samples another one begins. */
static void draw_by(const vlOwnTracer *tracer, vlSamplerKind kind, uint32_t width,
                    uint32_t height, uint32_t samples, uint32_t sequence) {
  vlError error = {0};
  vlScene *scene = load_text(context, HEAD "WorldBegin LightSource \"infinite\"", &error);
  assert_non_null(scene);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->camera = vl_default_camera_def(width, height);
  defs->film = vl_default_film_def(width, height);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.spp = samples;
  defs->render.sequence = sequence;
  defs->render.sampler = kind;
  defs->render.share_samples = false;
  defs->render.own_tracer = tracer;
  vlImage *image = render_scene(context, scene, &error);
  if (!image)
    fail_msg("%s", error.message);
  vl_image_destroy(image);
}

static Numbers2 *draw_sequences(vlSamplerKind kind, uint32_t width, uint32_t samples,
                                uint32_t sequence) {
  Numbers2 *n = calloc(1, sizeof *n);
  assert_non_null(n);
  n->width = width;
  n->samples = samples;
  const vlOwnTracer tracer = {.name = "numbers", .radiance = take_numbers, .user = n};
  draw_by(&tracer, kind, width, SETS / width, samples, sequence);
  assert_int_equal(n->count, SETS * samples);
  return n;
}

static Numbers2 *draw_numbers(vlSamplerKind kind, uint32_t width, uint32_t samples) {
  return draw_sequences(kind, width, samples, samples);
}

/* Chi-square over 256 intervals of all numbers, as standard deviations above what independent
 * numbers have. */
static double unevenness(double numbers[SETS][SET]) {
  enum { BINS = 256 };
  double bins[BINS] = {0};
  double sum = 0;
  for (int p = 0; p < SETS; p++)
    for (int i = 0; i < SET; i++)
      bins[(int)(numbers[p][i] * BINS)]++;
  for (int k = 0; k < BINS; k++) {
    double expected = (double)SETS * SET / BINS;
    sum += (bins[k] - expected) * (bins[k] - expected) / expected;
  }
  return (sum - (BINS - 1)) / sqrt(2.0 * (BINS - 1));
}

static double mean_number(double numbers[SETS][SET]) {
  double sum = 0;
  for (int p = 0; p < SETS; p++)
    for (int i = 0; i < SET; i++)
      sum += numbers[p][i];
  return sum / (SETS * SET);
}

static double correlation(double a[SETS][SET], double b[SETS][SET]) {
  double sum = 0;
  for (int p = 0; p < SETS; p++)
    for (int i = 0; i < SET; i++)
      sum += (a[p][i] - 0.5) * (b[p][i] - 0.5);
  return 12 * sum / (SETS * SET);
}

/* The variance of the mean of f over a pixel, times the samples, over that of independent
 * numbers. */
static double spread(double u[SETS][SET], double v[SETS][SET]) {
  Mean m = {0};
  for (int p = 0; p < SETS; p++) {
    double sum = 0;
    for (int i = 0; i < SET; i++)
      sum += u[p][i] * v[p][i];
    mean_add(&m, sum / SET);
  }
  double variance = variance_of_mean(&m) * SETS;
  return variance * SET / (1.0 / 9 - 1.0 / 16);
}

/* How many pairs of numbers are nearer to each other than 2^-12. Of pairs of independent
 * numbers 2 are, and more than 14 in one of ten million runs. */
static int twins(double a[SETS][SET], double b[SETS][SET]) {
  int found = 0;
  for (int p = 0; p < SETS; p++)
    for (int i = 0; i < SET; i++)
      found += fabs(a[p][i] - b[p][i]) < 0x1p-12;
  return found;
}

static int empty_cells(double numbers[SETS][SET], double others[SETS][SET], int columns,
                       int rows) {
  int empty = 0;
  for (int p = 0; p < SETS; p++) {
    bool used[SET] = {false};
    for (int i = 0; i < SET; i++)
      used[(int)(others[p][i] * rows) * columns + (int)(numbers[p][i] * columns)] = true;
    for (int i = 0; i < SET; i++)
      empty += !used[i];
  }
  return empty;
}

static void laws_of_samplers(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const SamplerCase *c = sampler_cases[k];
    const char *name = family->rows[k]->name;
    Numbers2 *n = draw_numbers((vlSamplerKind)k, 8, SET);
    uint32_t outside = 0;
    for (int p = 0; p < SETS; p++)
      for (int i = 0; i < SET; i++)
        outside += !(n->u[p][i] >= 0 && n->u[p][i] < 1 && n->v[p][i] >= 0 && n->v[p][i] < 1);
    if (outside) {
      broken("samplers", name, "%u numbers outside [0, 1)", outside);
      free(n);
      continue;
    }
    double uneven = fmax(unevenness(n->u), unevenness(n->v));
    if (!c->centre && !(uneven < 5))
      broken("samplers", name, "uneven by %.1f standard deviations", uneven);
    double middle = fmax(fabs(mean_number(n->u) - 0.5), fabs(mean_number(n->v) - 0.5));
    if (!(middle < 5 * 0.2887 / 64))
      broken("samplers", name, "the mean of the numbers is off by %.4f", middle);
    double pairs = fmax(fabs(correlation(n->u, n->v)), fabs(correlation(n->u, n->other)));
    if (!(pairs < 5.0 / 64))
      broken("samplers", name, "numbers correlate by %.3f", pairs);
    int equal =
        twins(n->u, n->v) > twins(n->u, n->other) ? twins(n->u, n->v) : twins(n->u, n->other);
    if (!c->centre && equal > 14)
      broken("samplers", name, "%d of %d pairs have the same number twice", equal, SETS * SET);
    if (c->rows && (empty_cells(n->u, n->u, SET, 1) || empty_cells(n->v, n->v, SET, 1)))
      broken("samplers", name, "%d columns and %d rows are empty",
             empty_cells(n->u, n->u, SET, 1), empty_cells(n->v, n->v, SET, 1));
    if (c->cells && empty_cells(n->u, n->v, SIDE, SIDE))
      broken("samplers", name, "%d cells are empty", empty_cells(n->u, n->v, SIDE, SIDE));
    double ratio = spread(n->u, n->v);
    if (!(c->hash ? ratio > 0.5 && ratio < 1.7 : ratio < 0.5))
      broken("samplers", name, "a mean has %.3f of the variance of independent numbers", ratio);
    free(n);
  }
  expect_no_failures();
}

/* ---- numbers of own tracers -------------------------------------------------------------- */

/* How often two numbers are equal that tracers of one's own get for neighbouring purposes. */
typedef struct Purposes {
  uint32_t pairs, equal;
} Purposes;

static void ask_purposes(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  enum { ASKED = 3 };
  static float u[ASKED][VL_OWN_BATCH];
  static float v[ASKED][VL_OWN_BATCH];
  static float alone[ASKED][VL_OWN_BATCH];
  Purposes *p = user;
  for (uint32_t k = 0; k < ASKED; k++) {
    vl_trace_numbers(trace, k, u[k], v[k]);
    vl_trace_numbers(trace, k, alone[k], NULL);
  }
  for (int k = 0; k + 1 < ASKED; k++)
    for (uint32_t i = 0; i < paths->count; i++) {
      const float other[3] = {u[k + 1][i], v[k + 1][i], alone[k + 1][i]};
      bool equal = u[ASKED - 1][i] == alone[0][i] || alone[ASKED - 1][i] == u[0][i];
      for (int j = 0; j < 3; j++)
        equal |= u[k][i] == other[j] || v[k][i] == other[j] || alone[k][i] == other[j];
      p->pairs++;
      p->equal += equal;
    }
}

/* Numbers of different purposes are independent. Those that are centres of cells are equal by
 * chance. */
static void purposes_of_samplers(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    if (sampler_cases[k]->centre)
      continue;
    static const char text[] = HEAD "WorldBegin LightSource \"infinite\"";
    Purposes p = {0};
    const vlOwnTracer tracer = {.name = "purposes", .radiance = ask_purposes, .user = &p};
    vlScene *scene = need_scene(text);
    vlSceneDefs *defs = vl_scene_defs(scene);
    defs->render.sampler = (vlSamplerKind)k;
    defs->render.spp = 64;
    defs->render.own_tracer = &tracer;
    vl_image_destroy(need_image(scene, text));
    assert_true(p.pairs > 64 * WIDTH * WIDTH);
    if (p.equal > p.pairs / 50)
      broken("samplers", family->rows[k]->name, "%u of %u numbers are those of another purpose",
             p.equal, p.pairs);
  }
  expect_no_failures();
}

/* ---- samplers with any number of samples ------------------------------------------------- */

/* Numbers in floats may lie below the edge of an interval by this part of it. */
#define ROUNDING 1e-5

/* Whether each of the intervals of 1 / count holds one of the numbers. */
static bool one_in_each(const double *numbers, uint32_t count) {
  bool used[SET] = {false};
  for (uint32_t i = 0; i < count; i++) {
    uint32_t cell = (uint32_t)(numbers[i] * count + ROUNDING);
    if (cell >= count || used[cell])
      return false;
    used[cell] = true;
  }
  return true;
}

/* Whether the pairs with v from `low` to `high`, in counts of pairs, are as many as these are,
 * in columns of equal width. */
static bool is_row(const double *u, const double *v, uint32_t count, uint32_t low,
                   uint32_t high) {
  double inside[SET];
  uint32_t found = 0;
  for (uint32_t i = 0; i < count; i++)
    if (v[i] * count + ROUNDING >= low && v[i] * count + ROUNDING < high)
      inside[found++] = u[i];
  return found == high - low && one_in_each(inside, found);
}

/* Cells of equal area lie in rows, each as high as it has cells, and not more of them than the
 * root of twice their number: rows from the lowest on, in all pixels the same. */
static bool is_in_cells(const Numbers2 *n) {
  uint32_t count = n->samples;
  uint32_t widest = (uint32_t)sqrt(2.0 * count);
  uint32_t low = 0;
  while (low < count) {
    uint32_t high = low;
    bool row = false;
    while (!row && high < count && high - low < widest) {
      high++;
      row = true;
      for (int p = 0; p < SETS; p++)
        row = row && is_row(n->u[p], n->v[p], count, low, high);
    }
    if (!row)
      return false;
    low = high;
  }
  return true;
}

static void check_count(const char *name, const SamplerCase *c, const Numbers2 *n) {
  bool rows = true;
  for (int p = 0; p < SETS; p++)
    rows = rows && one_in_each(n->u[p], n->samples) && one_in_each(n->v[p], n->samples);
  if (c->rows && !rows)
    broken("samplers", name, "%u samples: a row or column is empty", n->samples);
  if (c->cells && !is_in_cells(n))
    broken("samplers", name, "%u samples: they do not lie in cells of equal area", n->samples);
}

/* Numbers of samples that are a square, primes, and products of which none is one. */
static void samplers_of_any_count(void **state) {
  (void)state;
  static const uint32_t counts[] = {1, 2, 3, 7, 9, 12, 18, 23, 50};
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; sampler_cases[k]->any_count && i < sizeof counts / sizeof *counts; i++) {
      Numbers2 *n = draw_numbers((vlSamplerKind)k, 8, counts[i]);
      check_count(family->rows[k]->name, sampler_cases[k], n);
      free(n);
    }
  expect_no_failures();
}

/* ---- samples past the end of a sequence -------------------------------------------------- */

/* They begin another one: fewer than a tenth have the numbers of the sample in whose place they
 * are. */
static void samplers_of_later_sequences(void **state) {
  (void)state;
  enum { SEQUENCE = SET / 2 };
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    Numbers2 *n = draw_sequences((vlSamplerKind)k, 8, SET, SEQUENCE);
    uint32_t equal = 0;
    for (int p = 0; p < SETS; p++)
      for (int i = 0; i < SEQUENCE; i++)
        equal += fabs(n->u[p][i] - n->u[p][i + SEQUENCE]) < 1e-6 &&
                 fabs(n->v[p][i] - n->v[p][i + SEQUENCE]) < 1e-6;
    if (equal > SETS * SEQUENCE / 10)
      broken("samplers", family->rows[k]->name,
             "%u of %d samples past the end of their sequence repeat it", equal,
             SETS * SEQUENCE);
    free(n);
  }
  expect_no_failures();
}

/* A film that was planned for a quarter of the samples goes on to all of them if the kind
 * promises it, since it has one sequence for any number of samples, and has the numbers of a
 * film that was planned for all. No other kind has. */
static void samplers_that_go_on(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const bool open = sampler_cases[k]->open;
    const uint32_t planned = vl_sampler_sequence(k, SET / 4);
    const uint32_t all = vl_sampler_sequence(k, SET);
    Numbers2 *on = draw_sequences((vlSamplerKind)k, 8, SET, planned);
    Numbers2 *at_once = draw_sequences((vlSamplerKind)k, 8, SET, all);
    const bool same = memcmp(on->u, at_once->u, sizeof on->u) == 0 &&
                      memcmp(on->v, at_once->v, sizeof on->v) == 0;
    if ((planned == all) != open || same != open)
      broken("samplers", family->rows[k]->name,
             "a film that goes on: sequences of %u and %u samples, %s numbers", planned, all,
             same ? "the same" : "other");
    free(on);
    free(at_once);
  }
  expect_no_failures();
}

/* ---- neighbours -------------------------------------------------------------------------- */

enum { FEW = 16 }; /* samples of a pixel; four pixels have SET of them */

/* How many pairs of pixels have the same numbers. */
static uint32_t equal_pixels(const Numbers2 *n) {
  uint32_t equal = 0;
  for (int p = 0; p < SETS; p++)
    for (int q = 0; q < p; q++)
      equal += memcmp(n->u[p], n->u[q], n->samples * sizeof **n->u) == 0;
  return equal;
}

/* How many squares of 2 x 2 pixels leave one of SET intervals without a number. */
static uint32_t squares_with_gaps(const Numbers2 *n) {
  uint32_t gaps = 0;
  for (uint32_t p = 0; p < SETS; p++) {
    uint32_t x = p % n->width;
    uint32_t y = p / n->width;
    double u[SET];
    double v[SET];
    if (x % 2 || y % 2)
      continue;
    for (uint32_t k = 0; k < 4; k++) {
      uint32_t q = (y + k / 2) * n->width + x + k % 2;
      memcpy(u + k * FEW, n->u[q], FEW * sizeof *u);
      memcpy(v + k * FEW, n->v[q], FEW * sizeof *v);
    }
    gaps += !one_in_each(u, SET) || !one_in_each(v, SET);
  }
  return gaps;
}

enum { FAR_AWAY = 16384, NEAR = 8 };

/* The numbers of the first pixels of a row or column, and of those that are FAR_AWAY. */
typedef struct FarNumbers {
  float u[2][NEAR][FEW];
  uint32_t count;
} FarNumbers;

static void take_far_numbers(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  static float u[VL_OWN_BATCH];
  FarNumbers *n = user;
  vl_trace_numbers(trace, 0, u, NULL);
  for (uint32_t i = 0; i < paths->count; i++) {
    uint32_t along = (uint32_t)(paths->x[i] + paths->y[i]);
    if (along % FAR_AWAY >= NEAR)
      continue;
    n->u[along / FAR_AWAY][along % FAR_AWAY][paths->index[i]] = u[i];
    n->count++;
  }
}

/* Pixels of very long images have numbers of their own, too: their indices exceed 32 bits. */
static void check_far_pixels(vlSamplerKind kind, const char *name, bool tall) {
  static FarNumbers n;
  const vlOwnTracer tracer = {.name = "numbers", .radiance = take_far_numbers, .user = &n};
  uint32_t width = tall ? 1 : FAR_AWAY + NEAR;
  uint32_t height = tall ? FAR_AWAY + NEAR : 1;
  uint32_t equal = 0;
  n.count = 0;
  draw_by(&tracer, kind, width, height, FEW, FEW);
  assert_int_equal(n.count, 2 * NEAR * FEW);
  for (int p = 0; p < NEAR; p++)
    equal += memcmp(n.u[0][p], n.u[1][p], sizeof n.u[0][p]) == 0;
  if (equal)
    broken("samplers", name, "%u x %u pixels: %u of %d far pixels have the same numbers", width,
           height, equal, NEAR);
}

/* In images of any form, pixels have numbers of their own, and neighbours share a set where the
 * kind promises it. */
static void samplers_of_neighbours(void **state) {
  (void)state;
  static const uint32_t widths[] = {8, 2, 32, 1, 64};
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
      const char *name = family->rows[k]->name;
      const SamplerCase *c = sampler_cases[k];
      uint32_t width = widths[i];
      bool squares = width > 1 && width < SETS;
      Numbers2 *n = draw_numbers((vlSamplerKind)k, width, FEW);
      if (!c->centre && equal_pixels(n))
        broken("samplers", name, "%u x %d pixels: %u pairs have the same numbers", width,
               SETS / (int)width, equal_pixels(n));
      if (c->curve && squares && squares_with_gaps(n))
        broken("samplers", name, "%u x %d pixels: %u squares have gaps", width,
               SETS / (int)width, squares_with_gaps(n));
      free(n);
    }
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int tall = 0; tall < 2; tall++)
      if (!sampler_cases[k]->centre)
        check_far_pixels((vlSamplerKind)k, family->rows[k]->name, tall == 1);
  expect_no_failures();
}

/* ---- filters ----------------------------------------------------------------------------- */

#define FILTER_CASE(kind, name) name##_filter,
static FilterShape *const filter_shapes[] = {VL_PIXEL_FILTER_KINDS(FILTER_CASE)};

enum { FILTERED = 16, RADII_ALONE = 2 };

/* Light through the pixel in the middle alone, seen by an orthographic camera of one unit per
 * pixel. */
static void light_middle(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  (void)trace;
  for (uint32_t i = 0; i < paths->count; i++) {
    double x = (double)paths->rays->origin[0][i];
    double y = (double)paths->rays->origin[1][i];
    for (int c = 0; c < 3; c++)
      paths->radiance[c][i] = fabs(x) < 0.5 && fabs(y) < 0.5;
    paths->alpha[i] = 1;
  }
}

/* The share of the light of a pixel that one `far` pixels away gets, along one axis. */
static double filtered_share(const vlPixelFilter *filter, double radius, int far) {
  FilterShape *shape = filter_shapes[filter->kind];
  enum { STEPS = 4000 };
  double whole = 0;
  double part = 0;
  for (int i = 0; i < STEPS; i++) {
    double across = ((i + 0.5) / STEPS * 2 - 1) * radius;
    double value = shape(filter, fabs(across), radius);
    whole += value;
    part += fabs(across - far) < 0.5 ? value : 0;
  }
  return part / whole;
}

static void check_filter(const vlPixelFilter *filter, const char *name, bool share) {
  vlError error = {0};
  vlScene *scene = load_text(context, HEAD "WorldBegin LightSource \"infinite\"", &error);
  assert_non_null(scene);
  vlSceneDefs *defs = vl_scene_defs(scene);
  const vlOwnTracer tracer = {.name = "middle", .radiance = light_middle};
  defs->camera = vl_default_camera_def(FILTERED + 1, FILTERED + 1);
  defs->camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  defs->camera.fx = defs->camera.fy = 1;
  defs->film = vl_default_film_def(FILTERED + 1, FILTERED + 1);
  defs->film.filter = *filter;
  defs->build.color = VL_COLOR_RGB;
  defs->render.spp = 1024;
  defs->render.sampler = VL_SAMPLER_ZSOBOL;
  defs->render.share_samples = share;
  defs->render.own_tracer = &tracer;
  double radius = (double)filter->radius_x;
  double radius_y = (double)filter->radius_y;
  vlImage *image = render_scene(context, scene, &error);
  if (!image)
    fail_msg("%s", error.message);
  double sum = 0;
  double worst = 0;
  double across[2 * FILTERED];
  double down[2 * FILTERED];
  /* below 0: the filter has negative lobes, for which no samples are shared */
  double min = 0;
  for (int k = 0; k < 2 * FILTERED; k++) {
    across[k] = filtered_share(filter, radius, k - FILTERED / 2);
    down[k] = filtered_share(filter, radius_y, k - FILTERED / 2);
    min = fmin(min, fmin(across[k], down[k]));
  }
  for (uint32_t y = 0; y <= FILTERED; y++)
    for (uint32_t x = 0; x <= FILTERED; x++) {
      double value = (double)vl_image_get(image, x, y, 1);
      sum += value;
      worst = fmax(worst, fabs(value - across[x] * down[y]));
    }
  vl_image_destroy(image);
  if (!(fabs(sum - 1) < 0.02))
    broken("filters", name, "%s: light of 1 becomes %.4f", share ? "shared" : "own", sum);
  if (!(worst < (share && min >= 0 ? 5e-4 : 0.01)))
    broken("filters", name, "%s: a pixel is off by %.4f", share ? "shared" : "own", worst);
}

/* The row says that the filter is positive if, and only if, its formula with the defaults is.
 */
static void check_sign(const vlKindRow *row, vlPixelFilterKind kind) {
  enum { STEPS = 4000 };
  const vlPixelFilter filter = vl_default_pixel_filter(kind);
  const double radius = (double)filter.radius_x;
  double min = 0;
  for (int i = 0; i <= STEPS; i++)
    min = fmin(min, filter_shapes[kind](&filter, radius * i / STEPS, radius));
  const bool positive = row->traits & VL_FILTER_TRAIT_POSITIVE;
  if (positive != (min > -1e-9))
    broken("filters", row->name,
           "VL_FILTER_TRAIT_POSITIVE is %s in its row, its least value %.4f",
           positive ? "set" : "not set", min);
}

/* The largest radii that the row allows have films. */
static void check_radii(const vlKindRow *row, vlPixelFilterKind kind) {
  for (uint32_t i = 0; i < RADII_ALONE; i++) {
    const vlParameter *p = &row->parameters[i];
    vlFilmDef def = vl_default_film_def(4, 4);
    vlFilm *film = NULL;
    def.filter = vl_default_pixel_filter(kind);
    const float max = (float)p->high;
    memcpy((char *)&def.filter + p->offset, &max, sizeof max);
    if (vl_film_create(context, &def, &film) != VL_OK)
      broken("filters", row->name, "no film with \"%s\" %.9g", p->name, p->high);
    vl_film_destroy(film);
  }
}

/* The curve by which light paths weigh pixels, in batches and one at a time, is the formula. */
static void check_curves(const vlPixelFilter *filter, const char *name) {
  enum { STEPS = 4000, POINTS = 208 };
  static vlFilterTable table;
  assert_int_equal(vl_filter_compile(context, filter, &table), VL_OK);
  for (int axis = 0; axis < 2; axis++) {
    const double radius = (double)(axis ? filter->radius_y : filter->radius_x);
    FilterShape *shape = filter_shapes[filter->kind];
    float at[POINTS];
    float together[POINTS];
    double whole = 0;
    double worst = 0;
    uint32_t other = 0;
    for (int i = 0; i < STEPS; i++)
      whole += shape(filter, radius * (i + 0.5) / STEPS, radius) * 2 * radius / STEPS;
    for (int i = 0; i < POINTS; i++)
      at[i] = (float)(radius * (2 * (i + 0.37) / POINTS - 1));
    vl_filter_kernels(vl_isa_best())->curve(&table.curve[axis], POINTS, at, 0, together);
    for (int i = 0; i < POINTS; i++) {
      const float found = vl_filter_curve_at(&table.curve[axis], at[i]);
      other += found != together[i];
      worst =
          fmax(worst, fabs((double)found - shape(filter, fabs((double)at[i]), radius) / whole));
    }
    if (other || !(worst < 2e-5))
      broken("filters", name, "its curve is off by %.6f, %u values are others in a batch",
             worst, other);
  }
  vl_filter_free(context, &table);
}

static void laws_of_filters(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("filters");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    check_sign(family->rows[k], (vlPixelFilterKind)k);
    check_radii(family->rows[k], (vlPixelFilterKind)k);
    vlPixelFilter usual = vl_default_pixel_filter((vlPixelFilterKind)k);
    usual.radius_y = 0.7f * usual.radius_x;
    check_curves(&usual, family->rows[k]->name);
    for (int share = 0; share < 2; share++) {
      vlPixelFilter filter = vl_default_pixel_filter((vlPixelFilterKind)k);
      filter.radius_y = 0.75f * filter.radius_x;
      check_filter(&filter, family->rows[k]->name, share == 1);
      filter.sigma *= 0.6f;
      filter.tau *= 0.6f;
      filter.b *= 0.6f;
      filter.c *= 0.1f;
      if (family->rows[k]->parameter_count > RADII_ALONE)
        check_filter(&filter, family->rows[k]->name, share == 1);
    }
  }
  expect_no_failures();
}

#endif
