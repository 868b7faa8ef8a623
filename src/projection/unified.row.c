/* projection/unified.row.c: the name and the parameters of the unified projection. */
#include "projection/projection.row.h"

static double spread(const double shape[2]) {
  return 1.0 + shape[0];
}

const vlProjectionRow vl_projection_row_unified = {
    .in_files =
        {
            .name = "unified",
            .description = "the unified model (Mei)",
            VL_PARAMETERS(
                MODEL, COEFFICIENTS,
                SHAPE("xi", 0, "required: the model's mirror parameter", VL_RANGE(0, 1e3))),
        },
    .name = "unified",
    .key = "unified",
    .traits = CALIBRATED,
    .count = 1,
    .numbers = {{"xi", 0.0, 1e3, VL_UNSET}},
    .spread = spread,
};
