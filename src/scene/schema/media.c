/* scene/schema/media.c: participating media. Names and defaults are pbrt-v4's. */
#include "base/cookie.h"
#include "scene/schema/schema.h"

/* clang-format off */
#define SCALE \
  {.name = "scale", VL_PLACE(vlMediumDef, scale), .type = VL_PARAMETER_FLOAT, .value = {1}, VL_FROM(0), \
   .description = "factor on sigma_a and sigma_s"}
#define ASYMMETRY \
  {.name = "g", VL_PLACE(vlMediumDef, g), .type = VL_PARAMETER_FLOAT, VL_RANGE(-1, 1), \
   .description = "mean cosine of scattering (Henyey-Greenstein)"}
#define SIGMA(file_name, field, text) \
  {.name = (file_name), VL_PLACE(vlMediumDef, field), .type = VL_PARAMETER_SPECTRUM, .role = VL_PARAMETER_UNBOUNDED, \
   .unit = "1 / length", .value = {1}, VL_FROM(0), .description = (text)}
#define SIGMAS \
  SIGMA("sigma_a", sigma_a, "absorption coefficient"), SIGMA("sigma_s", sigma_s, "scattering coefficient")
#define PRESET \
  {.name = "preset", VL_PLACE(vlMediumDef, sigma_a), .type = VL_PARAMETER_STRING, \
   .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, \
   .description = "a measured substance, in place of sigma_a and sigma_s (per millimetre)"}
#define EMISSION(more_flags) \
  {.name = "Le", VL_PLACE(vlMediumDef, emission), .type = VL_PARAMETER_SPECTRUM, .role = VL_PARAMETER_ILLUMINANT, \
   VL_FROM(0), .description = "radiance emitted where light is absorbed"}, \
  {.name = "Lescale", VL_PLACE(vlMediumDef, emission_scale), .type = VL_PARAMETER_FLOAT, .value = {1}, VL_FROM(0), \
   .flags = (more_flags), .description = "factor on the emission"}
#define BOX \
  {.name = "p0", VL_PLACE(vlMediumDef, low), .type = VL_PARAMETER_FLOAT3, .unit = "length", \
   .description = "a corner of the box, in medium space"}, \
  {.name = "p1", VL_PLACE(vlMediumDef, high), .type = VL_PARAMETER_FLOAT3, .unit = "length", .value = {1, 1, 1}, \
   .description = "the opposite corner"}
#define CELLS(file_name, field, axis) \
  {.name = (file_name), VL_PLACE(vlMediumDef, field), .type = VL_PARAMETER_COUNT, .unit = "cells", .value = {1}, \
   VL_RANGE(1, 16384), .description = "cells along " axis}
#define RESOLUTION CELLS("nx", nx, "x"), CELLS("ny", ny, "y"), CELLS("nz", nz, "z")
#define VALUES(file_name, field, text) \
  {.name = (file_name), VL_PLACE(vlMediumDef, field), .type = VL_PARAMETER_BLOCK, .description = (text)}
#define TEMPERATURE \
  {.name = "temperatureoffset", .alias = "temperaturecutoff", VL_PLACE(vlMediumDef, temperature_offset), \
   .type = VL_PARAMETER_FLOAT, .unit = "K", .description = "kelvin = (temperature - offset) * scale"}, \
  {.name = "temperaturescale", VL_PLACE(vlMediumDef, temperature_scale), .type = VL_PARAMETER_FLOAT, .value = {1}, \
   .description = "see temperatureoffset"}
#define FACTOR(file_name, field, number, text) \
  {.name = (file_name), VL_PLACE(vlMediumDef, field), .type = VL_PARAMETER_FLOAT, .value = {number}, VL_FROM(0), \
   .description = (text)}
/* clang-format on */

static const vlParameter homogeneous_parameters[] = {SIGMAS, PRESET, SCALE, ASYMMETRY, EMISSION(0)};
VL_KIND_ROW(homogeneous, .identifier = "HOMOGENEOUS", .name = "homogeneous", .description = "the same everywhere")

static const vlParameter grid_parameters[] = {
    SIGMAS,
    PRESET,
    SCALE,
    ASYMMETRY,
    EMISSION(VL_PARAMETER_RULE), /* one number, or one per cell */
    BOX,
    RESOLUTION,
    VALUES("density", density, "factor on sigma_a and sigma_s, one number per cell"),
    VALUES("Lescale", emission_scales, "factor on the emission, one number per cell"),
    VALUES("temperature", temperature, "of a black body, in place of Le: one number per cell"),
    TEMPERATURE};
VL_KIND_ROW(grid, .identifier = "GRID", .name = "uniformgrid",
            .description = "sigma_a and sigma_s times a density on a grid over a box",
            .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS)

static const vlParameter rgb_grid_parameters[] = {
    SCALE,
    ASYMMETRY,
    BOX,
    RESOLUTION,
    VALUES("sigma_a", rgb_a, "absorption coefficient, RGB per cell"),
    VALUES("sigma_s", rgb_s, "scattering coefficient, RGB per cell"),
    VALUES("Le", rgb_emission, "radiance emitted where light is absorbed, RGB per cell"),
    FACTOR("Lescale", emission_scale, 1, "factor on the emission")};
VL_KIND_ROW(rgb_grid, .identifier = "RGB_GRID", .name = "rgbgrid",
            .description = "sigma_a and sigma_s themselves on a grid over a box",
            .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS | VL_MEDIUM_TRAIT_OWN_SIGMA)

static const vlParameter cloud_parameters[] = {
    SIGMAS,
    SCALE,
    ASYMMETRY,
    BOX,
    FACTOR("density", cloud_density, 1, "factor on the noise's density"),
    FACTOR("wispiness", wispiness, 1, "how far noise displaces the cloud"),
    FACTOR("frequency", frequency, 5, "of the noise")};
VL_KIND_ROW(cloud, .identifier = "CLOUD", .name = "cloud", .description = "a cloud of noise in a box",
            .traits = VL_MEDIUM_TRAIT_BOX)

static const vlParameter nanovdb_parameters[] = {
    SIGMAS,
    SCALE,
    ASYMMETRY,
    {.name = "filename",
     VL_PLACE(vlMediumDef, path),
     .type = VL_PARAMETER_FILE,
     .flags = VL_PARAMETER_REQUIRED,
     .description = "a NanoVDB file"},
    {.name = "gridname",
     VL_PLACE(vlMediumDef, grid),
     .type = VL_PARAMETER_STRING,
     .description = "name of the density's grid; unset: density"},
    {.name = "temperaturename",
     VL_PLACE(vlMediumDef, temperature_grid),
     .type = VL_PARAMETER_STRING,
     .description = "name of the temperature's grid; unset: temperature, which may be absent"},
    {.name = "Lescale",
     .alias = "LeScale",
     VL_PLACE(vlMediumDef, emission_scale),
     .type = VL_PARAMETER_FLOAT,
     .value = {1},
     VL_FROM(0),
     .description = "factor on the emission of a black body"},
    TEMPERATURE};
VL_KIND_ROW(nanovdb, .identifier = "NANOVDB", .name = "nanovdb",
            .description = "sigma_a and sigma_s times a density from a NanoVDB file")

#define ROW(NAME, name) [VL_MEDIUM_##NAME] = &name##_row,
static const vlKindRow *const rows[] = {VL_MEDIUM_KINDS(ROW)};

const vlKindFamily vl_medium_family = {"media", "medium type", "MakeNamedMedium", sizeof rows / sizeof *rows, rows};

vlMediumDef vl_default_medium_def(vlMediumKind kind) {
  vlMediumDef def = {
      .cookie = VL_COOKIE_MEDIUM, .kind = kind, .emission_scale = 1.0f, .temperature_scale = 1.0f, .scale = 1.0f};
  const vlKindRow *row = vl_kind_row(&vl_medium_family, (int)kind);
  if (row) vl_row_set_defaults(row, &def);
  for (int i = 0; i < 16; i += 5) def.world_from_medium[i] = 1.0;
  return def;
}
