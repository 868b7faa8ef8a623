/* texture/scale.row.c: the name and the parameters of the texture scale. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_scale) = {
    .name = "scale",
    .description = "a texture multiplied by a number",
    VL_PARAMETERS(INPUT("tex", a, "the texture that is scaled", 1),
                  NUMBER("scale", amount, "factor on the texture", VL_DEFAULT(1))),
};
