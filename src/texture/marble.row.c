/* texture/marble.row.c: the name and the parameters of the texture marble. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_marble) = {
    .name = "marble",
    .description = "marble with coloured veins, from noise",
    .traits = VL_TEXTURE_COLOR_ONLY,
    VL_PARAMETERS(OCTAVES,
                  FLOAT("scale", scale, "factor on the positions in texture space",
                        VL_DEFAULT(1)),
                  FLOAT("variation", variation,
                        "strength of the noise that displaces the veins", VL_DEFAULT(0.2))),
};
