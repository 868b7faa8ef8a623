/* texture/mix.row.c: the name and the parameters of the texture mix. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_mix) = {
    .name = "mix",
    .description = "linear interpolation between two textures",
    VL_PARAMETERS(INPUT("tex1", a, "the first texture", 0),
                  INPUT("tex2", b, "the second texture", 1),
                  NUMBER("amount", amount, "fraction of the second texture", VL_DEFAULT(0.5))),
};
