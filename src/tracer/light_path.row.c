/* tracer/light_path.row.c: the name and the parameters of the tracer light path. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_light_path = {
    .name = "lightpath",
    .description = "light tracing: paths from the lights, connected to the camera",
    .traits = VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(DEPTH),
};
