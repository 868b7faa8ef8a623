/* projection/eucm.row.c: the name and the parameters of the eucm projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_eucm = {
    .in_files =
        {
            .name = "eucm",
            .description = "the enhanced unified model (Khomutenko)",
            VL_PARAMETERS(
                MODEL,
                SHAPE("alpha", 0, "required: the model's parameter alpha", VL_RANGE(0, 1)),
                SHAPE("beta", 1, "required: the model's parameter beta", VL_RANGE(1e-6, 1e6))),
        },
    .name = "EUCM",
    .key = "eucm",
    .traits = CALIBRATED,
    .count = 2,
    .numbers = {{"alpha", 0.0, 1.0, VL_UNSET}, {"beta", 1e-6, 1e6, VL_UNSET}},
};
