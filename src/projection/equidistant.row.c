/* projection/equidistant.row.c: the name and the parameters of the equidistant projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_equidistant = {
    .in_files = {.description = "the camera fisheye"},
    .name = "equidistant fisheye",
    .key = "equidistant",
    .traits = FISHEYE,
    .limit = PI,
};
