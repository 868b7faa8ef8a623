/* light/light.row.h: for the files that hold rows of lights: parameters by type, and those that
 * several kinds share. Names in files and defaults are pbrt-v4's. */
#ifndef LIGHT_LIGHT_ROW_H
#define LIGHT_LIGHT_ROW_H

#include "schema/schema.h"
#include "velo/light.h"

/* Power of a light, by pbrt's definition: vl_light_power, for lights whose parameter `power` is
 * not given. */
typedef double vlLightPower(const vlLightDef *def, double luminance, double radius);
/* Of kinds whose power depends on an image: NaN. */
vlLightPower vl_light_power_unknown;

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
            .unit = "lm", .flags = VL_PARAMETER_UNSET)
#define ILLUMINANCE                                                                         \
  PARAMETER(                                                                                \
      DOUBLE, "illuminance", illuminance,                                                   \
      "illuminance of a surface that faces the light: the light is scaled to it, and then " \
      "multiplied by scale",                                                                \
      .unit = "lx", .flags = VL_PARAMETER_UNSET)
/* Radiometric forms: vl_scene_add_light turns them into the photometric ones. */
#define RADIOMETRIC(name, member, unit_text, text)                                            \
  PARAMETER(DOUBLE, name, member, text ", from 360 to 830 nm", VL_FROM(0), .unit = unit_text, \
            .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW)
#define RADIANT_POWER                             \
  RADIOMETRIC("radiantpower", radiant_power, "W", \
              "radiant power, in place of power: that of all directions and wavelengths")
#define RADIANT_INTENSITY                            \
  RADIOMETRIC(                                       \
      "radiantintensity", radiant_intensity, "W/sr", \
      "radiant intensity (of a spot: along its axis), in place of the intensity's size")
#define IRRADIANCE                               \
  RADIOMETRIC("irradiance", irradiance, "W/m^2", \
              "irradiance of a surface that faces the light, in place of illuminance")
#define FROM(text) PARAMETER(FLOAT3, "from", from, text, .unit = NULL)
/* The position of kinds that files place by their transform alone. */
#define POSITION PARAMETER(FLOAT3, NULL, from, "position of the light", .unit = NULL)
#define TO(text) PARAMETER(FLOAT3, "to", to, text, VL_DEFAULT(0, 0, 1))
#define IMAGE(line)                                                                          \
  PARAMETER(FILE, "filename", path, line, .unit = NULL),                                     \
      PARAMETER(BLOCK, NULL, image, "an image in memory, in place of a file", .unit = NULL), \
      PARAMETER(BLOCK, NULL, space, "colour space of an image that does not name its own",   \
                .unit = NULL)

#endif
