/* filter/lanczos.row.c: the name and the parameters of the pixel filter lanczos. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_lanczos = {
    .name = "sinc",
    .alias = "lanczos",
    .traits = VL_TRAIT_PBRT_NAME,
    .description = "a sinc, windowed by a wider sinc (Lanczos)",
    VL_PARAMETERS(RADII(4),
                  PARAMETER("tau", tau, "number of periods of the sinc in the window",
                            VL_DEFAULT(3), VL_RANGE(0, 1e6), .flags = VL_PARAMETER_ABOVE_LOW)),
};
