/* scene/schema/lights.c: rows of the lights, and of the emission of shapes. Names and defaults are pbrt-v4's. */
#include <math.h>

#include "base/cookie.h"
#include "math/elementary.h"
#include "scene/schema/schema.h"

#define PI 3.14159265358979323846
#define DEGREES (PI / 180)

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlLightDef, __VA_ARGS__)
#define ANGLE(...) VL_DEFAULT(__VA_ARGS__), .unit = "degrees", .factor = DEGREES
#define COLOR(name, text)                                                                \
  PARAMETER(SPECTRUM, name, color, text, VL_DEFAULT(1, 1, 1), .flags = VL_PARAMETER_RGB, \
            .role = VL_PARAMETER_ILLUMINANT)
#define INTENSITY COLOR("I", "intensity; its luminance is 1 before scale")
#define RADIANCE COLOR("L", "radiance; its luminance is 1 before scale")
#define SCALE PARAMETER(FLOAT, "scale", scale, "factor on the intensity or radiance", VL_DEFAULT(1))
#define POWER                                                                                            \
  PARAMETER(DOUBLE, "power", power, "of the whole light, times scale; in place of its own", .unit = "W", \
            .flags = VL_PARAMETER_UNSET)
#define ILLUMINANCE                                                                                                    \
  PARAMETER(DOUBLE, "illuminance", illuminance, "of a surface that faces the light, times scale; in place of its own", \
            .unit = "lx", .flags = VL_PARAMETER_UNSET)
#define FROM(text) PARAMETER(FLOAT3, "from", from, text, .unit = NULL)
/* The position of kinds that files place by their transform alone. */
#define POSITION PARAMETER(FLOAT3, NULL, from, "position", .unit = NULL)
#define TO(text) PARAMETER(FLOAT3, "to", to, text, VL_DEFAULT(0, 0, 1))
#define IMAGE(line)                                                                        \
  PARAMETER(FILE, "filename", path, line, .unit = NULL),                                   \
      PARAMETER(BLOCK, NULL, image, "the image itself, in place of a file", .unit = NULL), \
      PARAMETER(BLOCK, NULL, space, "colour space of an image that names none itself", .unit = NULL)

static const vlParameter point_parameters[] = {INTENSITY, SCALE, POWER, FROM("position")};
VL_KIND_ROW(point, .name = "point", .description = "a point that emits in all directions",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA)

static const vlParameter spot_parameters[] = {
    INTENSITY,
    SCALE,
    POWER,
    FROM("position"),
    TO("a point on the axis"),
    PARAMETER(FLOAT, "coneangle", cone_angle, "from the axis to where the light ends", ANGLE(30 * DEGREES),
              VL_RANGE(0, 180 * DEGREES + 1e-6), .flags = VL_PARAMETER_ABOVE_LOW),
    PARAMETER(FLOAT, "conedeltaangle", cone_delta, "width of the edge inside of the cone", ANGLE(5 * DEGREES),
              VL_FROM(0)),
    PARAMETER(BOOL, NULL, cone_squared, "the edge is t^2 in the cosine, as glTF's; else 3t^2 - 2t^3", VL_DEFAULT(0)),
};
VL_KIND_ROW(spot, .name = "spot", .description = "a point that emits into a cone",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter distant_parameters[] = {RADIANCE, SCALE, ILLUMINANCE, FROM("start of the light's direction"),
                                                 TO("end of the light's direction")};
VL_KIND_ROW(distant, .name = "distant", .description = "light of one direction, from infinitely far away",
            .traits = VL_LIGHT_TRAIT_FAR | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter infinite_parameters[] = {
    RADIANCE,
    SCALE,
    ILLUMINANCE,
    IMAGE("an equal-area octahedral map of the radiance, square; in place of L"),
    PARAMETER(BLOCK, "portal", portal, "4 corners of a rectangle in the world through which alone the light comes",
              .text = "point3"),
};
VL_KIND_ROW(infinite, .name = "infinite", .description = "light from all around", .traits = VL_LIGHT_TRAIT_FAR)

static const vlParameter goniometric_parameters[] = {
    INTENSITY, SCALE, POWER, POSITION,
    IMAGE("required: an equal-area octahedral map of the factor on the intensity, square")};
VL_KIND_ROW(goniometric, .name = "goniometric", .description = "a point whose intensity an image gives by direction",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

static const vlParameter projection_parameters[] = {
    SCALE,
    POWER,
    POSITION,
    IMAGE("required: the image, whose values are the intensity"),
    PARAMETER(FLOAT, "fov", fov, "angle across the image's smaller side", ANGLE(90 * DEGREES), VL_RANGE(0, 3.1415),
              .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH),
};
VL_KIND_ROW(projection, .name = "projection", .description = "a point that throws an image along its z axis, y up",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

#define ROW(NAME, name) [VL_LIGHT_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_light_family, VL_LIGHT_KINDS, ROW, "lights", "light", "LightSource")

vlLightDef vl_default_light_def(vlLightKind kind) {
  vlLightDef def = {.cookie = VL_COOKIE_LIGHT, .kind = kind};
  vl_family_set_defaults(&vl_light_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5) def.world_from_light[i] = 1.0;
  return def;
}

/* ---- power, a function per kind ---------------------------------------------------------------------------------- */

typedef double Power(const vlLightDef *def, double luminance, double radius);

static double point_power(const vlLightDef *def, double luminance, double radius) {
  (void)def, (void)radius;
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
  if (def->path || def->image) return NAN;
  return 4 * PI * PI * radius * radius * (def->illuminance > 0 ? def->illuminance / PI : luminance);
}

static double goniometric_power(const vlLightDef *def, double luminance, double radius) {
  (void)def, (void)luminance, (void)radius;
  return NAN;
}

static double projection_power(const vlLightDef *def, double luminance, double radius) {
  (void)def, (void)luminance, (void)radius;
  return NAN;
}

#define POWER_OF(NAME, name) [VL_LIGHT_##NAME] = name##_power,
static Power *const powers[] = {VL_LIGHT_KINDS(POWER_OF)};

double vl_light_power(const vlLightDef *def, double luminance, double radius) {
  return def->power > 0 ? def->power : powers[def->kind](def, luminance, radius);
}

/* ---- what shapes emit -------------------------------------------------------------------------------------------- */

#undef PARAMETER
#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlEmissionDef, __VA_ARGS__)

static const vlParameter diffuse_parameters[] = {
    PARAMETER(SPECTRUM, "L", radiance, "radiance; its luminance is 1 before scale", VL_DEFAULT(1, 1, 1),
              .flags = VL_PARAMETER_RGB, .role = VL_PARAMETER_ILLUMINANT),
    PARAMETER(FLOAT, "scale", scale, "factor on the radiance", VL_DEFAULT(1)),
    PARAMETER(BOOL, "twosided", two_sided, "both sides of the surface emit", VL_DEFAULT(0)),
    PARAMETER(DOUBLE, "power", power, "of each face, times scale; in place of its own", .unit = "W",
              .flags = VL_PARAMETER_UNSET),
    PARAMETER(FILE, "filename", image, "image of the radiance over uv; in place of L", .text = NULL),
    PARAMETER(TEXTURE, NULL, texture, "an image texture of the radiance over uv; in place of L", .unit = NULL),
};
VL_KIND_ROW(diffuse, .name = "diffuse", .description = "a surface of the same radiance in all directions", .traits = 0)

#define EMISSION_KINDS(X) X(DIFFUSE, diffuse)
#define EMISSION_ROW(NAME, name) &name##_row,
VL_KIND_FAMILY(vl_emission_family, EMISSION_KINDS, EMISSION_ROW, "emission", "area light", "AreaLightSource")

vlEmissionDef vl_default_emission_def(void) {
  vlEmissionDef def = {.cookie = VL_COOKIE_EMISSION};
  vl_row_set_defaults(&diffuse_row, &def);
  return def;
}
