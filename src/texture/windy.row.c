/* texture/windy.row.c: the name and the parameters of the texture windy. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_windy) = {
    .name = "windy",
    .description = "waves on windy water, from noise",
    .traits = VL_TEXTURE_FLOAT_ONLY,
    VL_PARAMETERS(TRANSFORM),
};
