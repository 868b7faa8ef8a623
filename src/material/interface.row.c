/* material/interface.row.c: the name and the parameters of the material interface. */
#include "material/material.row.h"

const vlKindRow vl_material_row_interface = {
    .name = "interface",
    .alias = "none",
    .traits = VL_MATERIAL_ABSENT,
    .description = "no visible surface, only a boundary between two media",
};
