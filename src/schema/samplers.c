/* schema/samplers.c: rows of the samplers. A row describes members of vlSceneDefs. */
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
static const char *const randomizations[] = {"none", "permutedigits", "fastowen", "owen", NULL};
#define RANDOMIZATION                                                   \
  {                                                                     \
    .name = "randomization", .member = "", .type = VL_PARAMETER_CHOICE, \
    .choices = randomizations, .flags = RULE,                           \
    .description = "ignored: samples are always scrambled (Owen)"       \
  }

static const vlParameter independent_parameters[] = {SAMPLES(4)};
VL_KIND_ROW(independent, .name = "independent", .alias = "random",
            .description = "independent uniform random points",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter regular_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(regular, .name = "regular",
            .description = "the centres of the cells of a grid over the pixel")

static const vlParameter stratified_parameters[] = {
    SAMPLES(16),
    SIDE("xsamples"),
    SIDE("ysamples"),
    {.name = "jitter",
     .member = "",
     .type = VL_PARAMETER_BOOL,
     .value = {1},
     .flags = RULE,
     .description = "false: samples are at the cells' centres, as with the sampler regular"},
};
VL_KIND_ROW(stratified, .name = "stratified", .alias = "jittered",
            .description = "one random point in each cell of a grid over the pixel",
            .traits = VL_TRAIT_PBRT_NAME)

static const vlParameter nrooks_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(nrooks, .name = "nrooks", .alias = "n-rooks",
            .description =
                "one point in each row and each column of an N x N grid, N samples per pixel")

static const vlParameter multi_jittered_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(multi_jittered, .name = "multijittered", .alias = "multi-jittered",
            .description = "points that are stratified and n-rooks at the same time")

static const vlParameter hammersley_parameters[] = {SAMPLES(16)};
VL_KIND_ROW(hammersley, .name = "hammersley", .description = "the Hammersley point set")

static const vlParameter halton_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(halton, .name = "halton", .description = "the Halton sequence",
            .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter sobol_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(
    sobol, .name = "sobol", .alias = "paddedsobol",
    .description = "padded Sobol' points: each pair of dimensions is scrambled independently",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

static const vlParameter zsobol_parameters[] = {SAMPLES(16), RANDOMIZATION};
VL_KIND_ROW(
    zsobol, .name = "zsobol", .alias = "pmj02bn",
    .description =
        "Sobol' points in the order of a Morton curve over the image; the error is blue noise",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME)

#define ROW(NAME, name) [VL_SAMPLER_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_sampler_family, VL_SAMPLER_KINDS, ROW, "samplers", "sampler", "Sampler")
