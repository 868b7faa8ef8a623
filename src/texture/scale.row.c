/* texture/scale.row.c: the name and the parameters of the texture scale. */
#include "texture/texture.row.h"

static const vlParameter parameters[] = {
    INPUT("tex", a, "the texture that is scaled", 1),
    NUMBER("scale", amount, "factor on the texture", VL_DEFAULT(1)),
};
const vlKindRow vl_texture_row_scale = {
    .name = "scale",
    .description = "a texture multiplied by a number",
    VL_ROW_PARAMETERS(parameters),
};
