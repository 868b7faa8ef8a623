/* projection/fov.row.c: the name and the parameters of the fov projection. */
#include "projection/projection.row.h"

static double spread(const double shape[2]) {
  return shape[0] / shape[1];
}

const vlProjectionRow vl_projection_row_fov = {
    .in_files =
        {
            .name = "fov",
            .description = "the FOV model (Devernay and Faugeras)",
            VL_PARAMETERS(MODEL,
                          SHAPE("omega", 0, "required: the model's field-of-view parameter",
                                VL_RANGE(1e-6, 3.14), .unit = "radians")),
        },
    .name = "FOV",
    .key = "fov",
    .traits = VL_PROJECTION_AHEAD | CALIBRATED,
    .count = 1,
    .numbers = {{"w", 1e-6, 3.14, VL_UNSET}},
    .spread = spread,
};
