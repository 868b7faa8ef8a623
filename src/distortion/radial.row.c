/* distortion/radial.row.c: the names of radial distortion, and how many coefficients it has. */
#include "distortion/distortion.row.h"

const vlDistortionRow vl_distortion_row_radial = {
    .name = "radial",
    .key = "radial",
    .title = "radial",
    .counts = 1u << 1 | 1u << 2 | 1u << 3 | 1u << 4,
    .how_many = "1 to 4",
};
