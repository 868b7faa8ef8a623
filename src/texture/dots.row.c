/* texture/dots.row.c: the name and the parameters of the texture dots. */
#include "texture/texture.row.h"

/* pbrt-v4 interchanges the two: its constructor takes the texture between the dots first, and
 * is given "inside". */
VL_TEXTURE_ROW(vl_texture_row_dots) = {
    .name = "dots",
    .description = "dots in randomly chosen cells of (s, t)",
    VL_PARAMETERS(INPUT("inside", a, "texture between the dots, as pbrt-v4 renders it", 1),
                  INPUT("outside", b, "texture in the dots", 0), MAPPING),
};
