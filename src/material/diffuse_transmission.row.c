/* material/diffuse_transmission.row.c: the name and the parameters of the material diffuse
 * transmission. */
#include "material/material.row.h"

const vlKindRow vl_material_row_diffuse_transmission = {
    .name = "diffusetransmission",
    .description = "Lambertian reflection and transmission, as of leaves and paper",
    VL_PARAMETERS(SPECTRUM("reflectance", reflectance, "fraction of light that is reflected",
                           VL_DEFAULT(0.25), ALBEDO),
                  SPECTRUM("transmittance", transmittance,
                           "fraction of light that is transmitted", VL_DEFAULT(0.25), ALBEDO),
                  FLOAT("scale", scale, "factor on reflectance and transmittance",
                        VL_DEFAULT(1), VL_FROM(0)),
                  BUMPS),
};
