/* film/film.h: private interface of the film. Sums are exact (128-bit fixed point). Addition is
 * associative, so that no grouping of samples into tiles, passes, threads or machines changes a
 * bit (docs/decisions/0002-exact-film-sums.md). A sample contributes to every pixel whose
 * filter covers it (docs/decisions/0017-shared-samples.md); without shared samples
 * (vlRenderDef.share_samples), to its own pixel. Data flows samples -> sums -> image. */
#ifndef FILM_FILM_H
#define FILM_FILM_H

#include "base/isa.h"
#include "color/color.h"
#include "velo/own.h"
#include "velo/render.h"

/* A batch of samples. Channels are linear, in the film's colour space: red, green, blue, alpha.
 * Pixel coordinates are of the whole image, inside the crop window.
 *
 * A sample whose colour, alpha or weight is not finite, or too large for the sums (colour 2^40,
 * weight 16), adds nothing and is counted. Negative colours are added: single samples of a few
 * wavelengths are often outside the colour space, and only their mean is inside. Alpha is
 * clamped to [0, 1]. */
typedef struct vlFilmSamples {
  uint32_t n;
  const int32_t *px, *py;
  const float *r, *g, *b, *a;
  const float *weight; /* of the pixel filter: filter value / pdf, may be negative; rounded to a
                          multiple of 2^-24 */
  const uint32_t *index; /* of the samples in their sequence; read in films with errors; null:
                            behind all others */
} vlFilmSamples;

/* Adds samples; between begin_pass and commit_pass. Returns the number of dropped samples;
 * *bad_x, *bad_y (may be null) are the pixel of the first. Concurrent calls must add to
 * different pixels. Up to 2^31 samples per pixel. */
uint32_t vl_film_add(vlFilm *film, const vlFilmSamples *samples, int32_t *bad_x,
                     int32_t *bad_y);

/* The spectra of the same samples, added before vl_film_add: the scene's radiance at 4
 * wavelengths (nm) each, without the film's exposure. For films with buckets. A sample with a
 * value that is not finite is dropped as a whole. */
typedef struct vlFilmSpectra {
  uint32_t n;
  const int32_t *px, *py;
  const float *radiance[4], *lambda[4], *weight;
} vlFilmSpectra;
void vl_film_add_spectra(vlFilm *film, const vlFilmSpectra *samples);

const vlFilmDef *vl_film_def(const vlFilm *film);
/* The white balance: a row-major 3x3 matrix that acts on XYZ; null: none. */
const float *vl_film_balance(const vlFilm *film);
/* A measured camera sensor in place of the standard observer: its response curves, sampled as
 * vl_cie_xyz0, and the row-major matrix from its values to XYZ, white balance included. */
typedef struct vlFilmSensor {
  float curves[4 * VL_LAMBDA_COUNT];
  float xyz[9];
} vlFilmSensor;
/* The film's sensor; null: the standard observer. */
const vlFilmSensor *vl_film_sensor(const vlFilm *film);
/* of all blocks; render calls it after each whole pass */
void vl_film_set_spp(vlFilm *film, uint32_t spp);

/* Whether a crop window x0, y0, x1, y1 has pixels, all of them within the image. */
static inline bool vl_crop_fits(const uint32_t crop[4], uint32_t width, uint32_t height) {
  return crop[0] < crop[2] && crop[1] < crop[3] && crop[2] <= width && crop[3] <= height;
}
/* Blocks: the cells of a grid over the whole image, 32 x 32 pixels each, clipped to a window
 * x0, y0, x1, y1 and numbered row by row. A film's blocks are those of its crop. All pixels of
 * a block have the same number of samples. */
enum { VL_FILM_BLOCK = 32 };
uint32_t vl_film_block_count(const uint32_t window[4]);
void vl_film_block_window(const uint32_t window[4], uint32_t index, uint32_t area[4]);
/* The block with a pixel of the window. */
uint32_t vl_film_block_at(const uint32_t window[4], uint32_t x, uint32_t y);
/* The number of samples of a block. It is at most vl_film_spp, which some block has. */
uint32_t vl_film_block_spp(const vlFilm *film, uint32_t block);
/* Sets it, to at least the present number, between passes. Error: MEMORY. */
vlResult vl_film_set_block_spp(vlFilm *film, uint32_t block, uint32_t spp);
/* Whether blocks have different numbers of samples. */
bool vl_film_is_adaptive(const vlFilm *film);

/* The noise of a block when adaptive sampling last compared it with the threshold
 * (render/adaptive.h), with the number of samples that it had then and the view that made the
 * display values: the view's kind, and the factor on the linear values. spp 0: it was never
 * compared. Film files hold it as it is in memory. */
typedef struct vlComparedNoise {
  uint32_t spp;
  float noise, factor;
  uint32_t view;
} vlComparedNoise;
/* One per block. Kept with the film; null: out of memory. */
vlComparedNoise *vl_film_compared(vlFilm *film);
/* Sets them back to 0, for samples that adaptive sampling did not choose. */
void vl_film_forget_compared(vlFilm *film);

/* The factor on the linear values that an exposure (as vl_image_view's) and a further factor
 * make together. */
double vl_film_view_factor(float exposure, float scale);

/* The noise of a block: an upper bound of the root mean square of the standard errors of its
 * display values (0 black, 1 white; all pixels, three channels). view: as vl_image_view's;
 * exposure, scale: as above; correlation: the sum of the squared correlations of a pixel's
 * error with those of all pixels, itself included, so 1 where they are independent. For films
 * with errors; infinite below 2 samples. */
double vl_film_block_noise(const vlFilm *film, uint32_t block, vlView view, float exposure,
                           float scale, double correlation);
/* Sets the block's vlComparedNoise to the above. After vl_film_compared. Different blocks at
 * the same time. */
void vl_film_compare_block(vlFilm *film, uint32_t block, vlView view, float exposure,
                           float scale, double correlation);

/* The standard errors of vl_film_errors for the pixels of a window x0, y0, x1, y1 of the whole
 * image inside of the crop, whose edges are multiples of 8 or the crop's. to: three floats for
 * each pixel of the film, `step` floats from one pixel to the next, rows from the top. For
 * films with errors. Different windows at the same time. */
void vl_film_window_errors(const vlFilm *film, const uint32_t window[4],
                           const vlDevelopDef *def, float *to, size_t step);

/* The names of the code of one's own (velo/own.h) that made a film's samples, by vlOwnKind;
 * empty: velo's own. */
typedef struct vlFilmOwn {
  char name[VL_OWN_KINDS][VL_OWN_NAME];
} vlFilmOwn;
/* "camera", "sampler", "tracer". */
extern const char *const vl_own_words[VL_OWN_KINDS];
/* The first kind whose names differ; VL_OWN_KINDS: none. */
vlOwnKind vl_film_own_differs(const vlFilmOwn *a, const vlFilmOwn *b);

/* The sequence that a film's samples are from: its length, and the index of the film's first
 * sample. Set before the first sample; a film without samples has length 0. */
typedef struct vlFilmSequence {
  uint32_t length, first;
  bool uneven; /* a film read from a file whose pixels have different samples: it can only be
                  developed */
  vlFilmOwn own;
} vlFilmSequence;
vlFilmSequence vl_film_sequence(const vlFilm *film);
void vl_film_set_sequence(vlFilm *film, vlFilmSequence sequence);

/* An abandoned pass leaves no trace. There are two sets of sums: a pixel's first sample in a
 * pass copies its sums from the front set to the back set, and the pass adds there; commit
 * swaps the sets, abandon drops the back set. The only cost is one test of the pixel's stamp.
 * Error of begin_pass: MEMORY (the sets are allocated at first need). */
vlResult vl_film_begin_pass(vlFilm *film);
/* The indices of the samples that the pass adds: first to end - 1, the same in all pixels that
 * get samples. They come after all samples that these pixels have. After vl_film_begin_pass,
 * for films with errors. */
void vl_film_set_pass_samples(vlFilm *film, uint32_t first, uint32_t end);
/* A pixel of the running pass that gets no sample of an index which the others get. */
void vl_film_miss(vlFilm *film, int32_t x, int32_t y);
void vl_film_commit_pass(vlFilm *film);
void vl_film_abandon_pass(vlFilm *film);

/* Memory for the code that adds samples. It is kept with the film, so that repeated renders of
 * one film allocate nothing. Zeroed when new, and when the size differs from that of the last
 * call; else unchanged since that call. Null: out of memory. Valid until the next call. */
void *vl_film_scratch(vlFilm *film, size_t size);

/* Pixel filter sampling: u, v in [0,1)^2 to an offset (dx, dy) from the pixel centre, monotone
 * in u and v, and the weight f/pdf: 1 for filters without negative lobes, else plus or minus a
 * constant; its mean is 1. Batch, hot. */
typedef struct vlFilterTable vlFilterTable; /* compiled from vlPixelFilter; owned by the film */
const vlFilterTable *vl_film_filter(const vlFilm *film);
typedef struct vlFilterCurve vlFilterCurve;
typedef struct vlFilterKernels {
  void (*sample)(const vlFilterTable *filter, uint32_t n, const float *u, const float *v,
                 float *dx, float *dy, float *weight);
  /* out[i] = vl_filter_curve_at(curve, at[i] - shift), for VL_PAD(n) elements. */
  void (*curve)(const vlFilterCurve *curve, uint32_t n, const float *at, float shift,
                float *out);
} vlFilterKernels;
VL_KERNEL_TABLE(vlFilterKernels, vl_filter)

#endif
