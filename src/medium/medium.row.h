/* medium/medium.row.h: for the files that hold rows of media: parameters by type, and those
 * that several kinds share. Names in files and defaults are pbrt-v4's. */
#ifndef MEDIUM_MEDIUM_ROW_H
#define MEDIUM_MEDIUM_ROW_H

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

#endif
