/* medium/grid.case.c: what tests know of media on grids. */
#include "medium/medium.case.h"

/* The transmittances below are exp(-sigma_a * the integral of the density along z, from -1 to
 * 1), with sigma_a .5. At the box's sides the density fades to half over half a cell:
 *   .transmittance: density 1 in two cells: exp(-.5 * 1.75)
 *   .passes: eight layers of thickness .25, one of density 3, the others .1; the two at the
 *     sides count 7/8: exp(-.5 * .25 * (3 + 5 * .1 + 2 * 7/8 * .1)) */
const MediumCase grid_medium = {
    .shape = BLOCKS,
    .scatters =
        "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" -.5 "
        "\"float density\" [1 .5 .2 1 .7 .1 .4 .9]",
    .emits =
        "\"rgb sigma_a\" [.7 .7 .7] \"rgb sigma_s\" [.5 .5 .5] \"rgb Le\" [.5 .5 .5] "
        "\"float Lescale\" 2 \"float density\" [1 .5 .2 1 .7 .1 .4 .9]",
    /* the scale fades at the box's sides as rgb_grid.case.c's */
    .emits_by_cell =
        "\"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0] \"rgb Le\" [.5 .5 .5] "
        "\"float Lescale\" [2 2 2 2 2 2 2 2] \"float density\" [1 1 1 1 1 1 1 1]",
    .emission_by_cell = 0.942249,
    .absorbs =
        "\"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0] "
        "\"float density\" [1 1 1 1 1 1 1 1]",
    .transmittance = 0.416862,
    .layers = LAYERS
    "\"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0] \"float density\" [" FOUR_THIN FOUR_THIN
    "3 3 3 3 " FOUR_THIN FOUR_THIN FOUR_THIN FOUR_THIN FOUR_THIN "]",
    .passes = 0.631678,
    .density_of_layers = layered_density,
    .density = faded_density,
    /* (temperature - 300) 1.4 */
    .hot = {BLOCKS "\"float density\" " EIGHT
                   " \"float temperature\" [900 1500 2000 2500 900 1500 1200 3000] "
                   "\"float temperatureoffset\" 300 \"float temperaturescale\" 1.4",
            BLOCKS "\"float density\" " EIGHT
                   " \"float temperature\" [840 1680 2380 3080 840 1680 1260 3780]"},
    .alike = {"\"rgb sigma_a\" [.2 .5 .9] \"rgb sigma_s\" [.1 .3 .2] \"float density\" " EIGHT,
              "\"rgb sigma_a\" [.1 .25 .45] \"rgb sigma_s\" [.05 .15 .1] \"float scale\" 2 "
              "\"float density\" " EIGHT},
    .parameters =
        {
            {.parameter = "Lescale",
             .base = CELLS ";\"rgb Le\" [.3 .2 .1];\"float density\" " EIGHT},
            {.base = CELLS ";\"float density\" " EIGHT},
            SIDE_CASES("\"float density\" " EIGHT),
            {.parameter = "temperature",
             .value = "\"float temperature\" [900 1500 2000 2500 900 1500 1200 3000]"},
            {.parameter = "temperatureoffset",
             .base = CELLS ";\"float density\" " EIGHT
                           ";\"float temperature\" [900 1500 2000 2500 900 1500 1200 3000]",
             .value = "\"float temperatureoffset\" 300"},
            {.parameter = "temperaturescale",
             .base = CELLS ";\"float density\" " EIGHT
                           ";\"float temperature\" [900 1500 2000 2500 900 1500 1200 3000]",
             .value = "\"float temperaturescale\" 1.4"},
        },
};
