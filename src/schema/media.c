/* schema/media.c: rows of the participating media. Names and defaults are pbrt-v4's. */
#include "base/cookie.h"
#include "schema/schema.h"
#include "velo/medium.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlMediumDef, __VA_ARGS__)
#define FACTOR(name, member, text, ...) \
  PARAMETER(FLOAT, name, member, text, VL_DEFAULT(__VA_ARGS__), VL_FROM(0))
#define SCALE FACTOR("scale", scale, "factor on sigma_a and sigma_s", 1)
#define ASYMMETRY                                                                             \
  PARAMETER(FLOAT, "g", g,                                                                    \
            "asymmetry g of the Henyey-Greenstein phase function: mean cosine of scattering", \
            VL_RANGE(-1, 1))
#define SIGMA(name, member, text)                                    \
  PARAMETER(SPECTRUM, name, member, text, VL_DEFAULT(1), VL_FROM(0), \
            .role = VL_PARAMETER_UNBOUNDED, .unit = "per length")
#define SIGMAS                                         \
  SIGMA("sigma_a", sigma_a, "absorption coefficient"), \
      SIGMA("sigma_s", sigma_s, "scattering coefficient")
/* A parameter of files that sets two members. */
#define PRESET                                                                            \
  {                                                                                       \
    .type = VL_PARAMETER_STRING, .name = "preset", .member = "sigma_a, sigma_s",          \
    .offset = offsetof(vlMediumDef, sigma_a),                                             \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND,                                  \
    .description =                                                                        \
        "a measured substance, coefficients per millimetre; replaces sigma_a and sigma_s" \
  }
#define EMISSION                                                                       \
  PARAMETER(SPECTRUM, "Le", emission,                                                  \
            "emission: the medium emits the radiance sigma_a * Le per unit of length", \
            VL_FROM(0), .role = VL_PARAMETER_ILLUMINANT)
#define BOX                                                                             \
  PARAMETER(FLOAT3, "p0", low, "one corner of the box, in medium space", .unit = NULL), \
      PARAMETER(FLOAT3, "p1", high, "opposite corner of the box", VL_DEFAULT(1, 1, 1))
#define CELLS(name, member, text) \
  PARAMETER(COUNT, name, member, text, .unit = "cells", VL_DEFAULT(1), VL_RANGE(1, 16384))
#define RESOLUTION                                                                        \
  CELLS("nx", nx, "number of cells along x"), CELLS("ny", ny, "number of cells along y"), \
      CELLS("nz", nz, "number of cells along z")
#define VALUES(name, member, type_in_files, line) \
  PARAMETER(BLOCK, name, member, line, .text = type_in_files)
#define TEMPERATURE                                                                        \
  PARAMETER(                                                                               \
      FLOAT, "temperatureoffset", temperature_offset,                                      \
      "the temperature in kelvin is (temperature - temperatureoffset) * temperaturescale", \
      .alias = "temperaturecutoff", .unit = "K"),                                          \
      PARAMETER(FLOAT, "temperaturescale", temperature_scale,                              \
                "factor on the temperature after the offset is subtracted", VL_DEFAULT(1))

static const vlParameter homogeneous_parameters[] = {
    SIGMAS,
    PRESET,
    SCALE,
    ASYMMETRY,
    EMISSION,
    FACTOR("Lescale", emission_scale, "factor on the emission", 1),
    PARAMETER(BOOL, NULL, rgb_absorption,
              "true: sigma_a attenuates each channel of linear sRGB separately, at any depth"),
};
VL_KIND_ROW(homogeneous, .name = "homogeneous",
            .description = "sigma_a and sigma_s are the same everywhere", .traits = 0)

static const vlParameter grid_parameters[] = {
    SIGMAS,
    PRESET,
    SCALE,
    ASYMMETRY,
    BOX,
    RESOLUTION,
    VALUES("density", density, "float array",
           "factor on sigma_a and sigma_s, one number per cell"),
    EMISSION,
    PARAMETER(FLOAT, "Lescale", emission_scale,
              "factor on the emission: one number, or one per cell", VL_DEFAULT(1), VL_FROM(0),
              .flags = VL_PARAMETER_RULE),
    VALUES(NULL, emission_scales, NULL, "factor on the emission, one number per cell"),
    VALUES("temperature", temperature, "float array",
           "temperature of a black body, one number per cell; its emission replaces Le"),
    TEMPERATURE,
};
VL_KIND_ROW(grid, .name = "uniformgrid",
            .description = "sigma_a and sigma_s, multiplied by a density on a grid in a box",
            .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS)

static const vlParameter rgb_grid_parameters[] = {
    SCALE,
    ASYMMETRY,
    BOX,
    RESOLUTION,
    VALUES("sigma_a", rgb_a, "rgb array", "absorption coefficient, one RGB colour per cell"),
    VALUES("sigma_s", rgb_s, "rgb array", "scattering coefficient, one RGB colour per cell"),
    VALUES("Le", rgb_emission, "rgb array",
           "emission, one RGB colour per cell: the medium emits the radiance sigma_a * Le per "
           "unit "
           "of length"),
    FACTOR("Lescale", emission_scale, "factor on the emission", 1),
};
VL_KIND_ROW(rgb_grid, .name = "rgbgrid",
            .description = "sigma_a and sigma_s, given for each cell of a grid in a box",
            .traits = VL_MEDIUM_TRAIT_BOX | VL_MEDIUM_TRAIT_CELLS)

static const vlParameter cloud_parameters[] = {
    SIGMAS,
    SCALE,
    ASYMMETRY,
    BOX,
    FACTOR("density", cloud_density, "factor on the density of the cloud's noise", 1),
    FACTOR("wispiness", wispiness, "strength of the noise that displaces the cloud's density",
           1),
    FACTOR("frequency", frequency, "frequency of the noise", 5),
};
VL_KIND_ROW(
    cloud, .name = "cloud",
    .description = "sigma_a and sigma_s, multiplied by a procedural cloud density in a box",
    .traits = VL_MEDIUM_TRAIT_BOX)

static const vlParameter nanovdb_parameters[] = {
    SIGMAS,
    SCALE,
    ASYMMETRY,
    PARAMETER(FILE, "filename", path, "required: a NanoVDB file",
              .flags = VL_PARAMETER_REQUIRED),
    PARAMETER(STRING, "gridname", grid, "name of the density grid; unset: density",
              .text = NULL),
    PARAMETER(STRING, "temperaturename", temperature_grid,
              "name of the temperature grid; unset: temperature, which may be absent",
              .text = NULL),
    PARAMETER(FLOAT, "Lescale", emission_scale,
              "factor on the black-body emission of the temperature grid", VL_DEFAULT(1),
              VL_FROM(0), .alias = "LeScale"),
    TEMPERATURE,
};
VL_KIND_ROW(nanovdb, .name = "nanovdb",
            .description = "sigma_a and sigma_s, multiplied by a density from a NanoVDB file",
            .traits = 0)

#define ROW(NAME, name) [VL_MEDIUM_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_medium_family, VL_MEDIUM_KINDS, ROW, "media", "medium type",
               "MakeNamedMedium")

vlMediumDef vl_default_medium_def(vlMediumKind kind) {
  vlMediumDef def = {.cookie = VL_COOKIE_MEDIUM, .kind = kind};
  vl_family_set_defaults(&vl_medium_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.world_from_medium[i] = 1.0;
  return def;
}
