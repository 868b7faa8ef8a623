/* filter/gaussian.row.c: the name and the parameters of the pixel filter gaussian. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_gaussian = {
    .name = "gaussian",
    .traits = VL_FILTER_TRAIT_POSITIVE | VL_TRAIT_PBRT_NAME,
    .description = "a Gaussian minus its value at the radius, so that it ends at 0",
    VL_PARAMETERS(RADII(1.5), PARAMETER("sigma", sigma, "standard deviation of the Gaussian",
                                        PIXELS(0.5), VL_RANGE(0, 1e6))),
};
