/* tracer/sppm.row.c: the name and the parameters of the tracer sppm. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_sppm = {
    .name = "sppm",
    .description =
        "stochastic progressive photon mapping: merging, with bounces counted as in pbrt's sppm",
    .traits = VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(TWO_WAY, RADIUS),
};
