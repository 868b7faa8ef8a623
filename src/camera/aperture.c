/* camera/aperture.c: apertures that are not round: blade polygons and images. See
 * aperture.h. */
#include "camera/aperture.h"

#include <math.h>

#include "base/context.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/free.h"
#include "base/text.h"
#include "math/elementary.h"
#include "math/warp.h"

enum { MAX_SIDE = 4096, NAMED = 256 };

/* ---- blades ------------------------------------------------------------------------------ */

void vl_blades_make(uint32_t count, double rotation, vlBlades *blades) {
  memset(blades, 0, sizeof *blades);
  blades->count = count < VL_MAX_BLADES ? count : VL_MAX_BLADES;
  for (uint32_t i = 0; i < blades->count; i++) {
    double angle = rotation - 0.5 * M_PI + 2.0 * M_PI * i / blades->count;
    blades->x[i] = (float)vl_precise_cos(angle);
    blades->y[i] = (float)vl_precise_sin(angle);
  }
  blades->x[blades->count] = blades->x[0];
  blades->y[blades->count] = blades->y[0];
}

/* u chooses one of the equal triangles between the centre and a side; its remainder is the
 * position along the side. sqrt(v) is the height, because a triangle's area grows with the
 * square of its height. */
void vl_blades_points(const vlBlades *blades, uint32_t n, const float *u, const float *v,
                      float *x, float *y) {
  for (uint32_t i = 0; i < n; i++) {
    double t = (double)u[i] * blades->count;
    uint32_t side = (uint32_t)t < blades->count ? (uint32_t)t : blades->count - 1;
    double along = t - side, height = sqrt((double)v[i]);
    double ax = blades->x[side], ay = blades->y[side], bx = blades->x[side + 1],
           by = blades->y[side + 1];
    x[i] = (float)(height * (ax + along * (bx - ax)));
    y[i] = (float)(height * (ay + along * (by - ay)));
  }
}

/* ---- images ------------------------------------------------------------------------------ */

struct vlAperture {
  vlContext *context;
  uint32_t width, height;
  double reach2; /* vl_aperture_reach2 of the shape */
  float *values; /* scaled so that their mean is pi / 4 */
  float *rows;   /* height + 1: share of the total light above each row's upper edge */
  /* height x (width + 1): share of the row's light to the left of each column */
  float *columns;
};

void vl_aperture_points(const vlAperture *a, uint32_t n, const float *u, const float *v,
                        float *x, float *y) {
  for (uint32_t i = 0; i < n; i++) {
    float dx, dy;
    uint32_t row = vl_find_cell(a->rows, a->height, v[i], &dy);
    uint32_t column =
        vl_find_cell(a->columns + (size_t)row * (a->width + 1), a->width, u[i], &dx);
    x[i] = (float)(2.0 * (column + (double)dx) / a->width - 1.0);
    y[i] = (float)(2.0 * (row + (double)dy) / a->height - 1.0);
  }
}

static double value_of(const vlAperture *a, int64_t x, int64_t y) {
  bool inside = x >= 0 && y >= 0 && x < a->width && y < a->height;
  return inside ? (double)a->values[(size_t)y * a->width + (size_t)x] : 0.0;
}

double vl_aperture_value(const vlAperture *a, double x, double y) {
  if (!(fabs(x) <= 1.0 && fabs(y) <= 1.0))
    return 0.0;
  double px = 0.5 * (x + 1.0) * a->width - 0.5, py = 0.5 * (y + 1.0) * a->height - 0.5;
  double fx = floor(px), fy = floor(py), sx = px - fx, sy = py - fy;
  int64_t ix = (int64_t)fx, iy = (int64_t)fy;
  double upper = (1.0 - sx) * value_of(a, ix, iy) + sx * value_of(a, ix + 1, iy);
  double lower = (1.0 - sx) * value_of(a, ix, iy + 1) + sx * value_of(a, ix + 1, iy + 1);
  return (1.0 - sy) * upper + sy * lower;
}

double vl_aperture_reach2(const vlAperture *a) {
  return a->reach2;
}

/* The bilinear support of a texel reaches to the centres of its neighbours, but not beyond the
 * square. */
static double find_reach2(const vlAperture *a) {
  double max = 0;
  for (uint32_t y = 0; y < a->height; y++)
    for (uint32_t x = 0; x < a->width; x++) {
      if (!(a->values[(size_t)y * a->width + x] > 0))
        continue;
      double px = fmin(1, (fabs(2 * (x + 0.5) - a->width) + 2) / a->width);
      double py = fmin(1, (fabs(2 * (y + 0.5) - a->height) + 2) / a->height);
      max = fmax(max, px * px + py * py);
    }
  return max;
}

static vlResult check(uint32_t width, uint32_t height, const float *values, double *sum,
                      vlError *error) {
  if (!values)
    return vl_fail_argument(error, "aperture: values is null");
  if (width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE)
    return vl_fail_argument(error, "aperture: an image of %u x %u; each side must be 1 to %d",
                            width, height, MAX_SIDE);
  *sum = 0.0;
  for (size_t i = 0; i < (size_t)width * height; i++) {
    if (!(values[i] >= 0.0f) || isinf(values[i]))
      return vl_fail_argument(
          error, "aperture: the image's pixel %zu, %zu is %g; it must be 0 or above", i % width,
          i / width, (double)values[i]);
    *sum += (double)values[i];
  }
  if (!(*sum > 0.0))
    return vl_fail_argument(error, "aperture: the image is black; no light would pass");
  return VL_OK;
}

/* Computes running sums as fractions of the total. If the total is zero, all entries are 0 and
 * are never read. */
static void accumulate(const double *sums, uint32_t count, float *table) {
  double whole = 0.0, before = 0.0;
  for (uint32_t i = 0; i < count; i++)
    whole += sums[i];
  table[0] = 0.0f;
  for (uint32_t i = 0; i < count; i++) {
    before += sums[i];
    table[i + 1] = whole > 0.0 ? (float)(before / whole) : 0.0f;
  }
  /* entries from the last non-black cell on are exactly 1, so that rounding never selects a
   * cell behind it */
  for (uint32_t i = count; whole > 0.0 && i > 0; i--) {
    table[i] = 1.0f;
    if (sums[i - 1] > 0.0)
      break;
  }
}

vlResult vl_aperture_create(vlContext *context, uint32_t width, uint32_t height,
                            const float *values, vlAperture **aperture, vlError *error) {
  double sum = 0.0;
  vl_error_clear(error);
  if (!context || !aperture)
    return vl_fail_argument(error, "aperture: context or aperture is null");
  *aperture = NULL;
  VL_TRY(check(width, height, values, &sum, error));
  size_t cells = (size_t)width * height;
  vlAperture *a = vl_alloc_zero(context, 1, sizeof *a);
  double *sums = vl_alloc_array(context, width > height ? width : height, sizeof *sums);
  if (a) {
    *a = (vlAperture){.context = context, .width = width, .height = height};
    a->values = vl_alloc_array(context, cells, sizeof *a->values);
    a->rows = vl_alloc_array(context, height + 1, sizeof *a->rows);
    a->columns = vl_alloc_array(context, (size_t)(width + 1) * height, sizeof *a->columns);
  }
  if (!a || !sums || !a->values || !a->rows || !a->columns) {
    vl_free(context, sums);
    vl_aperture_destroy(a);
    return vl_fail_memory(error);
  }
  for (uint32_t row = 0; row < height; row++) {
    for (uint32_t i = 0; i < width; i++)
      sums[i] = (double)values[(size_t)row * width + i];
    accumulate(sums, width, a->columns + (size_t)row * (width + 1));
  }
  for (uint32_t row = 0; row < height; row++) {
    sums[row] = 0.0;
    for (uint32_t i = 0; i < width; i++)
      sums[row] += (double)values[(size_t)row * width + i];
  }
  accumulate(sums, height, a->rows);
  double scale = 0.25 * M_PI * (double)cells / sum;
  for (size_t i = 0; i < cells; i++)
    a->values[i] = (float)(scale * (double)values[i]);
  a->reach2 = find_reach2(a);
  vl_free(context, sums);
  *aperture = a;
  return VL_OK;
}

void vl_aperture_destroy(vlAperture *a) {
  if (!a)
    return;
  vlContext *context = a->context;
  VL_FREE(context, a->values, a->rows, a->columns, a);
}

/* ---- pbrt's names ------------------------------------------------------------------------ */

enum { GAUSSIAN, SQUARE, PENTAGON, STAR, NAMES };

typedef struct Polygon {
  int count;
  double corners[10][2];
} Polygon;

/* Whether the point is inside the polygon (even-odd rule). */
static bool is_inside(const Polygon *polygon, double x, double y) {
  bool in = false;
  for (int i = 0, k = polygon->count - 1; i < polygon->count; k = i++) {
    const double *a = polygon->corners[i], *b = polygon->corners[k];
    if ((a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]))
      in = !in;
  }
  return in;
}

/* The shapes and sizes are those of pbrt-v4; y points up here. The pentagon has radius 0.8, and
 * one of its sides is at the bottom. The star's inner corners are the intersections of its
 * outer pentagon's diagonals; one of them is on the right. */
static Polygon named_polygon(int name) {
  Polygon polygon = {.count = name == PENTAGON ? 5 : 10};
  const double inner = vl_precise_cos(0.4 * M_PI) / vl_precise_cos(0.2 * M_PI);
  for (int i = 0; i < polygon.count; i++) {
    double angle = 0.2 * M_PI * i;
    double radius = i & 1 ? 1.0 : inner;
    if (name == PENTAGON) {
      angle = 0.5 * M_PI + 0.4 * M_PI * i;
      radius = 0.8;
    }
    polygon.corners[i][0] = radius * vl_precise_cos(angle);
    polygon.corners[i][1] = radius * vl_precise_sin(angle);
  }
  return polygon;
}

static double named_value(int name, const Polygon *polygon, double x, double y) {
  if (name == GAUSSIAN)
    return fmax(0.0, vl_precise_exp(-(x * x + y * y)) - vl_precise_exp(-1.0));
  if (name == SQUARE)
    return 1.0;
  return is_inside(polygon, x, y) ? 1.0 : 0.0;
}

vlResult vl_aperture_create_named(vlContext *context, const char *name, vlAperture **aperture,
                                  vlError *error) {
  static const char *const names[NAMES] = {"gaussian", "square", "pentagon", "star"};
  vl_error_clear(error);
  if (!context || !name || !aperture)
    return vl_fail_argument(error, "aperture: context, name or aperture is null");
  *aperture = NULL;
  const int kind = (int)vl_name_index(name, names, NAMES);
  if (kind == NAMES) {
    const char *near = vl_nearest_name(name, names, NAMES);
    return vl_fail_argument(
        error, "aperture: unknown shape \"%s\"%s%s%s", vl_argument_text(name).text,
        near ? "; did you mean \"" : " (known: gaussian, square, pentagon, star)",
        near ? near : "", near ? "\"?" : "");
  }
  float *values = vl_alloc_array(context, (size_t)NAMED * NAMED, sizeof *values);
  if (!values)
    return vl_fail_memory(error);
  const Polygon polygon = named_polygon(kind);
  for (int i = 0; i < NAMED * NAMED; i++)
    values[i] = (float)named_value(kind, &polygon, (i % NAMED + 0.5) * 2.0 / NAMED - 1.0,
                                   1.0 - (double)(i / NAMED + 0.5) * 2.0 / NAMED);
  vlResult result = vl_aperture_create(context, NAMED, NAMED, values, aperture, error);
  vl_free(context, values);
  return result;
}

void vl_aperture_digest(const vlAperture *a, uint8_t digest[16]) {
  vl_digest(a->values, (size_t)a->width * a->height * sizeof *a->values, digest);
  for (int i = 0; i < 4; i++)
    digest[i] ^= (uint8_t)(a->width >> 8 * i);
}
