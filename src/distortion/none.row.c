/* distortion/none.row.c: the names of no distortion, and how many coefficients it has. */
#include "distortion/distortion.row.h"

const vlDistortionRow vl_distortion_row_none = {
    .name = "none",
    .key = "none",
    .title = "none",
    .counts = 1u << 0,
    .how_many = "none",
};
