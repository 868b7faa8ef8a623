/* film/film.h: inside of the film. Sums are exact (128-bit fixed point): adding is associative, so no grouping of
 * samples into tiles, passes, threads or machines changes a bit (docs/decisions/0002-exact-film-sums.md). Filter
 * importance sampling: a sample touches one pixel. Data flows samples -> sums -> image. */
#ifndef FILM_FILM_H
#define FILM_FILM_H

#include "base/isa.h"
#include "color/color.h"
#include "velo/render.h"

/* What a batch of samples adds. Channels are linear, in the film's colour space: red, green, blue, alpha. Pixel
 * coordinates are of the whole image, inside the crop window.
 *
 * A sample whose colour, alpha or weight is not finite, or too large for the sums (colour 2^40, weight 16), adds
 * nothing and is counted. Negative colours are added: a few wavelengths of a spectrum are often outside the colour
 * space, and only their mean is inside. Alpha is clamped to [0, 1]. */
typedef struct vlFilmSamples {
  uint32_t n;
  const int32_t *px, *py;
  const float *r, *g, *b, *a;
  const float *weight; /* of the pixel filter: filter value / pdf, may be negative; taken to the nearest 2^-24 */
} vlFilmSamples;

/* Between begin_pass and commit_pass. Returns how many were dropped; *bad_x, *bad_y the first of them (may be null).
 * Concurrent calls must touch different pixels. Up to 2^31 samples a pixel. */
uint32_t vl_film_add(vlFilm *film, const vlFilmSamples *samples, int32_t *bad_x, int32_t *bad_y);

/* The same samples' spectra, before vl_film_add has them: radiance at 4 wavelengths (nm) each, as the scene sends it.
 * For films with buckets. What is not finite is left out, one sample as a whole. */
typedef struct vlFilmSpectra {
  uint32_t n;
  const int32_t *px, *py;
  const float *radiance[4], *lambda[4], *weight;
} vlFilmSpectra;
void vl_film_add_spectra(vlFilm *film, const vlFilmSpectra *samples);

const vlFilmDef *vl_film_def(const vlFilm *film);
/* Row-major, acts on XYZ; null: none. */
const float *vl_film_balance(const vlFilm *film);
/* A measured camera in place of the standard observer: its curves as vl_cie_xyz0 has them, and the matrix from its
 * values to XYZ, white balance included, row-major. */
typedef struct vlFilmSensor {
  float curves[4 * VL_LAMBDA_COUNT];
  float xyz[9];
} vlFilmSensor;
/* Null: the standard observer. */
const vlFilmSensor *vl_film_sensor(const vlFilm *film);
void vl_film_set_spp(vlFilm *film, uint32_t spp); /* called by render after each whole pass */

/* A pass that is given up leaves no trace. Two sets of sums take turns: a pixel's first sample in a pass copies its
 * sums from one set to the other, the rest adds there; commit swaps the sets, abandon forgets the second. Both cost
 * nothing but a look at each pixel's mark. begin_pass: MEMORY (the sets are made when first needed). */
vlResult vl_film_begin_pass(vlFilm *film);
void vl_film_commit_pass(vlFilm *film);
void vl_film_abandon_pass(vlFilm *film);

/* Memory for those who add samples, kept with the film, so that a film that is rendered again and again costs no
 * allocation. Zero when it is new, else as it was left; null: out of memory. Valid until the next call. */
void *vl_film_scratch(vlFilm *film, size_t size);

/* Adds the sums and the sample count of another film of the same size and crop: the same bytes as if all samples had
 * gone into one. Not inside a pass. ARGUMENT when they do not fit, MEMORY. */
vlResult vl_film_merge(vlFilm *film, const vlFilm *other);

/* Pixel filter sampling: u, v in [0,1)^2 to an offset (dx, dy) from the pixel centre, monotone in u and v, and the
 * weight f/pdf: 1 for filters without negative lobes, else plus or minus a constant; its mean is 1. Batch, hot. */
typedef struct vlFilterTable vlFilterTable; /* compiled from vlPixelFilter; owned by the film */
const vlFilterTable *vl_film_filter(const vlFilm *film);
typedef struct vlFilterKernels {
  void (*sample)(const vlFilterTable *filter, uint32_t n, const float *u, const float *v, float *dx, float *dy,
                 float *weight);
} vlFilterKernels;
VL_KERNEL_TABLE(vlFilterKernels, vl_filter)

#endif
