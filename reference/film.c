/* film.c: sums, means, and how sure they are. */
#include "film.h"

#include "refuse.h"

/* The filter's curve (pbrt book 8.8). */
static double filter_value(const vlPixelFilter *f, double x, double radius) {
  double sigma = (double)f->sigma;
  switch (f->kind) {
    case VL_PIXEL_FILTER_TRIANGLE: return radius - fabs(x);
    case VL_PIXEL_FILTER_GAUSSIAN: return exp(-square(x / sigma) / 2) - exp(-square(radius / sigma) / 2);
    default: return 1; /* a box */
  }
}

/* Points are drawn under the curve: from the rectangle around it, until one lies below it. */
static double sample_curve(const vlPixelFilter *f, double radius, sampler *s) {
  for (;;) {
    double x = (2 * next_number(s) - 1) * radius;
    if (next_number(s) * filter_value(f, 0, radius) < filter_value(f, x, radius)) return x;
  }
}

square_point sample_filter(const view_plane *v, sampler *s) {
  double x = sample_curve(&v->filter, (double)v->filter.radius_x, s);
  double y = sample_curve(&v->filter, (double)v->filter.radius_y, s);
  return (square_point){x, y};
}

bool make_view_plane(const vlSceneDefs *defs, uint32_t samples, view_plane *v, vlError *error) {
  const vlFilmDef *film = &defs->film;
  bool crop = film->crop[2] > film->crop[0] &&
              (film->crop[0] || film->crop[1] || film->crop[2] < film->width || film->crop[3] < film->height);
  if (crop) return refuse(error, (vlSource){0}, "a crop window");
  if (film->white_balance != 0 || film->sensor) return refuse(error, (vlSource){0}, "a film with a sensor");
  if (film->filter.kind > VL_PIXEL_FILTER_GAUSSIAN)
    return refuse_kind(error, (vlSource){0}, "filters", (uint32_t)film->filter.kind);
  *v = (view_plane){.width = film->width, .height = film->height, .samples = samples, .filter = film->filter};
  v->exposure = (double)defs->develop.exposure;
  vl_observer_tabulate(v->eye.xyz);
  vl_color_space_matrix(film->space, v->eye.rgb_from_xyz);
  size_t count = (size_t)v->width * v->height;
  v->pixels = resize(NULL, count, sizeof *v->pixels);
  for (size_t i = 0; i < count; i++) v->pixels[i] = (pixel){0};
  return true;
}

void add_sample(view_plane *v, uint32_t column, uint32_t row, spectrum radiance, const wavelengths *lambda,
                bool covered) {
  double rgb[3];
  radiance_to_rgb(&v->eye, radiance, lambda, rgb);
  pixel *p = &v->pixels[(size_t)row * v->width + column];
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
    for (size_t k = 0; k < 3; k++) {
      double mean = p->sum[k] / n;
      double variance = n > 1 ? fmax(0, p->squares[k] / n - mean * mean) / (n - 1) : (double)INFINITY;
      out[7 * i + k] = (float)(v->exposure * mean);
      out[7 * i + 4 + k] = (float)(v->exposure * sqrt(variance));
    }
    out[7 * i + 3] = (float)(p->covered / n);
  }
  return true;
}
