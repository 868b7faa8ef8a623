/* scene/schema/lights.c: the lights, and what shapes emit. Names and defaults are pbrt-v4's. */
#include <string.h>

#include "base/cookie.h"
#include "scene/schema/schema.h"

#define DEGREES 0.017453292519943295

/* clang-format off */
#define SCALE \
  {.name = "scale", VL_PLACE(vlLightDef, scale), .type = VL_PARAMETER_FLOAT, .value = {1}, \
   .description = "factor on the intensity or radiance"}
#define COLOR(file_name, text) \
  {.name = (file_name), VL_PLACE(vlLightDef, color), .type = VL_PARAMETER_SPECTRUM, .role = VL_PARAMETER_ILLUMINANT, \
   .flags = VL_PARAMETER_RGB, .value = {1, 1, 1}, .description = (text)}
#define INTENSITY COLOR("I", "intensity; its luminance is 1 before scale")
#define RADIANCE COLOR("L", "radiance; its luminance is 1 before scale")
#define POWER \
  {.name = "power", VL_PLACE(vlLightDef, power), .type = VL_PARAMETER_DOUBLE, .unit = "W", \
   .flags = VL_PARAMETER_UNSET, VL_FROM(0), .description = "power of the whole light, times scale, in place of its own"}
#define ILLUMINANCE \
  {.name = "illuminance", VL_PLACE(vlLightDef, illuminance), .type = VL_PARAMETER_DOUBLE, .unit = "lx", \
   .flags = VL_PARAMETER_UNSET, VL_FROM(0), \
   .description = "illuminance of a surface that faces the light, times scale, in place of its own"}
#define FROM(text) \
  {.name = "from", VL_PLACE(vlLightDef, from), .type = VL_PARAMETER_FLOAT3, .description = (text)}
#define TO(text) \
  {.name = "to", VL_PLACE(vlLightDef, to), .type = VL_PARAMETER_FLOAT3, .value = {0, 0, 1}, .description = (text)}
#define IMAGE(more_flags, text) \
  {.name = "filename", VL_PLACE(vlLightDef, path), .type = VL_PARAMETER_FILE, .flags = (more_flags), \
   .description = (text)}, \
  {VL_PLACE(vlLightDef, image), .type = VL_PARAMETER_BLOCK, .description = "the image itself, in place of a file"}, \
  {VL_PLACE(vlLightDef, space), .type = VL_PARAMETER_BLOCK, \
   .description = "colour space of an image that names none itself"}
/* clang-format on */

static const vlParameter point_parameters[] = {INTENSITY, SCALE, POWER, FROM("position")};
VL_KIND_ROW(point, .identifier = "POINT", .name = "point", .description = "a point that shines in all directions",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA)

static const vlParameter spot_parameters[] = {INTENSITY,
                                              SCALE,
                                              POWER,
                                              FROM("position"),
                                              TO("a point on the axis"),
                                              {.name = "coneangle",
                                               VL_PLACE(vlLightDef, cone_angle),
                                               .type = VL_PARAMETER_FLOAT,
                                               .unit = "degrees",
                                               .factor = DEGREES,
                                               .value = {30 * DEGREES},
                                               VL_RANGE(0, 180 * DEGREES + 1e-6),
                                               .flags = VL_PARAMETER_ABOVE_LOW,
                                               .description = "from the axis to where the light ends"},
                                              {.name = "conedeltaangle",
                                               VL_PLACE(vlLightDef, cone_delta),
                                               .type = VL_PARAMETER_FLOAT,
                                               .unit = "degrees",
                                               .factor = DEGREES,
                                               .value = {5 * DEGREES},
                                               VL_FROM(0),
                                               .description = "width of the edge inside of the cone"},
                                              {VL_PLACE(vlLightDef, cone_squared),
                                               .type = VL_PARAMETER_BOOL,
                                               .description = "the edge is the square of a line in the cosine (glTF); "
                                                              "else a smooth step"}};
VL_KIND_ROW(spot, .identifier = "SPOT", .name = "spot", .description = "a point that shines into a cone",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter distant_parameters[] = {RADIANCE, SCALE, ILLUMINANCE, FROM("start of the direction of light"),
                                                 TO("end of the direction of light")};
VL_KIND_ROW(distant, .identifier = "DISTANT", .name = "distant",
            .description = "light of one direction, from infinitely far away",
            .traits = VL_LIGHT_TRAIT_FAR | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS)

static const vlParameter infinite_parameters[] = {
    RADIANCE, SCALE, ILLUMINANCE,
    IMAGE(0, "an equal-area octahedral map of the radiance, square, in place of L"),
    {.name = "portal",
     VL_PLACE(vlLightDef, portal),
     .type = VL_PARAMETER_BLOCK,
     .description = "4 corners of a rectangle in the world through which alone the light comes"}};
VL_KIND_ROW(infinite, .identifier = "INFINITE", .name = "infinite", .description = "light from all around",
            .traits = VL_LIGHT_TRAIT_FAR)

static const vlParameter goniometric_parameters[] = {
    INTENSITY, SCALE, POWER,
    IMAGE(VL_PARAMETER_REQUIRED, "an equal-area octahedral map, square, of the factor on the intensity")};
VL_KIND_ROW(goniometric, .identifier = "GONIOMETRIC", .name = "goniometric",
            .description = "a point whose intensity an image gives by direction",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

static const vlParameter projection_parameters[] = {
    SCALE, POWER, IMAGE(VL_PARAMETER_REQUIRED, "the image, whose values are the intensity"),
    {.name = "fov",
     VL_PLACE(vlLightDef, fov),
     .type = VL_PARAMETER_FLOAT,
     .unit = "degrees",
     .factor = DEGREES,
     .value = {90 * DEGREES},
     VL_RANGE(0, 3.1415),
     .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH,
     .description = "angle across the image's smaller side"}};
VL_KIND_ROW(projection, .identifier = "PROJECTION", .name = "projection",
            .description = "a point that throws an image along its z axis, y up",
            .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_IMAGE)

#define ROW(NAME, name) [VL_LIGHT_##NAME] = &name##_row,
static const vlKindRow *const rows[] = {VL_LIGHT_KINDS(ROW)};

const vlKindFamily vl_light_family = {"lights", "light", "LightSource", sizeof rows / sizeof *rows, rows};

vlLightDef vl_default_light_def(vlLightKind kind) {
  vlLightDef def = {.cookie = VL_COOKIE_LIGHT, .kind = kind, .scale = 1.0f, .power = VL_UNSET, .illuminance = VL_UNSET};
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)kind);
  if (row) vl_row_set_defaults(row, &def);
  for (int i = 0; i < 16; i += 5) def.world_from_light[i] = 1.0;
  return def;
}

/* ---- what shapes emit -------------------------------------------------------------------------------------------- */

static const vlParameter diffuse_parameters[] = {
    {.name = "L",
     VL_PLACE(vlEmissionDef, radiance),
     .type = VL_PARAMETER_SPECTRUM,
     .role = VL_PARAMETER_ILLUMINANT,
     .flags = VL_PARAMETER_RGB,
     .value = {1, 1, 1},
     .description = "radiance; its luminance is 1 before scale"},
    {.name = "scale",
     VL_PLACE(vlEmissionDef, scale),
     .type = VL_PARAMETER_FLOAT,
     .value = {1},
     .description = "factor on the radiance"},
    {.name = "twosided",
     VL_PLACE(vlEmissionDef, two_sided),
     .type = VL_PARAMETER_BOOL,
     .description = "both sides of the surface emit"},
    {.name = "power",
     VL_PLACE(vlEmissionDef, power),
     .type = VL_PARAMETER_DOUBLE,
     .unit = "W",
     .flags = VL_PARAMETER_UNSET,
     VL_FROM(0),
     .description = "power of each face, times scale, in place of its own"},
    {.name = "filename",
     VL_PLACE(vlEmissionDef, image),
     .type = VL_PARAMETER_FILE,
     .description = "image of the radiance over uv, in place of L"},
    {VL_PLACE(vlEmissionDef, texture),
     .type = VL_PARAMETER_TEXTURE,
     .description = "an image texture of the radiance over uv, in place of L"}};
VL_KIND_ROW(diffuse, .identifier = "DIFFUSE", .name = "diffuse",
            .description = "a surface of the same radiance in all directions")

static const vlKindRow *const emission_rows[] = {&diffuse_row};

const vlKindFamily vl_emission_family = {"area lights", "area light", "AreaLightSource", 1, emission_rows};

vlEmissionDef vl_default_emission_def(void) {
  vlEmissionDef def = {.cookie = VL_COOKIE_EMISSION};
  vl_row_set_defaults(&diffuse_row, &def);
  return def;
}
