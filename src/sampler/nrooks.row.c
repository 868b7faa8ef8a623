/* sampler/nrooks.row.c: the name and the parameters of the sampler nrooks. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_nrooks = {
    .name = "nrooks",
    .alias = "n-rooks",
    .description =
        "one point in each row and each column of an N x N grid, N samples per pixel",
    VL_PARAMETERS(SAMPLES(16)),
};
