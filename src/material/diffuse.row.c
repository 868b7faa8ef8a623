/* material/diffuse.row.c: the name and the parameters of the material diffuse. */
#include "material/material.row.h"

const vlKindRow vl_material_row_diffuse = {
    .name = "diffuse",
    .description = "Lambertian reflection",
    .traits = VL_MATERIAL_OPAQUE,
    VL_PARAMETERS(SPECTRUM("reflectance", reflectance, "fraction of light that is reflected",
                           VL_DEFAULT(0.5), ALBEDO),
                  BUMPS),
};
