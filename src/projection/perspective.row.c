/* projection/perspective.row.c: the name and the parameters of the perspective projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_perspective = {
    .in_files = {.description = "the camera perspective, pinhole or opencv"},
    .name = "perspective",
    .key = "perspective",
    .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL,
    .standard_focal = vl_projection_half_side,
};
