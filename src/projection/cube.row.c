/* projection/cube.row.c: the name and the parameters of the cube projection. */
#include "projection/projection.row.h"

static const char *const layouts[] = {"row", "cross", NULL};

static void whole_cube(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  bool cross = camera->shape[0] > 0.0;
  focal[0] = d->width / (cross ? 4.0 : 6.0);
  focal[1] = d->height / (cross ? 3.0 : 1.0);
}

static double spread(VL_UNUSED const double shape[2]) {
  return 2.0;
}

const vlProjectionRow vl_projection_row_cube = {
    .in_files =
        {
            .name = "cube",
            .description = "panorama: the six faces of a cube",
            VL_PARAMETERS(MODEL, WORD("layout", CHOICE, shape[0],
                                      "arrangement of the six faces", .choices = layouts)),
        },
    .name = "cube",
    .key = "cube",
    .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV | VL_PROJECTION_NO_DISTORTION,
    .count = 1,
    .numbers = {{"layout", 0.0, 1.0, 0.0}},
    .spread = spread,
    .standard_focal = whole_cube,
};
