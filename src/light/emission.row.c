/* light/emission.row.c: the row of the emission of shapes. Names and defaults are pbrt-v4's. */
#include "base/cookie.h"
#include "schema/schema.h"
#include "velo/light.h"

#define PI 3.14159265358979323846
#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlEmissionDef, __VA_ARGS__)

static const vlParameter diffuse_parameters[] = {
    PARAMETER(SPECTRUM, "L", radiance, "radiance; its luminance is 1 before scale",
              VL_DEFAULT(1, 1, 1), .flags = VL_PARAMETER_RGB, .role = VL_PARAMETER_ILLUMINANT),
    PARAMETER(FLOAT, "scale", scale, "factor on the radiance", VL_DEFAULT(1)),
    PARAMETER(BOOL, "twosided", two_sided, "both sides of the surface emit", VL_DEFAULT(0)),
    PARAMETER(DOUBLE, "power", power,
              "power of each face: its emission is scaled to it, and then multiplied by scale",
              .unit = "lm", .flags = VL_PARAMETER_UNSET),
    PARAMETER(DOUBLE, "radiantpower", radiant_power,
              "radiant power of each face, in place of power: that of all directions and "
              "wavelengths, from 360 to 830 nm",
              VL_FROM(0), .unit = "W", .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW),
    PARAMETER(FLOAT, "spread", spread,
              "full angle about the normal into which each point emits, like a soft box with a "
              "grid; the power is the same",
              VL_DEFAULT(PI), .unit = "degrees", .factor = PI / 180,
              VL_RANGE(PI / 180 - 1e-6, PI + 1e-6), .flags = VL_PARAMETER_OWN),
    PARAMETER(FILE, "filename", image, "image file of the radiance over uv; replaces L",
              .text = NULL),
    PARAMETER(TEXTURE, NULL, texture, "image texture of the radiance over uv; replaces L",
              .unit = NULL),
};
static const vlKindRow diffuse_row = {
    VL_ROW_PARAMETERS(diffuse_parameters), .name = "diffuse",
    .description =
        "a surface that emits the same radiance in all directions, or less away from its normal",
    .traits = 0};

#define EMISSION_KINDS(X) X(, diffuse)
const vlKindFamily vl_emission_family =
    VL_KIND_FAMILY(&diffuse_row, EMISSION_KINDS, "emission", "area light", "AreaLightSource");

vlEmissionDef vl_default_emission_def(void) {
  vlEmissionDef def = {.cookie = VL_COOKIE_EMISSION};
  vl_row_set_defaults(&diffuse_row, &def);
  return def;
}
