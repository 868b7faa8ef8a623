/* projection/double_sphere.row.c: the name and the parameters of the double sphere projection.
 */
#include "projection/projection.row.h"

static double spread(const double shape[2]) {
  return 1.0 + shape[0];
}

const vlProjectionRow vl_projection_row_double_sphere = {
    .in_files =
        {
            .name = "doublesphere",
            .description = "the double sphere model (Usenko)",
            VL_PARAMETERS(
                MODEL,
                SHAPE("xi", 0, "required: the model's parameter xi", VL_RANGE(-0.999, 0.999)),
                SHAPE("alpha", 1, "required: the model's parameter alpha", VL_RANGE(0, 1))),
        },
    .name = "double sphere",
    .key = "double-sphere",
    .traits = CALIBRATED,
    .count = 2,
    .numbers = {{"xi", -0.999, 0.999, VL_UNSET}, {"alpha", 0.0, 1.0, VL_UNSET}},
    .spread = spread,
};
