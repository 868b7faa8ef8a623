/* sampler/independent.row.c: the name and the parameters of the sampler independent. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_independent = {
    .name = "independent",
    .alias = "random",
    .description = "independent uniform random points",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(SAMPLES(4)),
};
