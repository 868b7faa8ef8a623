/* material/conductor.row.c: the name and the parameters of the material conductor. */
#include "material/material.row.h"

const vlKindRow vl_material_row_conductor = {
    .name = "conductor",
    .description = "a smooth or rough metal",
    .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_METAL | VL_MATERIAL_ROUGH,
    VL_PARAMETERS(METAL("eta", "k"), ROUGHNESS, BUMPS),
};
