/* sampler/multi_jittered.row.c: the name and the parameters of the sampler multi jittered. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_multi_jittered = {
    .name = "multijittered",
    .alias = "multi-jittered",
    .description = "points that are stratified and n-rooks at the same time",
    VL_PARAMETERS(SAMPLES(16)),
};
