/* sampler/zsobol.row.c: the name and the parameters of the sampler zsobol. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_zsobol = {
    .name = "zsobol",
    .alias = "pmj02bn",
    .description =
        "Sobol' points in the order of a Morton curve over the image; the error is blue noise",
    .traits = VL_SAMPLER_TRAIT_OPEN | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(SAMPLES(16), RANDOMIZATION),
};
