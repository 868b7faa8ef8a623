/* film/sums.h: the film's memory: the exact sums of one pixel, and the sets of sums. */
#ifndef FILM_SUMS_H
#define FILM_SUMS_H

#include "base/context.h"
#include "film/film.h"
#include "filter/filter.h"
#include "math/approx.h"

__extension__ typedef __int128 vlInt128;

/* Numbers of fraction bits of the sums. Colours have |value| < 2^40, |weight| < 2^4 and up to
 * 2^31 samples: 75 integer bits, a sign and 50 fraction bits. Sums of weights and alpha need 4
 * + 31 integer bits and a sign. */
enum { VL_COLOR_BITS = 50, VL_WEIGHT_BITS = 24, VL_ALPHA_BITS = 28 };
/* Bits of the floats 2^40 and 16: absolute values from these on do not fit. Infinities and NaNs
 * are larger, too. */
enum { VL_MAX_COLOR_FLOAT = (127 + 40) << 23, VL_MAX_WEIGHT_FLOAT = (127 + 4) << 23 };

/* Sums of weight * channel, and of weight: one cache line. */
typedef struct vlFilmPixel {
  vlInt128 color[3];
  int64_t alpha, weight;
} vlFilmPixel;
_Static_assert(sizeof(vlFilmPixel) == 64, "a pixel's sums are one cache line");

/* Additional sums for standard errors. Of all samples: of each channel the unweighted sum and
 * the sum of squares, and the number of samples. Squares are exact, too: 192-bit fixed point,
 * the lowest limb first. Of the samples with indices below vl_first_part(end): the sums of
 * weight * channel and of weight, as in vlFilmPixel. Without padding, since films with errors
 * have one for each pixel. */
enum { VL_SQUARE_BITS = 80 };
__extension__ typedef __int128 vlPackedInt128 __attribute__((aligned(8)));
typedef struct vlFilmMoments {
  vlPackedInt128 plain[3];
  vlPackedInt128 first[3];
  uint64_t squares[3][3];
  uint64_t samples;
  int64_t first_weight;
} vlFilmMoments;
_Static_assert(sizeof(vlFilmMoments) == 184, "the compiler adds no bytes");

/* The index at which the samples of a film divide into two parts, for standard errors; `end`:
 * the index behind the last sample. It is the largest power of two below `end`, so that the
 * first part is a whole point set of a low-discrepancy sequence, and so is the second when it
 * is as large. It depends on `end` only, and a later one is the end of a part: the first part
 * of more samples is either the same or all earlier ones. 0 and 1: no first part. */
static inline uint32_t vl_first_part(uint32_t end) {
  return end > 1 ? 1u << (31 - __builtin_clz(end - 1)) : 0;
}

/* Sums of weight * radiance and of weight for each bucket of each pixel (spectrum.c): the front
 * sums are committed; the back sums belong to the running pass and are valid where stamp ==
 * pass. */
typedef struct vlFilmSpectrum {
  vlInt128 *sums[2]; /* front, back; null: not allocated yet */
  int64_t *weights[2];
  uint32_t *stamp;
} vlFilmSpectrum;

struct vlFilm {
  vlContext *context;
  vlFilmDef def;
  uint32_t width, height; /* of the crop window */
  uint32_t spp;
  uint32_t *block_spp;       /* samples of each block; null: all have spp */
  vlComparedNoise *compared; /* of each block; null: all 0 */
  vlFilmSequence sequence;
  vlFilmPixel *front; /* committed sums; null: all zero */
  /* sums of the running pass, valid where stamp == pass; null until the first pass */
  vlFilmPixel *back;
  uint32_t *stamp; /* the pass in which the pixel's back was last written */
  uint32_t pass;   /* counts from 1 */
  bool in_pass;
  uint32_t end;            /* index behind the last sample of any pixel, with def.errors */
  uint32_t part, pass_end; /* of the running pass: vl_first_part and `end` after it */
  bool part_moves; /* all samples before the running pass belong to the first part after it */
  vlFilmMoments *moments[2]; /* front and back, only with def.errors; valid where the pixel's
                                sums are: without a front, those of the front are zero,
                                whatever the memory holds */
  vlFilmSpectrum spectrum;   /* with def.buckets */
  vlFilterTable filter;
  float balance[9]; /* white balance matrix for XYZ; only with def.white_balance */
  vlFilmSensor *sensor;
  void *scratch; /* memory of vl_film_scratch */
  size_t scratch_size;
};

/* The committed moments of a pixel, in films with errors. */
static inline vlFilmMoments vl_film_front_moments(const vlFilm *film, size_t at) {
  return film->front ? film->moments[0][at] : (vlFilmMoments){0};
}
/* In moments.c. begin: copies a pixel's moments from the front, when it is new in the pass. */
void vl_film_begin_moments(vlFilm *film, size_t at);
/* Makes all samples of a pixel, whose sums are `pixel`, its first part. */
void vl_film_join_parts(vlFilmMoments *moments, const vlFilmPixel *pixel);
/* Adds moments; both have the same first part. */
void vl_film_sum_moments(vlFilmMoments *to, const vlFilmMoments *from);
/* The standard error of channel c of pixel `at`, if its samples were independent: of its linear
 * value, without exposure. Infinite below 2 samples. */
double vl_film_independent_error(const vlFilm *film, size_t at, int c);
/* The share of a pixel's weights that its first part has; 0: there are not two parts. */
double vl_film_first_share(const vlFilm *film, size_t at);
/* The mean of the first part of pixel `at`; its share is above 0. */
double vl_film_first_mean(const vlFilm *film, size_t at, int c);
/* A pixel's value; 0 if the sum of its weights is not positive. */
static inline double vl_film_linear_mean(const vlFilmPixel *p, int c) {
  const double unit = 1.0 / (double)(INT64_C(1) << (VL_COLOR_BITS - VL_WEIGHT_BITS));
  return p->weight > 0 ? (double)p->color[c] / (double)p->weight * unit : 0;
}

/* In spectrum.c. begin: false when out of memory. */
bool vl_film_spectrum_begin(vlFilm *film);
void vl_film_spectrum_commit(vlFilm *film);
void vl_film_spectrum_clear(vlFilm *film);
void vl_film_spectrum_free(vlFilm *film);

/* In develop.c. Sets OpenEXR's dataWindow and displayWindow (inclusive) of a crop's image,
 * which say where it lies in the whole. MEMORY. */
vlResult vl_film_set_window(const vlFilm *film, vlImage *image);

/* value * weight, rounded to the nearest unit of the sum. |value| < 2^40, |weight| <= 2^28
 * (units of 2^-24). */
static inline vlInt128 vl_film_product(float value, int64_t weight) {
  uint32_t bits = vl_float_bits(value);
  int32_t field = (int32_t)(bits >> 23 & 255), exponent = field > 0 ? field : 1;
  /* value = mantissa 2^(exponent - 150) */
  int64_t mantissa = (int64_t)(bits & 0x7fffffu) | (int64_t)(field > 0) << 23;
  int64_t p = (bits >> 31 ? -mantissa : mantissa) * weight;
  int32_t shift = exponent - 150 - VL_WEIGHT_BITS + VL_COLOR_BITS;
  int32_t left = shift > 0 ? shift : 0, right = shift < 0 ? -shift : 0;
  right = right < 62 ? right : 62;
  p = (p + ((INT64_C(1) << right) >> 1)) >> right;
  return (vlInt128)p * (INT64_C(1) << left);
}

/* Adds value^2 in units of 2^-VL_SQUARE_BITS: 48 bits of mantissa, shifted to their bits among
 * 192 bits. |value| < 2^40: with 2^31 samples the sum stays below 2^191. */
static inline void vl_film_add_square(uint64_t sum[3], float value) {
  uint32_t bits = vl_float_bits(value);
  int32_t field = (int32_t)(bits >> 23 & 255), exponent = field > 0 ? field : 1;
  uint64_t mantissa = (uint64_t)(bits & 0x7fffffu) | (uint64_t)(field > 0) << 23;
  uint64_t square = mantissa * mantissa;
  /* at most 2 * (166 - 150) + 80 = 112 */
  int32_t shift = 2 * (exponent - 150) + VL_SQUARE_BITS;
  if (shift < 0) {
    square = shift > -63 ? square >> -shift : 0;
    shift = 0;
  }
  __extension__ typedef unsigned __int128 Wide;
  Wide low = (Wide)square << shift, old = (Wide)sum[1] << 64 | sum[0], now = old + low;
  sum[0] = (uint64_t)now;
  sum[1] = (uint64_t)(now >> 64);
  sum[2] += (shift > 80 ? square >> (128 - shift) : 0) + (now < old);
}

static inline size_t vl_film_pixels(const vlFilm *film) {
  return (size_t)film->width * film->height;
}

#endif
