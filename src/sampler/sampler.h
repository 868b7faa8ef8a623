/* sampler/sampler.h: samplers: numbers in [0, 1) that depend only on (seed, pixel, sample
 * index, dimension). One call fills one dimension, or a pair of dimensions, for a batch of n
 * paths.
 *
 * A 1-D call at dimension d uses dimension d; a 2-D call uses d and d + 1. A dimension is
 * always used in the same way, 1-D or 2-D.
 *
 *   independent      hashed numbers
 *   regular          centres of equal cells; only their order is random, so that dimensions are
 *                    not correlated
 *   stratified       one number in each of spp equal cells ("jittered")
 *   nrooks           one in each of spp rows and of spp columns
 *   multi-jittered   one in each cell, row and column (Kensler 2013)
 *   hammersley       (i/n, radical inverse), jittered in x, digits scrambled in y
 *   halton           radical inverses in the primes, Owen-scrambled for each pixel
 *   sobol            Sobol' pairs, Owen-scrambled and shuffled for each pixel and pair (Burley
 *                    2020)
 *   zsobol           the same along the Morton curve of the pixels, so that the errors of
 *                    neighbours differ (Ahmed and Wonka 2020): blue noise over the image
 *
 * Kinds with cells make exactly spp cells, for any spp, where spp is the length of the
 * sequence. Sample indices from spp on belong to new, independent sets; for independent and
 * sobol they continue the sequence. */
#ifndef SAMPLER_SAMPLER_H
#define SAMPLER_SAMPLER_H

#include <stdatomic.h>

#include "base/isa.h"
#include "velo/own.h"

/* Version of the samples, which vl_sample_sequence returns. It is increased whenever a change
 * of the code gives other samples for the same scene and settings. */
enum { VL_SAMPLE_SEQUENCE = 2 };

typedef struct vlSampler {
  uint32_t kind; /* vlSamplerKind */
  uint32_t seed;
  uint32_t spp; /* length of the sequence, samples per pixel */
  uint32_t set; /* number of samples in a set of the kinds with cells: spp, at most 2^20 */
  /* log2(spp), rounded up; zsobol: number of index bits below the Morton code */
  uint32_t log2_spp;
  uint32_t morton_bits;    /* number of bits of the image's Morton codes */
  uint32_t grid_x, grid_y; /* number of columns and rows; the last grid_y - wide rows have
                              grid_x - 1 cells, so there are `set` cells in all */
  uint32_t wide;           /* number of rows with grid_x cells */
  /* gives the numbers in place of kind; null: none. vl_sampler_init makes it null */
  const vlOwnSampler *own;
  _Atomic uint64_t *own_bad; /* counts its numbers outside [0, 1); may be null */
  /* number of random bits below a cell's number; a float holds both exactly */
  uint32_t jitter_bits;
} vlSampler;

/* Initialises a sampler. spp: the length of the sequence; every kind accepts any spp >= 1, and
 * 0 counts as 1. Images may have up to 65536 x 65536 pixels. */
void vl_sampler_init(vlSampler *sampler, uint32_t kind, uint32_t seed, uint32_t width,
                     uint32_t height, uint32_t spp);

/* The default length of a sequence, for a render of spp samples per pixel. For kinds with cells
 * it is spp. For kinds that can go on without end it is constant, so that a sample is the same
 * for any spp (docs/decisions/0014-one-sequence.md). */
enum { VL_SEQUENCE_LENGTH = 1 << 16 };
uint32_t vl_sampler_sequence(uint32_t kind, uint32_t spp);

/* px, py: pixel; index: sample index in [0, spp). Arrays hold VL_PAD(n) elements; padding lanes
 * are computed too. */
typedef struct vlSamplerKernels {
  void (*get_1d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py,
                 const uint32_t *index, uint32_t dimension, float *u);
  void (*get_2d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py,
                 const uint32_t *index, uint32_t dimension, float *u, float *v);
  /* As get_2d, for a pair that is well distributed together with the pair of the 2-D call at
   * dimension `with`: sobol and zsobol take four dimensions of one Sobol' sequence. Other
   * kinds: as get_2d. At most one pair for each `with`. */
  void (*get_2d_with)(const vlSampler *sampler, uint32_t n, const int32_t *px,
                      const int32_t *py, const uint32_t *index, uint32_t dimension,
                      uint32_t with, float *u, float *v);
} vlSamplerKernels;
VL_KERNEL_TABLE(vlSamplerKernels, vl_sampler)

/* The numbers of sampler->own; v null: 1-D. In own.c. */
void vl_own_numbers(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py,
                    const uint32_t *index, uint32_t dimension, float *u, float *v);

#endif
