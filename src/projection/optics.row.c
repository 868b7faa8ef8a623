/* projection/optics.row.c: the name and the parameters of the optics projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_optics = {
    .in_files = {.description = "the camera realistic"},
    .name = "optics",
    .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL,
};
