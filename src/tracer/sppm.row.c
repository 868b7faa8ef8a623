/* tracer/sppm.row.c: the name and the parameters of the tracer sppm. */
#include "tracer/tracer.row.h"

static const vlParameter parameters[] = {TWO_WAY, RADIUS};

const vlKindRow vl_tracer_row_sppm = {
    .name = "sppm",
    .description =
        "stochastic progressive photon mapping: merging, with bounces counted as in pbrt's sppm",
    .traits = VL_TRAIT_PBRT_NAME,
    VL_ROW_PARAMETERS(parameters),
};
