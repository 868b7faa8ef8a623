/* material/dielectric.row.c: the name and the parameters of the material dielectric. */
#include "material/material.row.h"

const vlKindRow vl_material_row_dielectric = {
    .name = "dielectric",
    .description = "a smooth or rough dielectric, such as glass or water",
    .traits = VL_MATERIAL_ROUGH | VL_MATERIAL_REFRACTS,
    VL_PARAMETERS(
        SPECTRUM("eta", eta, "index of refraction of the inside, relative to the outside",
                 ETA_DIELECTRIC),
        ROUGHNESS, BUMPS),
};
