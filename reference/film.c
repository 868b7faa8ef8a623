/* film.c: the view plane and its pixels: sums of samples, their means, and how sure the means are. */
#include "world.h"

view_plane make_view_plane(const vlSceneDefs *defs, uint32_t samples) {
  view_plane v = {.width = defs->film.width, .height = defs->film.height, .samples = samples};
  v.filter = defs->film.filter;
  v.exposure = (double)defs->develop.exposure;
  vl_observer_tabulate(v.eye.xyz);
  vl_color_space_matrix(defs->film.space, v.eye.rgb_from_xyz);
  size_t count = (size_t)v.width * v.height;
  v.pixels = resize(NULL, count, sizeof *v.pixels);
  for (size_t i = 0; i < count; i++) v.pixels[i] = (pixel){0};
  return v;
}

/* How much a point at x from the middle of the pixel counts (pbrt book 8.8); y has the same curve. */
static double filter_value(const vlPixelFilter *f, double x, double radius) {
  if (f->kind == VL_PIXEL_FILTER_TRIANGLE) return radius - fabs(x);
  if (f->kind == VL_PIXEL_FILTER_BOX) return 1;
  return exp(-square(x / (double)f->sigma) / 2) - exp(-square(radius / (double)f->sigma) / 2);
}

/* Darts are thrown into the rectangle around the curve, until one lands below the curve (pbrt book A.3). */
static double sample_curve(const vlPixelFilter *f, double radius, sampler *s) {
  for (;;) {
    double x = (2 * next_number(s) - 1) * radius;
    double height = next_number(s) * filter_value(f, 0, radius);
    if (height < filter_value(f, x, radius)) return x;
  }
}

square_point sample_filter(const view_plane *v, sampler *s) {
  double x = sample_curve(&v->filter, (double)v->filter.radius_x, s);
  double y = sample_curve(&v->filter, (double)v->filter.radius_y, s);
  return (square_point){x, y};
}

void add_sample(view_plane *v, uint32_t column, uint32_t row, spectrum radiance, const wavelengths *lambda, bool met) {
  double rgb[3];
  radiance_to_rgb(&v->eye, radiance, lambda, rgb);
  pixel *p = &v->pixels[(size_t)row * v->width + column];
  for (int k = 0; k < 3; k++) {
    p->sum[k] += rgb[k];
    p->squares[k] += square(rgb[k]);
  }
  p->covered += met;
}

/* The variance of n samples x is estimated by n / (n - 1) (mean(x^2) - mean(x)^2); that of their mean is 1 / n of it,
 * and its root is the standard error. */
bool make_image(const view_plane *v, vlContext *context, vlImage **image) {
  static const char *const names[7] = {"R", "G", "B", "A", "error.R", "error.G", "error.B"};
  vlImageDef def = vl_default_image_def(v->width, v->height, 7);
  def.names = names;
  if (vl_image_create(context, &def, image) != VL_OK) return false;
  float *out = vl_image_pixels(*image);
  double n = v->samples;
  for (const pixel *p = v->pixels; p < v->pixels + (size_t)v->width * v->height; p++, out += 7) {
    for (int k = 0; k < 3; k++) {
      double mean = p->sum[k] / n;
      double variance_of_mean = n > 1 ? fmax(0, p->squares[k] / n - mean * mean) / (n - 1) : (double)INFINITY;
      out[k] = (float)(v->exposure * mean);
      out[4 + k] = (float)(v->exposure * sqrt(variance_of_mean));
    }
    out[3] = (float)(p->covered / n);
  }
  return true;
}
