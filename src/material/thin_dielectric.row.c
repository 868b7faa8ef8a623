/* material/thin_dielectric.row.c: the name and the parameters of the material thin dielectric.
 */
#include "material/material.row.h"

const vlKindRow vl_material_row_thin_dielectric = {
    .name = "thindielectric",
    .description = "a thin sheet of glass, without refraction",
    VL_PARAMETERS(SPECTRUM("eta", eta, "index of refraction", ETA_DIELECTRIC), BUMPS),
};
