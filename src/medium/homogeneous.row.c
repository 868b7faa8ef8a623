/* medium/homogeneous.row.c: the name and the parameters of homogeneous media. */
#include "medium/medium.row.h"

const vlKindRow vl_medium_row_homogeneous = {
    .name = "homogeneous",
    .description = "sigma_a and sigma_s are the same everywhere",
    VL_PARAMETERS(
        SIGMAS, PRESET, SCALE, ASYMMETRY, EMISSION,
        FACTOR("Lescale", emission_scale, "factor on the emission", 1),
        PARAMETER(
            BOOL, NULL, rgb_absorption,
            "true: sigma_a attenuates each channel of linear sRGB separately, at any depth")),
};
