/* projection/equisolid.row.c: the name and the parameters of the equisolid projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_equisolid = {
    .in_files = {.description = "the camera fisheye"},
    .name = "equisolid fisheye",
    .key = "equisolid",
    .traits = FISHEYE,
};
