/* schema/lights.c: rows of the lights, and of the emission of shapes. Names and defaults are
 * pbrt-v4's. */
#include <math.h>

#include "base/cookie.h"
#include "math/elementary.h"
#include "schema/schema.h"
#include "velo/light.h"

#define PI 3.14159265358979323846
#define DEGREES (PI / 180)

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlLightDef, __VA_ARGS__)
#define ANGLE(...) VL_DEFAULT(__VA_ARGS__), .unit = "degrees", .factor = DEGREES
#define COLOR(name, text)                                                                \
  PARAMETER(SPECTRUM, name, color, text, VL_DEFAULT(1, 1, 1), .flags = VL_PARAMETER_RGB, \
            .role = VL_PARAMETER_ILLUMINANT)
#define INTENSITY COLOR("I", "intensity; its luminance is 1 before scale")
#define RADIANCE COLOR("L", "radiance; its luminance is 1 before scale")
#define SCALE \
  PARAMETER(FLOAT, "scale", scale, "factor on the intensity or radiance", VL_DEFAULT(1))
#define POWER                                                                            \
  PARAMETER(DOUBLE, "power", power,                                                      \
            "total power: the light is scaled to emit it, and then multiplied by scale", \
            .unit = "W", .flags = VL_PARAMETER_UNSET)
#define ILLUMINANCE                                                                         \
  PARAMETER(                                                                                \
      DOUBLE, "illuminance", illuminance,                                                   \
      "illuminance of a surface that faces the light: the light is scaled to it, and then " \
      "multiplied by scale",                                                                \
      .unit = "lx", .flags = VL_PARAMETER_UNSET)
#define FROM(text) PARAMETER(FLOAT3, "from", from, text, .unit = NULL)
/* The position of kinds that files place by their transform alone. */
#define POSITION PARAMETER(FLOAT3, NULL, from, "position of the light", .unit = NULL)
#define TO(text) PARAMETER(FLOAT3, "to", to, text, VL_DEFAULT(0, 0, 1))
#define IMAGE(line)                                                                          \
  PARAMETER(FILE, "filename", path, line, .unit = NULL),                                     \
      PARAMETER(BLOCK, NULL, image, "an image in memory, in place of a file", .unit = NULL), \
      PARAMETER(BLOCK, NULL, space, "colour space of an image that does not name its own",   \
                .unit = NULL)

static const vlParameter point_parameters[] = {INTENSITY, SCALE, POWER,
                                               FROM("position of the light")};
VL_KIND_ROW(point, .name = "point",
            .description = "a point that emits equally in all directions",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA)

static const vlParameter spot_parameters[] = {
    INTENSITY,
    SCALE,
    POWER,
    FROM("position of the light"),
    TO("a point on the cone's axis, towards which the light points"),
    PARAMETER(FLOAT, "coneangle", cone_angle, "angle between the axis and the edge of the cone",
              ANGLE(30 * DEGREES), VL_RANGE(0, 180 * DEGREES + 1e-6),
              .flags = VL_PARAMETER_ABOVE_LOW),
    PARAMETER(FLOAT, "conedeltaangle", cone_delta,
              "angle inside the cone's edge over which the intensity falls to 0",
              ANGLE(5 * DEGREES), VL_FROM(0)),
    PARAMETER(
        BOOL, NULL, cone_squared,
        "true: the falloff is t^2, t linear in the cosine, as in glTF; false: 3t^2 - 2t^3, "
        "as in pbrt",
        VL_DEFAULT(0)),
};
VL_KIND_ROW(spot, .name = "spot", .description = "a point that emits into a cone",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter distant_parameters[] = {
    RADIANCE, SCALE, ILLUMINANCE,
    FROM("start point of the vector along which the light travels"),
    TO("end point of the vector along which the light travels")};
VL_KIND_ROW(distant, .name = "distant",
            .description = "light from infinitely far away, with one direction everywhere",
            .traits = VL_LIGHT_TRAIT_FAR | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter infinite_parameters[] = {
    RADIANCE,
    SCALE,
    ILLUMINANCE,
    IMAGE("a square image, an equal-area octahedral map of the radiance; replaces L"),
    PARAMETER(BLOCK, "portal", portal,
              "portal: 4 world-space corners of the rectangle through which the light enters "
              "the scene",
              .text = "point3"),
};
VL_KIND_ROW(
    infinite, .name = "infinite",
    .description = "light from all directions, from outside the scene (an environment map)",
    .traits = VL_LIGHT_TRAIT_FAR)

static const vlParameter goniometric_parameters[] = {
    INTENSITY, SCALE, POWER, POSITION,
    IMAGE(
        "required: a square image, an equal-area octahedral map of factors on the intensity")};
VL_KIND_ROW(goniometric, .name = "goniometric",
            .description = "a point whose intensity over directions comes from an image",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

static const vlParameter projection_parameters[] = {
    SCALE,
    POWER,
    POSITION,
    IMAGE("required: the projected image; its values are the intensity"),
    PARAMETER(FLOAT, "fov", fov, "angle that the smaller side of the image spans",
              ANGLE(90 * DEGREES), VL_RANGE(0, 3.1415),
              .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH),
};
VL_KIND_ROW(projection, .name = "projection",
            .description = "a point that projects an image along its z axis, y up",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

#define ROW(NAME, name) [VL_LIGHT_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_light_family, VL_LIGHT_KINDS, ROW, "lights", "light", "LightSource")

vlLightDef vl_default_light_def(vlLightKind kind) {
  vlLightDef def = {.cookie = VL_COOKIE_LIGHT, .kind = kind};
  vl_family_set_defaults(&vl_light_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.world_from_light[i] = 1.0;
  return def;
}

/* ---- power, a function per kind ---------------------------------------------------------- */

typedef double Power(const vlLightDef *def, double luminance, double radius);

static double point_power(const vlLightDef *def, double luminance, double radius) {
  (void)def;
  (void)radius;
  return 4 * PI * luminance;
}

static double spot_power(const vlLightDef *def, double luminance, double radius) {
  double inner = vl_precise_cos((double)def->cone_angle - (double)def->cone_delta),
         outer = vl_precise_cos((double)def->cone_angle);
  (void)radius;
  return 2 * PI * luminance * ((1 - inner) + 0.5 * (inner - outer));
}

static double distant_power(const vlLightDef *def, double luminance, double radius) {
  return PI * radius * radius * (def->illuminance > 0 ? def->illuminance : luminance);
}

static double infinite_power(const vlLightDef *def, double luminance, double radius) {
  if (def->path || def->image)
    return NAN;
  return 4 * PI * PI * radius * radius *
         (def->illuminance > 0 ? def->illuminance / PI : luminance);
}

static double goniometric_power(const vlLightDef *def, double luminance, double radius) {
  (void)def;
  (void)luminance;
  (void)radius;
  return NAN;
}

static double projection_power(const vlLightDef *def, double luminance, double radius) {
  (void)def;
  (void)luminance;
  (void)radius;
  return NAN;
}

#define POWER_OF(NAME, name) [VL_LIGHT_##NAME] = name##_power,
static Power *const powers[] = {VL_LIGHT_KINDS(POWER_OF)};

double vl_light_power(const vlLightDef *def, double luminance, double radius) {
  return def->power > 0 ? def->power : powers[def->kind](def, luminance, radius);
}

/* ---- what shapes emit -------------------------------------------------------------------- */

#undef PARAMETER
#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlEmissionDef, __VA_ARGS__)

static const vlParameter diffuse_parameters[] = {
    PARAMETER(SPECTRUM, "L", radiance, "radiance; its luminance is 1 before scale",
              VL_DEFAULT(1, 1, 1), .flags = VL_PARAMETER_RGB, .role = VL_PARAMETER_ILLUMINANT),
    PARAMETER(FLOAT, "scale", scale, "factor on the radiance", VL_DEFAULT(1)),
    PARAMETER(BOOL, "twosided", two_sided, "both sides of the surface emit", VL_DEFAULT(0)),
    PARAMETER(DOUBLE, "power", power,
              "power of each face: its emission is scaled to it, and then multiplied by scale",
              .unit = "W", .flags = VL_PARAMETER_UNSET),
    PARAMETER(FILE, "filename", image, "image file of the radiance over uv; replaces L",
              .text = NULL),
    PARAMETER(TEXTURE, NULL, texture, "image texture of the radiance over uv; replaces L",
              .unit = NULL),
};
VL_KIND_ROW(diffuse, .name = "diffuse",
            .description = "a surface that emits the same radiance in all directions",
            .traits = 0)

#define EMISSION_KINDS(X) X(DIFFUSE, diffuse)
#define EMISSION_ROW(NAME, name) &name##_row,
VL_KIND_FAMILY(vl_emission_family, EMISSION_KINDS, EMISSION_ROW, "emission", "area light",
               "AreaLightSource")

vlEmissionDef vl_default_emission_def(void) {
  vlEmissionDef def = {.cookie = VL_COOKIE_EMISSION};
  vl_row_set_defaults(&diffuse_row, &def);
  return def;
}
