/* texture/bilerp.row.c: the name and the parameters of the texture bilerp. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_bilerp) = {
    .name = "bilerp",
    .description = "bilinear interpolation between the values at four corners",
    VL_PARAMETERS(INPUT("v00", a, "value at (s, t) = (0, 0)", 0),
                  INPUT("v01", b, "value at (s, t) = (0, 1)", 1),
                  INPUT("v10", c, "value at (s, t) = (1, 0)", 0),
                  INPUT("v11", d, "value at (s, t) = (1, 1)", 1), MAPPING),
};
