/* sampler/sampler.row.h: for the files that hold rows of samplers: parameters that several
 * kinds share. A row describes members of vlSceneDefs. */
#ifndef SAMPLER_SAMPLER_ROW_H
#define SAMPLER_SAMPLER_ROW_H

#include "schema/schema.h"
#include "velo/render.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, __VA_ARGS__)
#define SAMPLES(count)                                                                 \
  PARAMETER(COUNT, "pixelsamples", render.spp, "samples per pixel", VL_DEFAULT(count), \
            VL_FROM(1)),                                                               \
      SEED
/* Flags of a parameter that the importer reads by a rule of its own. */
#define RULE VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND
#define SEED                            \
  PARAMETER(COUNT, "seed", render.seed, \
            "seed of the random numbers; another seed gives other noise", .flags = RULE)
#define SIDE(name)                                                                             \
  PARAMETER(COUNT, name, render.spp,                                                           \
            "number of cells of a pixel along this axis; xsamples * ysamples are the samples " \
            "per pixel",                                                                       \
            .flags = RULE, VL_FROM(1))
extern const char *const vl_sampler_randomizations[];
#define RANDOMIZATION                                                   \
  {                                                                     \
    .name = "randomization", .member = "", .type = VL_PARAMETER_CHOICE, \
    .choices = vl_sampler_randomizations, .flags = RULE,                \
    .description = "ignored: samples are always scrambled (Owen)"       \
  }

#endif
