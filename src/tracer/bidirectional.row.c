/* tracer/bidirectional.row.c: the name and the parameters of the tracer bidirectional. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_bidirectional = {
    .name = "bidirectional",
    .alias = "bdpt",
    .description =
        "bidirectional path tracing: paths from the camera and paths from the lights, connected",
    .traits = VL_TRAIT_PBRT_ALIAS,
    VL_PARAMETERS(TWO_WAY, IGNORED(FLOAT, "radius")),
};
