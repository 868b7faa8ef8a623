/* tracer/path.row.c: the name and the parameters of the tracer path. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_path = {
    .name = "path",
    .alias = "simplepath",
    .description = "path tracing: paths from the camera; ignores media",
    .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(ONE_WAY),
};
