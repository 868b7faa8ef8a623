/* film.c: sums, means, and how sure they are. */
#include "film.h"

#include <stdlib.h>

#include "refuse.h"

/* ---- the pixel's filter (pbrt book 8.8) -------------------------------------------------------------------------- */

static double gaussian(double x, double sigma) {
  return exp(-x * x / (2 * sigma * sigma)) / (sqrt(2 * PI) * sigma);
}

static double mitchell(double x, double b, double c) {
  x = fabs(2 * x);
  if (x <= 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x <= 2)
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
  return 0;
}

static double filter_value(const vlPixelFilter *f, double x, double radius) {
  double sigma = (double)f->sigma;
  switch (f->kind) {
    case VL_PIXEL_FILTER_BOX: return 1;
    case VL_PIXEL_FILTER_TRIANGLE: return radius - fabs(x);
    case VL_PIXEL_FILTER_GAUSSIAN: return gaussian(x, sigma) - gaussian(radius, sigma);
    case VL_PIXEL_FILTER_MITCHELL: return mitchell(x / radius, (double)f->b, (double)f->c);
    default: return 0;
  }
}

static double filter_at(const vlPixelFilter *f, double x, double y) {
  return filter_value(f, x, (double)f->radius_x) * filter_value(f, y, (double)f->radius_y);
}

static double integral_of(const vlPixelFilter *f, double radius) {
  enum { STEPS = 10000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) sum += filter_value(f, radius * ((2 * i + 1.0) / STEPS - 1), radius);
  return sum * 2 * radius / STEPS;
}

/* Points are drawn evenly from the filter's square; the weight is the filter's value over its mean. */
square_point sample_filter(const view_plane *v, sampler *s, double *weight) {
  double rx = (double)v->filter.radius_x, ry = (double)v->filter.radius_y;
  square_point u = sample_unit_square(s);
  square_point at = {(2 * u.x - 1) * rx, (2 * u.y - 1) * ry};
  *weight = filter_at(&v->filter, at.x, at.y) * 4 * rx * ry / v->filter_integral;
  return at;
}

/* ---- the film ---------------------------------------------------------------------------------------------------- */

bool make_view_plane(const vlSceneDefs *defs, uint32_t samples, view_plane *v, vlError *error) {
  const vlFilmDef *film = &defs->film;
  bool crop = film->crop[2] > film->crop[0] &&
              (film->crop[0] || film->crop[1] || film->crop[2] < film->width || film->crop[3] < film->height);
  if (crop) return refuse(error, (vlSource){0}, "a crop window", NULL);
  if (film->white_balance != 0 || film->sensor) return refuse(error, (vlSource){0}, "a film with a sensor", NULL);
  if (film->filter.kind > VL_PIXEL_FILTER_MITCHELL)
    return refuse_kind(error, (vlSource){0}, "filters", (uint32_t)film->filter.kind);
  *v = (view_plane){.width = film->width, .height = film->height, .samples = samples, .filter = film->filter};
  v->space = film->space;
  v->exposure = (double)defs->develop.exposure;
  v->filter_integral =
      integral_of(&v->filter, (double)v->filter.radius_x) * integral_of(&v->filter, (double)v->filter.radius_y);
  v->pixels = calloc((size_t)v->width * v->height, sizeof *v->pixels);
  return v->pixels || refuse_memory(error);
}

void add_sample(view_plane *v, uint32_t x, uint32_t y, const double rgb[3], bool covered) {
  pixel *p = &v->pixels[(size_t)y * v->width + x];
  for (int k = 0; k < 3; k++) {
    p->sum[k] += rgb[k];
    p->squares[k] += square(rgb[k]);
  }
  p->covered += covered;
}

/* The variance of a mean of n independent samples is their variance / n. */
bool make_image(const view_plane *v, vlContext *context, vlImage **image) {
  static const char *const names[7] = {"R", "G", "B", "A", "error.R", "error.G", "error.B"};
  vlImageDef def = vl_default_image_def(v->width, v->height, 7);
  def.names = names;
  if (vl_image_create(context, &def, image) != VL_OK) return false;
  float *out = vl_image_pixels(*image);
  double n = v->samples;
  for (size_t i = 0; i < (size_t)v->width * v->height; i++) {
    const pixel *p = &v->pixels[i];
    for (int k = 0; k < 3; k++) {
      double mean = p->sum[k] / n;
      double variance = n > 1 ? fmax(0, p->squares[k] / n - mean * mean) / (n - 1) : INFINITY;
      out[7 * i + (size_t)k] = (float)(v->exposure * mean);
      out[7 * i + 4 + (size_t)k] = (float)(v->exposure * sqrt(variance));
    }
    out[7 * i + 3] = (float)(p->covered / n);
  }
  return true;
}
