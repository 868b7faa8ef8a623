/* distortion/rad_tan_thin_prism.row.c: the names of Project Aria's distortion, and how many
 * coefficients it has. */
#include "distortion/distortion.row.h"

const vlDistortionRow vl_distortion_row_rad_tan_thin_prism = {
    .name = "rad_tan_thin_prism",
    .key = "rad-tan-thin-prism",
    .title = "rad-tan-thin-prism",
    .counts = 1u << 12,
    .how_many = "12",
};
