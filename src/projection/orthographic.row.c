/* projection/orthographic.row.c: the name and the parameters of the orthographic projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_orthographic = {
    .in_files = {.description = "the camera orthographic"},
    .name = "orthographic",
    .key = "orthographic",
    .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_RADIAL | VL_PROJECTION_NO_DISTORTION,
    .standard_focal = vl_projection_half_side,
};
