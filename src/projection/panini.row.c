/* projection/panini.row.c: the name and the parameters of the panini projection. */
#include "projection/projection.row.h"

const vlProjectionRow vl_projection_row_panini = {
    .in_files =
        {
            .name = "panini",
            .description = "the general Panini projection",
            VL_PARAMETERS(
                MODEL,
                SHAPE("panini", 0,
                      "d: distance of the projection centre from the cylinder's axis; unset: 1",
                      VL_RANGE(0, 1e3))),
        },
    .name = "Panini",
    .key = "panini",
    .count = 1,
    .numbers = {{"d", 0.0, 1e3, 1.0}},
};
