/* film/spectrum.c: spectra in addition to colours: buckets of wavelengths of equal width, each
 * with its own exact sums (docs/decisions/0002-exact-film-sums.md). Wavelengths are sampled
 * uniformly (trace), so that the mean of the samples in a bucket is the mean over the
 * bucket. */
#include <stdio.h>
#include <string.h>

#include "base/free.h"
#include "color/color.h"
#include "film/sums.h"
#include "velo/image.h"

static size_t cells(const vlFilm *film) {
  return vl_film_pixels(film) * film->def.buckets;
}

static bool make(vlFilm *film, int set) {
  vlFilmSpectrum *s = &film->spectrum;
  if (!s->sums[set])
    s->sums[set] = vl_alloc_zero(film->context, cells(film), sizeof *s->sums[set]);
  if (!s->weights[set])
    s->weights[set] = vl_alloc_zero(film->context, cells(film), sizeof *s->weights[set]);
  return s->sums[set] && s->weights[set];
}

bool vl_film_spectrum_begin(vlFilm *film) {
  vlFilmSpectrum *s = &film->spectrum;
  if (!film->def.buckets)
    return true;
  if (!s->stamp)
    s->stamp = vl_alloc_zero(film->context, vl_film_pixels(film), sizeof *s->stamp);
  return s->stamp && make(film, 0) && make(film, 1);
}

static void copy_pixel(const vlFilm *film, size_t at) {
  const vlFilmSpectrum *s = &film->spectrum;
  size_t n = film->def.buckets, first = at * n;
  memcpy(s->sums[1] + first, s->sums[0] + first, n * sizeof *s->sums[0]);
  memcpy(s->weights[1] + first, s->weights[0] + first, n * sizeof *s->weights[0]);
}

void vl_film_add_spectra(vlFilm *film, const vlFilmSpectra *a) {
  vlFilmSpectrum *s = &film->spectrum;
  uint32_t width = film->width, n = film->def.buckets;
  double low = film->def.lambda_min, scale = n / (film->def.lambda_max - film->def.lambda_min);
  for (uint32_t i = 0; i < a->n; i++) {
    uint32_t x = (uint32_t)a->px[i] - film->def.crop[0],
             y = (uint32_t)a->py[i] - film->def.crop[1];
    float w = a->weight[i];
    uint32_t largest = 0;
    for (int c = 0; c < 4; c++) {
      uint32_t bits = vl_float_bits(a->radiance[c][i]) & 0x7fffffffu;
      largest = bits > largest ? bits : largest;
    }
    if (largest >= VL_MAX_COLOR_FLOAT ||
        (vl_float_bits(w) & 0x7fffffffu) >= VL_MAX_WEIGHT_FLOAT || x >= width ||
        y >= film->height || !film->in_pass)
      continue; /* vl_film_add counts it */
    size_t at = (size_t)y * width + x;
    if (s->stamp[at] != film->pass) {
      s->stamp[at] = film->pass;
      copy_pixel(film, at);
    }
    int64_t weight = (int64_t)((double)w * (1 << VL_WEIGHT_BITS) + (w < 0.0f ? -0.5 : 0.5));
    for (int c = 0; c < 4; c++) {
      double position = ((double)a->lambda[c][i] - low) * scale;
      uint32_t bucket = position > 0 ? (uint32_t)position : 0;
      size_t cell = at * n + (bucket < n ? bucket : n - 1);
      s->sums[1][cell] += vl_film_product(a->radiance[c][i], weight);
      s->weights[1][cell] += weight;
    }
  }
}

void vl_film_spectrum_commit(vlFilm *film) {
  vlFilmSpectrum *s = &film->spectrum;
  if (!film->def.buckets)
    return;
  for (size_t i = 0; i < vl_film_pixels(film); i++)
    if (s->stamp[i] != film->pass)
      copy_pixel(film, i);
  vlInt128 *sums = s->sums[0];
  int64_t *weights = s->weights[0];
  s->sums[0] = s->sums[1];
  s->weights[0] = s->weights[1];
  s->sums[1] = sums;
  s->weights[1] = weights;
}

void vl_film_spectrum_clear(vlFilm *film) {
  vlFilmSpectrum *s = &film->spectrum;
  if (s->sums[0])
    memset(s->sums[0], 0, cells(film) * sizeof *s->sums[0]);
  if (s->weights[0])
    memset(s->weights[0], 0, cells(film) * sizeof *s->weights[0]);
}

void vl_film_spectrum_free(vlFilm *film) {
  vlFilmSpectrum *s = &film->spectrum;
  for (int i = 0; i < 2; i++) {
    VL_FREE(film->context, s->sums[i], s->weights[i]);
  }
  vl_free(film->context, s->stamp);
}

/* ---- develop ----------------------------------------------------------------------------- */

/* "S0.374,688nm": the middle of the bucket. The decimal sign is a comma, since a point
 * separates layers. */
static void bucket_name(const vlFilm *film, uint32_t i, char name[32]) {
  const vlFilmDef *d = &film->def;
  snprintf(name, 32, "S0.%.3fnm",
           d->lambda_min + (i + 0.5) / d->buckets * (d->lambda_max - d->lambda_min));
  char *point = strchr(name + 3, '.');
  if (point)
    *point = ',';
}

static vlResult make_image(const vlFilm *film, vlImage **image) {
  uint32_t n = film->def.buckets;
  char(*text)[32] = vl_alloc_array(film->context, n, sizeof *text);
  const char **names = vl_alloc_array(film->context, n, sizeof *names);
  vlResult result = text && names ? VL_OK : VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < n && result == VL_OK; i++) {
    bucket_name(film, i, text[i]);
    names[i] = text[i];
  }
  vlImageDef def = vl_default_image_def(film->width, film->height, n);
  def.names = names;
  def.type = VL_PIXEL_F32;
  def.encoding = VL_ENCODING_LINEAR;
  if (result == VL_OK)
    result = vl_image_create(film->context, &def, image);
  VL_FREE(film->context, text, names);
  static const vlAttribute attributes[2] = {
      {.name = "spectralLayoutVersion", .type = VL_ATTRIBUTE_STRING, .string = "1.0"},
      {.name = "emissiveUnits", .type = VL_ATTRIBUTE_STRING, .string = "W.m^-2.sr^-1"}};
  for (int i = 0; i < 2 && result == VL_OK; i++)
    result = vl_image_set_attribute(*image, &attributes[i]);
  return result == VL_OK ? vl_film_set_window(film, *image) : result;
}

/* The integral of the standard observer's Y, by which lights are normalised. */
static double y_integral(void) {
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    sum += (double)vl_cie_y()[i];
  return sum;
}

/* Buckets of a pixel to which no sample came get what lies between those beside them, or the
 * value of the only one beside them: 0 would make the light of few samples too dark. A pixel
 * without samples stays 0. weights: those of the pixel. */
static void fill_empty(const int64_t *weights, uint32_t count, float *values) {
  uint32_t done = 0; /* buckets before it have values */
  for (uint32_t i = 0; i < count; i++) {
    if (weights[i] <= 0)
      continue;
    const float before = values[done ? done - 1 : i], steps = (float)(i - done + 1);
    for (uint32_t k = done; k < i; k++)
      values[k] = before + (values[i] - before) * (float)(k - done + 1) / steps;
    done = i + 1;
  }
  for (uint32_t k = done; done && k < count; k++)
    values[k] = values[done - 1];
}

vlResult vl_film_spectrum(const vlFilm *film, vlImage **image) {
  if (!image)
    return VL_ERROR_ARGUMENT;
  *image = NULL;
  if (!film || !film->def.buckets)
    return VL_ERROR_ARGUMENT;
  vlResult result = make_image(film, image);
  if (result != VL_OK) {
    vl_image_destroy(*image);
    *image = NULL;
    return result;
  }
  const vlFilmSpectrum *s = &film->spectrum;
  float *out = vl_image_pixels(*image);
  double unit = y_integral() / (double)(INT64_C(1) << (VL_COLOR_BITS - VL_WEIGHT_BITS));
  for (size_t i = 0; s->sums[0] && s->weights[0] && i < cells(film); i++)
    if (s->weights[0][i] > 0)
      out[i] = (float)((double)s->sums[0][i] / (double)s->weights[0][i] * unit);
  const uint32_t n = film->def.buckets;
  for (size_t i = 0; s->weights[0] && i < cells(film); i += n)
    fill_empty(s->weights[0] + i, n, out + i);
  return VL_OK;
}
