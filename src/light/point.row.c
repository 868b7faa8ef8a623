/* light/point.row.c: the name, the parameters and the power of point lights. */
#include "light/light.row.h"

const vlKindRow vl_light_row_point = {
    .name = "point",
    .description = "a point that emits equally in all directions",
    .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA,
    VL_PARAMETERS(INTENSITY, SCALE, POWER, RADIANT_POWER, RADIANT_INTENSITY,
                  FROM("position of the light")),
};

vlLightPower vl_light_power_point;

double vl_light_power_point(VL_UNUSED const vlLightDef *def, double luminance,
                            VL_UNUSED double radius) {
  return 4 * PI * luminance;
}
