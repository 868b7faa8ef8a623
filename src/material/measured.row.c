/* material/measured.row.c: the name and the parameters of the material measured. */
#include "material/material.row.h"

const vlKindRow vl_material_row_measured = {
    .name = "measured",
    .description = "a measured BRDF (Dupuy and Jakob 2018)",
    VL_PARAMETERS(
        FILE_NAME("filename", measured,
                  "required: a .bsdf file with spectra from the RGL material database",
                  .flags = VL_PARAMETER_REQUIRED),
        BUMPS),
};
