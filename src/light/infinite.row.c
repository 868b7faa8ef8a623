/* light/infinite.row.c: the name, the parameters and the power of infinite lights. */
#include <math.h>

#include "light/light.row.h"

const vlKindRow vl_light_row_infinite = {
    .name = "infinite",
    .description = "light from all directions, from outside the scene (an environment map)",
    .traits = VL_LIGHT_TRAIT_FAR,
    VL_PARAMETERS(
        RADIANCE, SCALE, ILLUMINANCE, IRRADIANCE,
        IMAGE("a square image, an equal-area octahedral map of the radiance; replaces L"),
        PARAMETER(
            BLOCK, "portal", portal,
            "portal: 4 world-space corners of the rectangle through which the light enters "
            "the scene",
            .text = "point3")),
};

vlLightPower vl_light_power_infinite;

double vl_light_power_infinite(const vlLightDef *def, double luminance, double radius) {
  if (def->path || def->image)
    return NAN;
  const double radiance =
      def->illuminance > 0 ? def->illuminance * (double)def->scale / PI : luminance;
  return 4 * PI * PI * radius * radius * radiance;
}
