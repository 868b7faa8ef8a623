/* light/spot.row.c: the name, the parameters and the power of spot lights. */
#include "light/light.row.h"
#include "math/elementary.h"

const vlKindRow vl_light_row_spot = {
    .name = "spot",
    .description = "a point that emits into a cone",
    .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS,
    VL_PARAMETERS(
        INTENSITY, SCALE, POWER, RADIANT_POWER, RADIANT_INTENSITY,
        FROM("position of the light"),
        TO("a point on the cone's axis, towards which the light points"),
        PARAMETER(FLOAT, "coneangle", cone_angle,
                  "angle between the axis and the edge of the cone", ANGLE(30 * DEGREES),
                  VL_RANGE(0, 180 * DEGREES + 1e-6), .flags = VL_PARAMETER_ABOVE_LOW),
        PARAMETER(FLOAT, "conedeltaangle", cone_delta,
                  "angle inside the cone's edge over which the intensity falls to 0",
                  ANGLE(5 * DEGREES), VL_FROM(0)),
        PARAMETER(
            BOOL, NULL, cone_squared,
            "true: the falloff is t^2, t linear in the cosine, as in glTF; false: 3t^2 - 2t^3, "
            "as in pbrt",
            VL_DEFAULT(0))),
};

vlLightPower vl_light_power_spot;

double vl_light_power_spot(const vlLightDef *def, double luminance, double radius) {
  double inner = vl_precise_cos((double)def->cone_angle - (double)def->cone_delta),
         outer = vl_precise_cos((double)def->cone_angle);
  (void)radius;
  const double mean_edge = def->cone_squared ? 1 / 3.0 : 0.5; /* of the falloff over the edge */
  return 2 * PI * luminance * ((1 - inner) + mean_edge * (inner - outer));
}
