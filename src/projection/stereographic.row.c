/* projection/stereographic.row.c: the name and the parameters of the stereographic projection.
 */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_stereographic = {
    .in_files = {.description = "the camera fisheye"},
    .name = "stereographic fisheye",
    .key = "stereographic",
    .traits = FISHEYE,
};
