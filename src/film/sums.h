/* film/sums.h: the film's memory: exact sums of one pixel and the sets they stand in. */
#ifndef FILM_SUMS_H
#define FILM_SUMS_H

#include "base/context.h"
#include "film/film.h"
#include "film/filter.h"

__extension__ typedef __int128 vlInt128;

/* Bits below the point. Colours: |value| < 2^40, |weight| < 2^4, 2^31 samples: 76 bits and the sign above it, 50 below.
 * Weights and alpha: 2^4 2^31 and the sign above it. */
enum { VL_COLOR_BITS = 50, VL_WEIGHT_BITS = 24, VL_ALPHA_BITS = 28 };

/* Sums of weight * channel, and of weight: one cache line. */
typedef struct vlFilmPixel {
  vlInt128 color[3];
  int64_t alpha, weight;
} vlFilmPixel;
_Static_assert(sizeof(vlFilmPixel) == 64, "a pixel's sums are one cache line");

struct vlFilm {
  vlContext *context;
  vlFilmDef def;
  uint32_t width, height; /* of the crop window */
  uint32_t spp;
  vlFilmPixel *front; /* committed; null: all zero */
  vlFilmPixel *back;  /* of the running pass, where stamp == pass; null until the first pass */
  uint32_t *stamp;    /* the pass in which the pixel's back was last written */
  uint32_t pass;      /* counts from 1 */
  bool in_pass;
  vlFilterTable filter;
};

static inline size_t vl_film_pixels(const vlFilm *film) {
  return (size_t)film->width * film->height;
}

#endif
