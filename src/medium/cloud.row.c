/* medium/cloud.row.c: the name and the parameters of clouds. */
#include "medium/medium.row.h"

const vlKindRow vl_medium_row_cloud = {
    .name = "cloud",
    .description = "sigma_a and sigma_s, multiplied by a procedural cloud density in a box",
    .traits = VL_MEDIUM_TRAIT_BOX,
    VL_PARAMETERS(
        SIGMAS, SCALE, ASYMMETRY, BOX,
        FACTOR("density", cloud_density, "factor on the density of the cloud's noise", 1),
        FACTOR("wispiness", wispiness,
               "strength of the noise that displaces the cloud's density", 1),
        FACTOR("frequency", frequency, "frequency of the noise", 5)),
};
