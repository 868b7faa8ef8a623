/* light/goniometric.row.c: the name, the parameters and the power of goniometric lights. */
#include "light/light.row.h"

const vlKindRow vl_light_row_goniometric = {
    .name = "goniometric",
    .description = "a point whose intensity over directions comes from a lamp file or an image",
    .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE,
    VL_PARAMETERS(
        INTENSITY, SCALE, POWER, RADIANT_POWER, POSITION,
        IMAGE(
            "required: a lamp file (.ies, .ldt) of the intensity in candela, or a square image, an "
            "equal-area octahedral map of factors on the intensity"),
        PARAMETER(BLOCK, NULL, lamp_data, "the contents of a lamp file in memory",
                  .unit = NULL),
        PARAMETER(BLOCK, NULL, lamp_size, "length of lamp_data, bytes", .unit = NULL)),
};
