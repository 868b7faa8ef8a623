/* medium/grid.row.c: the name and the parameters of media on grids. */
#include "medium/medium.row.h"

const vlKindRow vl_medium_row_grid = {
    .name = "uniformgrid",
    .description = "sigma_a and sigma_s, multiplied by a density on a grid in a box",
    .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS,
    VL_PARAMETERS(
        SIGMAS, PRESET, SCALE, ASYMMETRY, BOX, RESOLUTION,
        VALUES("density", density, "float array",
               "factor on sigma_a and sigma_s, one number per cell"),
        EMISSION,
        PARAMETER(FLOAT, "Lescale", emission_scale,
                  "factor on the emission: one number, or one per cell", VL_DEFAULT(1),
                  VL_FROM(0), .flags = VL_PARAMETER_RULE),
        VALUES(NULL, emission_scales, NULL, "factor on the emission, one number per cell"),
        VALUES("temperature", temperature, "float array",
               "temperature of a black body, one number per cell; its emission replaces Le"),
        TEMPERATURE),
};
