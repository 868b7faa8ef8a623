/* texture/fbm.row.c: the name and the parameters of the texture fbm. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_fbm) = {
    .name = "fbm",
    .description = "fractional Brownian motion: a sum of octaves of noise",
    .traits = VL_TEXTURE_FLOAT_ONLY,
    VL_PARAMETERS(OCTAVES),
};
