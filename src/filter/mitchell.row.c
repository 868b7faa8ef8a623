/* filter/mitchell.row.c: the name and the parameters of the pixel filter mitchell. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_mitchell = {
    .name = "mitchell",
    .traits = VL_TRAIT_PBRT_NAME,
    .description = "the cubic filter of Mitchell and Netravali",
    VL_PARAMETERS(
        RADII(2),
        PARAMETER("B", b, "parameter B of Mitchell and Netravali", VL_DEFAULT(1.0 / 3.0),
                  VL_RANGE(-10, 3), .flags = VL_PARAMETER_BELOW_HIGH),
        PARAMETER("C", c, "parameter C of Mitchell and Netravali", VL_DEFAULT(1.0 / 3.0),
                  VL_RANGE(-10, 10))),
};
