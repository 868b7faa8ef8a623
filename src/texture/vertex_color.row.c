/* texture/vertex_color.row.c: the name and the parameters of the texture vertex color. */
#include "texture/texture.row.h"

VL_TEXTURE_ROW(vl_texture_row_vertex_color) = {
    .description = "the colours of the shape's vertices",
    VL_PARAMETERS(CHANNELS),
};
