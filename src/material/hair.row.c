/* material/hair.row.c: the name and the parameters of the material hair. */
#include "material/material.row.h"

static const char *const hair_colors[] = {"sigma_a", "reflectance", "melanin", NULL};

const vlKindRow vl_material_row_hair = {
    .name = "hair",
    .description = "hair and fur (pbrt book 9.9); for curves",
    VL_PARAMETERS(
        CHOICE(
            NULL, hair.color,
            "the parameters that give the absorption: sigma_a, reflectance, or eu- and pheomelanin",
            VL_DEFAULT(VL_HAIR_MELANIN), .choices = hair_colors),
        SPECTRUM("sigma_a", hair.sigma_a, "absorption coefficient, per radius of the hair",
                 VL_DEFAULT(0), UNBOUNDED),
        SPECTRUM("reflectance", reflectance, "colour that the hair has as a whole",
                 VL_DEFAULT(0.5), ALBEDO, .alias = "color"),
        INPUT("eumelanin", hair.eumelanin, "concentration of eumelanin, the brown pigment",
              VL_DEFAULT(1.3), ROUGH_RANGE),
        INPUT("pheomelanin", hair.pheomelanin, "concentration of pheomelanin, the red pigment",
              ROUGH_RANGE),
        INPUT("eta", hair.eta, "index of refraction of the hair", VL_DEFAULT(1.55),
              CLAMPED(1.0001, 10)),
        INPUT("beta_m", hair.beta_m, "roughness along the hair", VL_DEFAULT(0.3), SHARE),
        INPUT("beta_n", hair.beta_n, "roughness around the hair", VL_DEFAULT(0.3), SHARE),
        INPUT("alpha", hair.alpha, "angle by which the scales on the hair are tilted",
              VL_DEFAULT(2), .unit = "degrees"),
        BUMPS_(VL_PARAMETER_OWN)),
};
