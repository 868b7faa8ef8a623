/* test/lecture/measure.h: measures positions in a rendered image to a fraction of a pixel.
 *
 * A property scene contains flat shapes of uniform emission on an empty background, so a
 * pixel's alpha (or colour divided by full colour) is the share of it that a shape covers. The
 * sum of coverage along a row, from inside a shape to outside it, gives the position of the
 * shape's edge averaged over the row's height: for a straight edge, its position at the middle
 * of the row. Coverage is an integral and the sum inverts it exactly.
 *
 * Accuracy: with 256 low-discrepancy samples a pixel on an edge has its coverage to about 0.005
 * (rms; n points err like n^-3/4 on a half plane, 0.016, less where the edge is nearly parallel
 * to an axis). A row crosses one to three such pixels: about 0.01 pixel per row, 0.05 as a safe
 * bound for the worst of some hundred rows, and 0.02 for a mean or a fitted line. */
#ifndef TEST_LECTURE_MEASURE_H
#define TEST_LECTURE_MEASURE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/tracer.h"

#define ONE_ROW 0.05 /* pixels: bound for the worst single row */
#define FITTED 0.02  /* pixels: bound for a mean or a fitted line within its measured range */

typedef struct {
  double x, y;
} P2;
typedef struct {
  double x, y, z;
} P3;

typedef struct {
  vlContext *context;
  vlCamera camera;
  vlImage *image;
  uint32_t width, height;
  float full[4]; /* the largest value of each channel, which means full coverage */
} Image;

static inline void ok(vlResult result, const vlError *error) {
  if (result != VL_OK)
    fail_msg("%s: %s:%u:%u: %s", vl_result_name(result), error->file, error->line,
             error->column, error->message);
}

typedef void ChangeCamera(vlCameraDef *def, const void *user);

/* Renders scenes/lecture/<name>.pbrt with its own camera (modified by `change` if not null),
 * tracer and filter to a small RGB image with 256 samples per pixel. */
static inline Image render_changed(const char *name, uint32_t width, uint32_t height,
                                   ChangeCamera *change, const void *user) {
  Image p = {.width = width, .height = height};
  vlError error = {0};
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  char path[1024];
  snprintf(path, sizeof path, "%s/scenes/lecture/%s.pbrt", VELO_SOURCE_DIR, name);
  vlContextDef context_def = vl_default_context_def();
  ok(vl_context_create(&context_def, &p.context), &error);
  ok(vl_scene_create(p.context, &scene), &error);
  ok(vl_scene_load(scene, path, NULL, &error), &error);
  vlBuildDef build = vl_default_build_def();
  build.color = VL_COLOR_RGB;
  ok(vl_world_build(scene, &build, &world, &error), &error);
  vlCamera camera;
  vlCameraDef camera_def = vl_scene_defs(scene)->camera;
  if (change)
    change(&camera_def, user);
  ok(vl_camera_make(&camera_def, &camera, NULL, &error), &error);
  ok(vl_camera_resize(&camera, width, height, &p.camera), &error);
  vlFilmDef film_def = vl_default_film_def(width, height);
  film_def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  ok(vl_film_create(p.context, &film_def, &film), &error);
  vlRenderDef render = vl_scene_defs(scene)->render;
  assert_int_equal(render.tracer, VL_TRACER_RAYCAST);
  render.spp = 256;
  vlRenderStats stats;
  ok(vl_render(world, &p.camera, film, &render, &stats, &error), &error);
  assert_int_equal(stats.not_finite, 0);
  vlDevelopDef develop = vl_default_develop_def();
  ok(vl_film_develop(film, &develop, &p.image), &error);
  assert_int_equal(vl_image_channels(p.image), 4);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  for (int c = 0; c < 4; c++)
    for (uint32_t y = 0; y < height; y++)
      for (uint32_t x = 0; x < width; x++)
        p.full[c] = fmaxf(p.full[c], vl_image_get(p.image, x, y, (uint32_t)c));
  return p;
}

static inline Image render_scene(const char *name, uint32_t width, uint32_t height) {
  return render_changed(name, width, height, NULL, NULL);
}

static inline void free_image(Image *p) {
  vl_image_destroy(p->image);
  vl_context_destroy(p->context);
}

enum { RED, GREEN, BLUE, ALPHA };

/* Coverage of a pixel by its channel; 0 outside the image. */
static inline double coverage(const Image *p, int channel, long x, long y) {
  if (x < 0 || y < 0 || x >= (long)p->width || y >= (long)p->height)
    return 0;
  return (double)vl_image_get(p->image, (uint32_t)x, (uint32_t)y, (uint32_t)channel) /
         (double)p->full[channel];
}

/* The exact projection of a world point. */
static inline P2 exact(const Image *p, P3 point) {
  const double world[3] = {point.x, point.y, point.z};
  double pixel[2];
  if (!vl_camera_project(&p->camera, world, pixel, NULL))
    fail_msg("(%g %g %g) is behind the camera", point.x, point.y, point.z);
  return (P2){pixel[0], pixel[1]};
}

static inline P3 add3(P3 a, P3 b) {
  return (P3){a.x + b.x, a.y + b.y, a.z + b.z};
}

/* Measured positions of one straight edge: for a steep edge one per row, (across, along) = (x,
 * y); for a flat edge one per column, (y, x). */
typedef struct {
  bool flat;
  int count;
  double along[1024], across[1024];
} Edge;

/* a, b: the exact ends of the edge, which define a band some pixels wide around it. Rows in
 * which the band is not fully covered on one side and empty on the other (other shapes, the
 * image's border) are left out. The caller requires a minimum number of rows, so an image
 * without the edge fails. */
static inline Edge measure_edge(const Image *p, int channel, P2 a, P2 b, int at_least) {
  Edge e = {.flat = fabs(b.x - a.x) > fabs(b.y - a.y)};
  double a0 = e.flat ? a.x : a.y, a1 = e.flat ? a.y : a.x, b0 = e.flat ? b.x : b.y,
         b1 = e.flat ? b.y : b.x;
  double slope = (b1 - a1) / (b0 - a0);
  /* away from the corners */
  long first = (long)ceil(fmin(a0, b0) + 2), last = (long)floor(fmax(a0, b0) - 2);
  long size = e.flat ? (long)p->width : (long)p->height,
       breadth = e.flat ? (long)p->height : (long)p->width;
  if (first < 0)
    first = 0;
  if (last > size)
    last = size;
  for (long i = first; i < last && e.count < 1024; i++) {
    double guess = a1 + ((double)i + 0.5 - a0) * slope;
    /* the edge moves |slope| within the row; one pixel beyond on each side must be clean */
    long low = (long)floor(guess - 0.5 * fabs(slope)) - 1,
         high = (long)floor(guess + 0.5 * fabs(slope)) + 1;
    if (low < 0 || high >= breadth)
      continue;
    double sum = 0, begin = 0, end = 0;
    for (long j = low; j <= high; j++) {
      double c = e.flat ? coverage(p, channel, i, j) : coverage(p, channel, j, i);
      if (j == low)
        begin = c;
      if (j == high)
        end = c;
      sum += c;
    }
    if (begin > 0.9999 && end < 0.0001)
      e.across[e.count] = (double)low + sum;
    else if (begin < 0.0001 && end > 0.9999)
      e.across[e.count] = (double)high + 1 - sum;
    else
      continue;
    e.along[e.count++] = (double)i + 0.5;
  }
  if (e.count < at_least)
    fail_msg("edge (%.2f %.2f)-(%.2f %.2f): seen in %d rows, wanted %d", a.x, a.y, b.x, b.y,
             e.count, at_least);
  return e;
}

/* across = offset + slope (along - middle), by least squares. */
typedef struct {
  bool flat;
  double middle, offset, slope, length; /* length: rows measured over */
  double worst;                         /* largest residual */
} Line;

static inline Line fit_line(const Edge *e) {
  Line l = {.flat = e->flat};
  double n = e->count, sxx = 0, sxy = 0;
  for (int i = 0; i < e->count; i++) {
    l.middle += e->along[i] / n;
    l.offset += e->across[i] / n;
  }
  for (int i = 0; i < e->count; i++) {
    double x = e->along[i] - l.middle;
    sxx += x * x;
    sxy += x * (e->across[i] - l.offset);
  }
  l.slope = sxy / sxx;
  l.length = e->along[e->count - 1] - e->along[0] + 1;
  for (int i = 0; i < e->count; i++)
    l.worst = fmax(l.worst, fabs(e->across[i] - l.offset - l.slope * (e->along[i] - l.middle)));
  return l;
}

/* Largest and mean distance of the measured positions from the exact line through a and b,
 * along the row. */
static inline void compare_edge(const Edge *e, P2 a, P2 b, double *worst, double *mean) {
  double a0 = e->flat ? a.x : a.y, a1 = e->flat ? a.y : a.x, b0 = e->flat ? b.x : b.y,
         b1 = e->flat ? b.y : b.x;
  *worst = *mean = 0;
  for (int i = 0; i < e->count; i++) {
    double d = e->across[i] - (a1 + (e->along[i] - a0) * (b1 - a1) / (b0 - a0));
    *worst = fmax(*worst, fabs(d));
    *mean += d / e->count;
  }
}

/* The point with the least sum of squared distances to all lines, measured across them. */
static inline P2 meet(const Line *lines, int count) {
  double m[3] = {0, 0, 0}, r[2] = {0, 0};
  for (int i = 0; i < count; i++) {
    /* flat: y - slope x = offset - slope middle; steep: x - slope y = ... */
    double nx = lines[i].flat ? -lines[i].slope : 1, ny = lines[i].flat ? 1 : -lines[i].slope;
    double c = lines[i].offset - lines[i].slope * lines[i].middle, n2 = nx * nx + ny * ny;
    m[0] += nx * nx / n2;
    m[1] += nx * ny / n2;
    m[2] += ny * ny / n2;
    r[0] += nx * c / n2;
    r[1] += ny * c / n2;
  }
  double det = m[0] * m[2] - m[1] * m[1];
  return (P2){(m[2] * r[0] - m[1] * r[1]) / det, (m[0] * r[1] - m[1] * r[0]) / det};
}

#endif
