/* projection/sine.row.c: the name and the parameters of the sine projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_sine = {
    .in_files = {.description = "the camera fisheye"},
    .name = "orthographic fisheye",
    .key = "sine",
    .traits = VL_PROJECTION_AHEAD | FISHEYE,
};
