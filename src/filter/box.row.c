/* filter/box.row.c: the name and the parameters of the pixel filter box. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_box = {
    .name = "box",
    .traits = VL_FILTER_TRAIT_POSITIVE | VL_TRAIT_PBRT_NAME,
    .description = "constant weight in a rectangle",
    VL_PARAMETERS(RADII(0.5)),
};
