/* medium/nanovdb.row.c: the name and the parameters of media of NanoVDB files. */
#include "medium/medium.row.h"

const vlKindRow vl_medium_row_nanovdb = {
    .name = "nanovdb",
    .description = "sigma_a and sigma_s, multiplied by a density from a NanoVDB file",
    VL_PARAMETERS(
        SIGMAS, SCALE, ASYMMETRY,
        PARAMETER(FILE, "filename", path, "required: a NanoVDB file",
                  .flags = VL_PARAMETER_REQUIRED),
        PARAMETER(STRING, "gridname", grid, "name of the density grid; unset: density",
                  .text = NULL),
        PARAMETER(STRING, "temperaturename", temperature_grid,
                  "name of the temperature grid; unset: temperature, which may be absent",
                  .text = NULL),
        PARAMETER(FLOAT, "Lescale", emission_scale,
                  "factor on the black-body emission of the temperature grid", VL_DEFAULT(1),
                  VL_FROM(0), .alias = "LeScale"),
        TEMPERATURE),
};
