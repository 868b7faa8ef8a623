/* sampler/sampler.case.h: what the tests of samplers must know of a kind beyond its row
 * (test/conformance/sampling.h: 64 samples of each of 64 pixels). */
#ifndef SAMPLER_SAMPLER_CASE_H
#define SAMPLER_SAMPLER_CASE_H

#include <stdbool.h>

#include "velo/sampler.h"

typedef struct SamplerCase {
  bool rows;      /* each of 64 intervals has one u of a pixel, and one v */
  bool cells;     /* each of 8 x 8 cells has one pair of a pixel */
  bool centre;    /* numbers are the centres of cells: not even inside */
  bool any_count; /* rows and cells for any number of samples */
  bool curve;     /* the samples of 2 x 2 pixels are points of one set, too */
  bool scattered; /* numbers that have an interval each stand in it by chance of their own */
  bool hash;      /* no better than independent numbers */
  bool open;      /* a sample is the same for any number of samples */
} SamplerCase;

/* Declares the case of each kind, which is in the file of the kind: sampler/NAME.case.c. */
#define SAMPLER_CASE(kind, name) extern const SamplerCase name##_sampler;
VL_SAMPLER_KINDS(SAMPLER_CASE)
#undef SAMPLER_CASE

#endif
