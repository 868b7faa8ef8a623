/* material/coated_conductor.row.c: the name and the parameters of the material coated
 * conductor. */
#include "material/material.row.h"

static const vlParameter parameters[] = {
    METAL("conductor.eta", "conductor.k"),
    INPUT("conductor.roughness", u_roughness,
          "sets conductor.uroughness and conductor.vroughness",
          VL_SECOND(vlMaterialDef, v_roughness), VL_FROM(0),
          .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),
    INPUT("conductor.uroughness", u_roughness, "roughness of the metal, along the tangent",
          ROUGH_RANGE),
    INPUT("conductor.vroughness", v_roughness, "roughness of the metal, across the tangent",
          ROUGH_RANGE),
    INPUT("interface.roughness", coat_u_roughness,
          "sets interface.uroughness and interface.vroughness",
          VL_SECOND(vlMaterialDef, coat_v_roughness), VL_FROM(0),
          .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),
    INPUT("interface.uroughness", coat_u_roughness, "roughness of the coat, along the tangent",
          ROUGH_RANGE),
    INPUT("interface.vroughness", coat_v_roughness, "roughness of the coat, across the tangent",
          ROUGH_RANGE),
    REMAP,
    SPECTRUM("interface.eta", coat_eta, "index of refraction of the coat", ETA_DIELECTRIC),
    LAYERS,
    BUMPS,
};
const vlKindRow vl_material_row_coated_conductor = {
    .name = "coatedconductor",
    .description = "a dielectric coat over a metal",
    .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_METAL | VL_MATERIAL_ROUGH,
    VL_ROW_PARAMETERS(parameters),
};
