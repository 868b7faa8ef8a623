/* tracer/merging.row.c: the name and the parameters of the tracer merging. */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_merging = {
    .name = "merging",
    .description = "bidirectional path tracing that also merges path vertices within a radius",
    VL_PARAMETERS(TWO_WAY, RADIUS),
};
