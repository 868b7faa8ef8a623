/* tracer/random_walk.row.c: the name and the parameters of the tracer random walk. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_random_walk = {
    .name = "randomwalk",
    .description =
        "paths without light sampling, scattered uniformly over the sphere; for comparison",
    .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(DEPTH),
};
