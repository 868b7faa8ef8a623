/* texture/wrinkled.row.c: the name and the parameters of the texture wrinkled. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_wrinkled) = {
    .name = "wrinkled",
    .description = "turbulence: a sum of octaves of the absolute value of noise",
    .traits = VL_TEXTURE_FLOAT_ONLY,
    VL_PARAMETERS(OCTAVES),
};
