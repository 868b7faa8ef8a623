/* projection/equal_area.row.c: the name and the parameters of the equal area projection. */
#include "projection/projection.row.h"

static void whole_square(const vlCameraDef *d, VL_UNUSED const vlCamera *camera,
                         double focal[2]) {
  focal[0] = 0.5 * d->width;
  focal[1] = 0.5 * d->height;
}

static double spread(VL_UNUSED const double shape[2]) {
  return 1.7724538509055159; /* 4 pi over an area of 4 */
}

const vlProjectionRow vl_projection_row_equal_area = {
    .in_files =
        {
            .name = "equalarea",
            .description = "panorama: equal-area octahedral map of the sphere to a square",
            VL_PARAMETERS(MODEL),
        },
    .name = "equal-area",
    .key = "equal-area",
    .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV | VL_PROJECTION_NO_DISTORTION,
    .spread = spread,
    .standard_focal = whole_square,
};
