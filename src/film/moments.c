/* film/moments.c: second moments of a pixel's samples, and the standard errors that follow from them. The sums are
 * exact, so that neither order nor grouping of the samples changes the result. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "film/sums.h"

/* Adds value^2 in units of 2^-VL_SQUARE_BITS: 48 bits of mantissa, shifted to their place among 192 bits. |value| <
 * 2^40: with 2^31 samples the sum stays below 2^191. */
static inline void add_square(uint64_t sum[3], float value) {
  uint32_t bits = vl_float_bits(value);
  int32_t field = (int32_t)(bits >> 23 & 255), exponent = field > 0 ? field : 1;
  uint64_t mantissa = (uint64_t)(bits & 0x7fffffu) | (uint64_t)(field > 0) << 23;
  uint64_t square = mantissa * mantissa;
  int32_t place = 2 * (exponent - 150) + VL_SQUARE_BITS; /* at most 2 * (166 - 150) + 80 = 112 */
  if (place < 0) {
    square = place > -63 ? square >> -place : 0;
    place = 0;
  }
  __extension__ typedef unsigned __int128 Wide;
  Wide low = (Wide)square << place, old = (Wide)sum[1] << 64 | sum[0], now = old + low;
  sum[0] = (uint64_t)now, sum[1] = (uint64_t)(now >> 64);
  sum[2] += (place > 80 ? square >> (128 - place) : 0) + (now < old);
}

void vl_film_add_moments(vlFilm *film, size_t at, bool is_new, const float color[3]) {
  vlFilmMoments *m = &film->moments[1][at];
  if (is_new) *m = film->moments[0][at];
  for (int c = 0; c < 3; c++) {
    m->plain[c] += vl_film_product(color[c], INT64_C(1) << VL_WEIGHT_BITS);
    add_square(m->squares[c], color[c]);
  }
  m->samples++;
}

void vl_film_merge_moments(vlFilm *film, const vlFilm *other) {
  if (!other->moments[0]) return;
  for (size_t i = 0; i < vl_film_pixels(film); i++) {
    vlFilmMoments *to = &film->moments[0][i];
    const vlFilmMoments *from = &other->moments[0][i];
    for (int c = 0; c < 3; c++) {
      to->plain[c] += from->plain[c];
      uint64_t carry = 0;
      for (int k = 0; k < 3; k++) {
        uint64_t sum = to->squares[c][k] + from->squares[c][k], more = sum + carry;
        carry = (sum < from->squares[c][k]) | (more < sum);
        to->squares[c][k] = more;
      }
    }
    to->samples += from->samples;
  }
}

/* The pixel is sum(w v) / sum(w), and |w| is the same in all samples (filters are importance-sampled). To first order
 * the variance of this ratio is sum(w^2 (v - mean)^2) / sum(w)^2, times n / (n - 1) because the mean is estimated from
 * the same samples. Squares are taken about the unweighted mean first, where cancellation is least. */
double vl_film_standard_error(const vlFilm *film, size_t at, int c) {
  if (!film->front) return INFINITY;
  const vlFilmPixel *p = film->front + at;
  const vlFilmMoments *m = film->moments[0] + at;
  double weight = vl_filter_weight(&film->filter);
  if (m->samples < 2 || p->weight <= 0) return INFINITY;
  double n = (double)m->samples, plain = (double)m->plain[c] * 0x1p-50 / n;
  double squares = ldexp((double)m->squares[c][2], 128 - VL_SQUARE_BITS) +
                   ldexp((double)m->squares[c][1], 64 - VL_SQUARE_BITS) +
                   ldexp((double)m->squares[c][0], -VL_SQUARE_BITS);
  double sum_w = (double)p->weight * 0x1p-24, mean = (double)p->color[c] * 0x1p-50 / sum_w;
  double spread = squares - n * plain * plain;
  if (spread < squares * 0x1p-48) spread = 0; /* all samples are equal; the rest is rounding */
  double off = plain - mean, variance = (spread + n * off * off) * (n / (n - 1)) * weight * weight / (sum_w * sum_w);
  return sqrt(variance);
}

vlResult vl_film_errors(const vlFilm *film, const vlDevelopDef *def, vlImage **image) {
  if (image) *image = NULL;
  vlDevelopDef standard = vl_default_develop_def();
  if (!def) def = &standard;
  if (!film || !image || !film->def.errors || def->cookie != VL_COOKIE_DEVELOP) return VL_ERROR_ARGUMENT;
  static const char *const names[3] = {"error.R", "error.G", "error.B"};
  vlImageDef image_def = vl_default_image_def(film->width, film->height, 3);
  image_def.names = names;
  image_def.type = VL_PIXEL_F32;
  vlResult result = vl_image_create(film->context, &image_def, image);
  if (result != VL_OK) return result;
  float *to = vl_image_pixels(*image);
  for (size_t i = 0; i < vl_film_pixels(film); i++)
    for (int c = 0; c < 3; c++) to[3 * i + (size_t)c] = (float)vl_film_standard_error(film, i, c) * def->exposure;
  return VL_OK;
}
