/* projection/division.row.c: the name and the parameters of the division projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_division = {
    .in_files =
        {
            .name = "division",
            .description = "the division model (Fitzgibbon)",
            VL_PARAMETERS(MODEL,
                          SHAPE("lambda", 0, "required: the model's distortion parameter",
                                VL_RANGE(-1e3, 1e3))),
        },
    .name = "division",
    .key = "division",
    .traits = CALIBRATED,
    .count = 1,
    .numbers = {{"lambda", -1e3, 1e3, VL_UNSET}},
};
