/* texture/direction_mix.row.c: the name and the parameters of the texture direction mix. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_direction_mix) = {
    .name = "directionmix",
    .description = "interpolation between two textures by |n . dir|, n the surface normal",
    VL_PARAMETERS(
        INPUT("tex1", a, "texture where the surface normal is parallel to dir", 0),
        INPUT("tex2", b, "texture where the surface normal is perpendicular to dir", 1),
        VECTOR("dir", direction,
               "the direction with which the normal is compared; its length has no effect",
               VL_DEFAULT(0, 1, 0))),
};
