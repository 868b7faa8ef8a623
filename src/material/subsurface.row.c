/* material/subsurface.row.c: the name and the parameters of the material subsurface. */
#include "material/material.row.h"

static const vlParameter parameters[] = {
    {.name = "name",
     .member = "subsurface",
     .type = VL_PARAMETER_STRING,
     .offset = offsetof(vlMaterialDef, subsurface),
     .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND,
     .description =
         "a measured substance (media.md); replaces sigma_a, sigma_s, reflectance and mfp"},
    SPECTRUM("sigma_a", subsurface.sigma_a, "absorption coefficient, per unit of length",
             VL_DEFAULT(0.0011, 0.0024, 0.014), VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_RGB),
    SPECTRUM("sigma_s", subsurface.sigma_s, "scattering coefficient, per unit of length",
             VL_DEFAULT(2.55, 3.21, 3.77), VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_RGB),
    SPECTRUM("reflectance", reflectance,
             "reflectance of a thick slab; with mfp it replaces sigma_a and sigma_s",
             VL_DEFAULT(0.5), ALBEDO),
    SPECTRUM("mfp", subsurface.mfp,
             "mean free path, used with reflectance, in the scene's unit of length",
             VL_DEFAULT(1), UNBOUNDED),
    BOOL(NULL, subsurface.from_reflectance,
         "use reflectance and mfp instead of sigma_a and sigma_s"),
    FLOAT("scale", scale, "factor on sigma_a and sigma_s, or on mfp", VL_DEFAULT(1),
          VL_FROM(0)),
    SPECTRUM("eta", eta, "index of refraction", VL_DEFAULT(1.33), VL_RANGE(0.5, 2.5),
             .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_ONE_NUMBER | VL_PARAMETER_NO_TEXTURE),
    INPUT("g", g, "asymmetry g: mean cosine of scattering", VL_RANGE(-1, 1),
          .flags = VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH),
    ROUGHNESS,
    BUMPS,
};
const vlKindRow vl_material_row_subsurface = {
    .name = "subsurface",
    .description = "a solid in which light scatters below the surface",
    .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_ROUGH | VL_MATERIAL_REFRACTS,
    VL_ROW_PARAMETERS(parameters),
};
