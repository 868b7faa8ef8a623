/* light/projection.row.c: the name, the parameters and the power of projection lights. */
#include "light/light.row.h"

const vlKindRow vl_light_row_projection = {
    .name = "projection",
    .description = "a point that projects an image along its z axis, y up",
    .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE,
    VL_PARAMETERS(SCALE, POWER, POSITION,
                  IMAGE("required: the projected image; its values are the intensity"),
                  PARAMETER(FLOAT, "fov", fov, "angle that the smaller side of the image spans",
                            ANGLE(90 * DEGREES), VL_RANGE(0, 3.1415),
                            .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH)),
};
