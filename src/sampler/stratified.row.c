/* sampler/stratified.row.c: the name and the parameters of the sampler stratified. */
#include "sampler/sampler.row.h"

const vlKindRow vl_sampler_row_stratified = {
    .name = "stratified",
    .alias = "jittered",
    .description = "one random point in each cell of a grid over the pixel",
    .traits = VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(
        SAMPLES(16), SIDE("xsamples"), SIDE("ysamples"),
        {.name = "jitter",
         .member = "",
         .type = VL_PARAMETER_BOOL,
         .value = {1},
         .flags = RULE,
         .description =
             "false: samples are at the cells' centres, as with the sampler regular"}),
};
