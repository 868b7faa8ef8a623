/* texture/constant.row.c: the name and the parameters of the texture constant. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_constant) = {
    .name = "constant",
    .description = "the same value everywhere",
    VL_PARAMETERS(INPUT("value", a, "the texture's value", 1)),
};
