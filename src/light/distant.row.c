/* light/distant.row.c: the name, the parameters and the power of distant lights. */
#include "light/light.row.h"

const vlKindRow vl_light_row_distant = {
    .name = "distant",
    .description = "light from infinitely far away, with one direction everywhere",
    .traits = VL_LIGHT_TRAIT_FAR | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS,
    VL_PARAMETERS(RADIANCE, SCALE, ILLUMINANCE, IRRADIANCE,
                  FROM("start point of the vector along which the light travels"),
                  TO("end point of the vector along which the light travels")),
};

vlLightPower vl_light_power_distant;

double vl_light_power_distant(const vlLightDef *def, double luminance, double radius) {
  const double illuminance =
      def->illuminance > 0 ? def->illuminance * (double)def->scale : luminance;
  return PI * radius * radius * illuminance;
}
