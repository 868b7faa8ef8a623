/* material/coated_diffuse.row.c: the name and the parameters of the material coated diffuse. */
#include "material/material.row.h"

const vlKindRow vl_material_row_coated_diffuse = {
    .name = "coateddiffuse",
    .description = "a dielectric coat over a diffuse base",
    .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_ROUGH,
    VL_PARAMETERS(SPECTRUM("reflectance", reflectance, "reflectance of the base",
                           VL_DEFAULT(0.5), ALBEDO),
                  ROUGHNESS,
                  SPECTRUM("eta", eta, "index of refraction of the coat", ETA_DIELECTRIC),
                  LAYERS, BUMPS),
};
