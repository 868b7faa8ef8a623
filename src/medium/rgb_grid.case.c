/* medium/rgb_grid.case.c: what tests know of media on grids of colours. */
#include "medium/medium.case.h"

/* Le of these grids, as in pbrt, is in units of a constant spectrum's luminance, 106.857. It is
 * interpolated, too: both fade to half at the box's sides, w(z) = 1.5 - |z| from |z| = .5 on.
 * The numbers are integrals of that. */
const MediumCase rgb_grid_medium = {
    .shape = BLOCKS,
    .scatters = "\"rgb sigma_a\" " NONE " \"rgb sigma_s\" " EIGHT_COLORS " \"float g\" .4",
    .emits = "\"rgb sigma_a\" " HALF_OF " \"rgb sigma_s\" " NONE " \"rgb Le\" " ONES
             " \"float Lescale\" .00935831",
    .absorbs = "\"rgb sigma_a\" " HALF_OF " \"rgb sigma_s\" " NONE,
    .transmittance = 0.416862,
    .emission = 0.942249,
    .layers = LAYERS
    "\"rgb sigma_a\" [" FOUR_COLORS FOUR_COLORS THICK_COLORS FOUR_COLORS FOUR_COLORS FOUR_COLORS
        FOUR_COLORS FOUR_COLORS
    "] \"rgb sigma_s\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
    "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
    "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]",
    .passes = 0.631678,
    .density_of_layers = layered_density,
    .density = faded_density,
    /* what is not given is 1 */
    .tall = BLOCKS "\"rgb sigma_s\" " EIGHT_COLORS,
    .parameters =
        {
            {.parameter = "Lescale",
             .base = CELLS ";\"rgb sigma_s\" " EIGHT_COLORS ";\"rgb sigma_a\" " EIGHT_COLORS
                           ";\"rgb Le\" " EIGHT_COLORS},
            {.base = CELLS ";\"rgb sigma_s\" " EIGHT_COLORS},
            SIDE_CASES("\"rgb sigma_s\" " EIGHT_COLORS),
            {.parameter = "Le",
             .value = "\"rgb Le\" " OTHER_COLORS,
             .base = CELLS ";\"rgb sigma_s\" " EIGHT_COLORS ";\"rgb sigma_a\" " EIGHT_COLORS},
            {.parameter = "sigma_s", .value = "\"rgb sigma_s\" " OTHER_COLORS},
            {.parameter = "sigma_a", .value = "\"rgb sigma_a\" " OTHER_COLORS},
        },
};
