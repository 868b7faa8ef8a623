/* texture/checkerboard.row.c: the name and the parameters of the texture checkerboard. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_checkerboard) = {
    .name = "checkerboard",
    .description = "a checkerboard of two textures",
    VL_PARAMETERS(INPUT("tex1", a, "texture of the cell at the origin", 1),
                  INPUT("tex2", b, "texture of the cells next to it", 0),
                  COUNT("dimension", dimension,
                        "2: unit squares of (s, t); 3: unit cubes in texture space",
                        VL_DEFAULT(2), VL_RANGE(2, 3)),
                  MAPPING),
};
