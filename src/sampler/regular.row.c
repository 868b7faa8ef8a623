/* sampler/regular.row.c: the name and the parameters of the sampler regular. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_regular = {
    .name = "regular",
    .description = "the centres of the cells of a grid over the pixel",
    VL_PARAMETERS(SAMPLES(16)),
};
