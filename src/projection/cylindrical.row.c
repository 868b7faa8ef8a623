/* projection/cylindrical.row.c: the name and the parameters of the cylindrical projection. */
#include "projection/projection.row.h"

static void whole_cylinder(const vlCameraDef *d, VL_UNUSED const vlCamera *camera,
                           double focal[2]) {
  focal[0] = focal[1] = d->width / (2.0 * PI);
}

const vlProjectionRow vl_projection_row_cylindrical = {
    .in_files =
        {
            .name = "cylindrical",
            .description = "panorama: x is the longitude, y the tangent of the latitude",
            VL_PARAMETERS(MODEL),
        },
    .name = "cylindrical",
    .key = "cylindrical",
    .standard_focal = whole_cylinder,
};
