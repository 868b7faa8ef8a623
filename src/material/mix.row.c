/* material/mix.row.c: the name and the parameters of the material mix. */
#include "material/material.row.h"

const vlKindRow vl_material_row_mix = {
    .name = "mix",
    .description = "two materials, one of which is chosen at each hit",
    VL_PARAMETERS(
        BLOCK("materials", materials, "names of the two materials",
              .flags = VL_PARAMETER_RULE | VL_PARAMETER_REQUIRED),
        INPUT("amount", amount, "fraction of the second material", VL_DEFAULT(0.5), SHARE)),
};
