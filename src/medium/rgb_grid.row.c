/* medium/rgb_grid.row.c: the name and the parameters of media on grids of colours. */
#include "medium/medium.row.h"

const vlKindRow vl_medium_row_rgb_grid = {
    .name = "rgbgrid",
    .description = "sigma_a and sigma_s, given for each cell of a grid in a box",
    .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS,
    VL_PARAMETERS(
        SCALE, ASYMMETRY, BOX, RESOLUTION,
        VALUES("sigma_a", rgb_a, "rgb array",
               "absorption coefficient, one RGB colour per cell"),
        VALUES("sigma_s", rgb_s, "rgb array",
               "scattering coefficient, one RGB colour per cell"),
        VALUES("Le", rgb_emission, "rgb array",
               "emission, one RGB colour per cell: the medium emits the radiance sigma_a * Le "
               "per unit of length"),
        FACTOR("Lescale", emission_scale, "factor on the emission", 1)),
};
