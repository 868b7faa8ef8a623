/* sampler/halton.row.c: the name and the parameters of the sampler halton. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_halton = {
    .name = "halton",
    .description = "the Halton sequence",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(SAMPLES(16), RANDOMIZATION),
};
