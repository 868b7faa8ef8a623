/* tracer/volpath.row.c: the name and the parameters of the tracer volpath. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_volpath = {
    .name = "volpath",
    .alias = "simplevolpath",
    .description =
        "volumetric path tracing: paths from the camera, also through media and subsurface materials",
    .traits = VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(ONE_WAY),
};
