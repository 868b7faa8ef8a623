/* film/film.h: inside of the film. Sums are exact (128-bit fixed point): adding is associative, so no grouping of samples
 * into tiles, passes, threads or machines changes a bit. Filter importance sampling: a sample touches one pixel. */
#ifndef FILM_FILM_H
#define FILM_FILM_H

#include "base/isa.h"
#include "velo/render.h"

/* What a batch of samples adds. Channels are linear Rec.709... of film space: red, green, blue, alpha. Pixel coordinates
 * are of the whole picture, inside the crop window. Samples with a value that is not finite add nothing and are counted. */
typedef struct vlFilmSamples {
  uint32_t n;
  const int32_t *px, *py;
  const float *r, *g, *b, *a;
  const float *weight; /* of the pixel filter: filter value / pdf, may be negative */
} vlFilmSamples;

/* Returns how many were dropped; *bad_x, *bad_y the first of them (may be null). Concurrent calls must touch different
 * pixels. */
uint32_t vl_film_add(vlFilm *film, const vlFilmSamples *samples, int32_t *bad_x, int32_t *bad_y);

const vlFilmDef *vl_film_def(const vlFilm *film);
vlContext *vl_film_context(const vlFilm *film);
void vl_film_set_spp(vlFilm *film, uint32_t spp); /* called by render after each whole pass */

/* A pass that is given up must leave no trace: begin_pass remembers (cheaply) what end/rollback need. Keep it simple: a pass
 * adds to a second set of sums that commit adds to the first, or a copy; memory is counted. */
vlResult vl_film_begin_pass(vlFilm *film);
void vl_film_commit_pass(vlFilm *film);
void vl_film_abandon_pass(vlFilm *film);

/* Pixel filter sampling: u, v in [0,1)^2 to an offset (dx, dy) from the pixel centre and the weight f/pdf (constant sign for
 * positive filters = 1). Batch, hot. */
typedef struct vlFilterTable vlFilterTable; /* compiled from vlPixelFilter; owned by the film */
const vlFilterTable *vl_film_filter(const vlFilm *film);
typedef struct vlFilterKernels {
  void (*sample)(const vlFilterTable *filter, uint32_t n, const float *u, const float *v, float *dx, float *dy, float *weight);
} vlFilterKernels;
extern const vlFilterKernels vl_filter_kernels_v2, vl_filter_kernels_v3, vl_filter_kernels_v4;
const vlFilterKernels *vl_filter_kernels(vlIsa isa);

#endif
