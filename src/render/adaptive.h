/* render/adaptive.h: which blocks of the film get samples in the next pass.
 *
 * All blocks of a pass begin with the same sample. Without a noise threshold, the blocks with
 * the fewest samples go first until all have the wanted number; in a new film these are all
 * blocks in every pass.
 *
 * With a threshold, the noise of a block (vl_film_block_noise) is compared when the block has
 * 8, 12, 16, 24, 32, 48, 64, ... samples. A block whose noise will be below the threshold at
 * the next of these numbers ends there, or at the least number n * 2^k (n from 8 to 15) before
 * it that suffices. This is two-stage sampling (Stein 1945): a block ends early where its
 * samples happen to be alike, which makes it a little darker than it should be; the samples
 * after the decision know nothing of it.
 *
 * The decision depends on the block's own sums at the numbers where it was compared, and on
 * nothing else. So neither the division into passes and calls, nor the threads, nor the other
 * blocks change the image. The film keeps the last comparison of each block (vlComparedNoise)
 * with its sums, in files, too, so that it can be continued. */
#ifndef RENDER_ADAPTIVE_H
#define RENDER_ADAPTIVE_H

#include "film/film.h"
#include "velo/render.h"

typedef struct vlAdaptive {
  vlContext *context;
  vlFilm *film;
  double noise; /* threshold; 0: none */
  vlView view;
  float exposure, scale;
  double correlation; /* as in vl_film_block_noise */
  uint32_t blocks;
  uint32_t rows; /* of pixels, which a pass covers at most; 0: all */
  uint32_t *end; /* of each block: the samples at which it ends; UINT32_MAX: not known yet */
  vlComparedNoise *compared; /* the film's, of each block; null without a threshold */
  uint8_t *pass;             /* of each block: it gets samples in this pass */
  uint32_t in_pass;
} vlAdaptive;

/* Compares the blocks that have a number of samples listed above, unless the film's comparison
 * still holds. Error: MEMORY. */
vlResult vl_adaptive_create(vlAdaptive *a, vlContext *context, vlFilm *film,
                            const vlRenderDef *def, double correlation);
void vl_adaptive_destroy(vlAdaptive *a);

/* Chooses the blocks of the next pass: those with *first samples, and at most *count more, so
 * that none gets more than `total`. False: no block needs samples. */
bool vl_adaptive_next(vlAdaptive *a, uint32_t total, uint32_t *first, uint32_t *count);
/* Whether a pixel gets samples in this pass. */
bool vl_adaptive_has(const vlAdaptive *a, uint32_t x, uint32_t y);
/* After a committed pass of `count` samples: counts them, and compares the blocks. Error:
 * MEMORY. */
vlResult vl_adaptive_end_pass(vlAdaptive *a, uint32_t count);

/* Samples per pixel, the mean over the blocks: those of the film, and an estimate of those at
 * the end. The error falls as the square root of the number of samples. */
double vl_adaptive_mean_spp(const vlAdaptive *a);
double vl_adaptive_expected_spp(const vlAdaptive *a, uint32_t total);
/* The rows of the film, from its top, whose pixels have as many samples as any. */
uint32_t vl_adaptive_rows(const vlAdaptive *a);
/* The number of blocks that did not get the samples that they need. */
uint32_t vl_adaptive_noisy(const vlAdaptive *a);

#endif
