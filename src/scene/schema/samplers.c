/* scene/schema/samplers.c: rows of the samplers. A row describes members of vlSceneDefs. */
#include "scene/schema/schema.h"
#include "velo/render.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, __VA_ARGS__)
#define SAMPLES(count) \
  PARAMETER(COUNT, "pixelsamples", render.spp, "samples of each pixel", VL_DEFAULT(count), VL_FROM(1)), SEED
/* Flags of a parameter that the importer reads by a rule of its own. */
#define RULE VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND
#define SEED PARAMETER(COUNT, "seed", render.seed, "another number, other noise", .flags = RULE)
#define SIDE(name) PARAMETER(COUNT, name, render.spp, "cells of the pixel along one axis", .flags = RULE, VL_FROM(1))
static const char *const randomizations[] = {"none", "permutedigits", "fastowen", "owen", NULL};
#define RANDOMIZATION                                                                                             \
  {                                                                                                               \
    .name = "randomization", .member = "", .type = VL_PARAMETER_CHOICE, .choices = randomizations, .flags = RULE, \
    .description = "ignored: samples are always scrambled (Owen)"                                                 \
  }

static const vlParameter independent_parameters[] = {SAMPLES(4)};
VL_KIND_ROW(independent, .name = "independent", .alias = "random", .description = "random numbers",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter regular_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(regular, .name = "regular", .description = "the centres of a grid's cells")

static const vlParameter stratified_parameters[] = {
    SAMPLES(16),
    SIDE("xsamples"),
    SIDE("ysamples"),
    {.name = "jitter",
     .member = "",
     .type = VL_PARAMETER_BOOL,
     .value = {1},
     .flags = RULE,
     .description = "false: the sampler regular"},
};
VL_KIND_ROW(stratified, .name = "stratified", .alias = "jittered",
            .description = "a random point in each cell of a grid", .traits = VL_TRAIT_PBRT_NAME)

static const vlParameter nrooks_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(nrooks, .name = "nrooks", .alias = "n-rooks", .description = "one in each row and column of a fine grid")

static const vlParameter multi_jittered_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(multi_jittered, .name = "multijittered", .alias = "multi-jittered",
            .description = "stratified and n-rooks at once")

static const vlParameter hammersley_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(hammersley, .name = "hammersley", .description = "the Hammersley point set")

static const vlParameter halton_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(halton, .name = "halton", .description = "the Halton sequence",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter sobol_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(sobol, .name = "sobol", .alias = "paddedsobol", .description = "Sobol points, pairs of dimensions padded",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter zsobol_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(zsobol, .name = "zsobol", .alias = "pmj02bn",
            .description = "Sobol points along a Morton curve over the image, whose error is blue noise",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

#define ROW(NAME, name) [VL_SAMPLER_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_sampler_family, VL_SAMPLER_KINDS, ROW, "samplers", "sampler", "Sampler")
