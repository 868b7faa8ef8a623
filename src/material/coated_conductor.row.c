/* material/coated_conductor.row.c: the name and the parameters of the material coated
 * conductor. */
#include "material/material.row.h"

const vlKindRow vl_material_row_coated_conductor = {
    .name = "coatedconductor",
    .description = "a dielectric coat over a metal",
    .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_METAL | VL_MATERIAL_ROUGH,
    VL_PARAMETERS(
        METAL("conductor.eta", "conductor.k"),
        ROUGHNESS_OF("conductor.", u_roughness, v_roughness, "of the metal, "),
        ROUGHNESS_OF("interface.", coat_u_roughness, coat_v_roughness, "of the coat, "), REMAP,
        SPECTRUM("interface.eta", coat_eta, "index of refraction of the coat", ETA_DIELECTRIC),
        LAYERS, BUMPS),
};
