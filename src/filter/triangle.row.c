/* filter/triangle.row.c: the name and the parameters of the pixel filter triangle. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_triangle = {
    .name = "triangle",
    .traits = VL_FILTER_TRAIT_POSITIVE | VL_TRAIT_PBRT_NAME,
    .description = "weight that falls linearly from the centre to 0 at the edge",
    VL_PARAMETERS(RADII(2)),
};
