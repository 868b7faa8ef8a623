/* projection/equirectangular.row.c: the name and the parameters of the equirectangular
 * projection. */
#include "projection/projection.row.h"

/* The image shows the whole sphere, cylinder or cube. */
static void whole_sphere(const vlCameraDef *d, VL_UNUSED const vlCamera *camera,
                         double focal[2]) {
  focal[0] = d->width / (2.0 * PI);
  focal[1] = d->height / PI;
}

const vlProjectionRow vl_projection_row_equirectangular = {
    .in_files =
        {
            .name = "equirectangular",
            .description = "panorama: x is the longitude, y the latitude",
            VL_PARAMETERS(
                MODEL,
                BLOCK("longitude", screen_min_x, "float",
                      "smallest and largest longitude in the image, degrees; unset: -180 180"),
                BLOCK("latitude", screen_min_y, "float",
                      "smallest and largest latitude in the image, degrees; unset: -90 90")),
        },
    .name = "equirectangular",
    .key = "equirectangular",
    .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_DISTORTION,
    .standard_focal = whole_sphere,
};
