/* distortion/thin_prism.row.c: the names of COLMAP's thin prism, and how many coefficients it
 * has. */
#include "distortion/distortion.row.h"

const vlDistortionRow vl_distortion_row_thin_prism = {
    .name = "thin_prism",
    .header_name = "thinprism",
    .key = "thin-prism",
    .title = "thin-prism",
    .counts = 1u << 8,
    .how_many = "8",
};
