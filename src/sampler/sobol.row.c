/* sampler/sobol.row.c: the name and the parameters of the sampler sobol. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_sobol = {
    .name = "sobol",
    .alias = "paddedsobol",
    .description = "padded Sobol' points: each pair of dimensions is scrambled independently",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(SAMPLES(16), RANDOMIZATION),
};
