/* sampler/hammersley.row.c: the name and the parameters of the sampler hammersley. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_hammersley = {
    .name = "hammersley",
    .description = "the Hammersley point set",
    VL_PARAMETERS(SAMPLES(16)),
};
