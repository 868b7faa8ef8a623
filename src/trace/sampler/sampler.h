/* trace/sampler/sampler.h: samplers: numbers in [0, 1) that depend only on (seed, pixel, sample index, dimension).
 * Batches: one call fills one dimension (or pair) for n paths. Data flows (pixel, index) -> u.
 *
 * Dimensions count numbers: a 1-D call at dimension d uses d, a 2-D call d and d+1. A dimension is always sampled in
 * the same way (1-D or 2-D).
 *
 *   independent      hashed numbers
 *   regular          centres of equal cells; only their order is random, so that dimensions are not correlated
 *   stratified       one number in each of spp equal cells ("jittered")
 *   nrooks           one in each of spp rows and of spp columns
 *   multi-jittered   one in each cell, row and column (Kensler 2013)
 *   hammersley       (i/n, radical inverse), jittered in x, digits scrambled in y
 *   halton           radical inverses in the primes, Owen-scrambled for each pixel
 *   sobol            Sobol' pairs, Owen-scrambled and shuffled for each pixel and pair (Burley 2020)
 *   zsobol           the same along the Morton curve of the pixels, so that the errors of neighbours differ (Ahmed and
 *                    Wonka 2020): blue noise over the image
 *
 * Stratified kinds make exactly spp cells, for any spp, the length of the sequence. An index of spp or above starts a
 * new, independent set (independent, sobol: continues the sequence). */
#ifndef TRACE_SAMPLER_SAMPLER_H
#define TRACE_SAMPLER_SAMPLER_H

#include "base/isa.h"
#include "velo/scene.h"

/* vl_sample_sequence: counted up whenever a change makes other samples of the same scene and settings. */
enum { VL_SAMPLE_SEQUENCE = 1 };

typedef struct vlSampler {
  vlSamplerKind kind;
  uint32_t seed;
  uint32_t spp;            /* length of the sequence, samples per pixel */
  uint32_t width, height;  /* whole image */
  uint32_t set;            /* samples in a set of the stratified kinds: spp, at most 2^20 */
  uint32_t log2_spp;       /* rounded up; zsobol: index bits below the Morton code */
  uint32_t morton_bits;    /* of the image's Morton codes */
  uint32_t grid_x, grid_y; /* rows of grid_x or (the last grid_y - wide) of grid_x - 1 cells: set cells in all */
  uint32_t wide;           /* number of rows with grid_x cells */
  uint32_t jitter_bits;    /* random bits below a cell's number; cell and jitter together are exact in a float */
} vlSampler;

/* spp: the length of the sequence. Any spp >= 1 is valid for every kind (0 counts as 1). Images up to 65536 x 65536
 * pixels. */
void vl_sampler_init(vlSampler *sampler, vlSamplerKind kind, uint32_t seed, uint32_t width, uint32_t height,
                     uint32_t spp);

/* The length of a sequence where none is given, for a render of spp samples per pixel: constant for the kinds that can
 * go on without end, so that a sample is the same for any spp; spp for those that divide it into cells
 * (docs/decisions/0014-one-sequence.md). */
enum { VL_SEQUENCE_LENGTH = 1 << 16 };
uint32_t vl_sampler_sequence(vlSamplerKind kind, uint32_t spp);

/* px, py: pixel; index: sample index in [0, spp). Arrays hold VL_PAD(n) elements; padding lanes are computed too. */
typedef struct vlSamplerKernels {
  void (*get_1d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                 uint32_t dimension, float *u);
  void (*get_2d)(const vlSampler *sampler, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                 uint32_t dimension, float *u, float *v);
} vlSamplerKernels;
VL_KERNEL_TABLE(vlSamplerKernels, vl_sampler)

#endif
