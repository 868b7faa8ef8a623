/* tracer/raycast.row.c: the name and the parameters of the tracer raycast. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_raycast = {
    .name = "raycast",
    .description = "colour of the surface that each camera ray hits first",
    .traits = VL_TRACER_TRAIT_NO_MEDIA,
};
