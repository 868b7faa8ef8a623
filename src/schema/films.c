/* schema/films.c: rows of the films, which are those of pbrt. A row describes members of
 * vlSceneDefs. */
#include <math.h>

#include "schema/schema.h"
#include "velo/render.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, __VA_ARGS__)
#define RULE VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND
/* A parameter that is one factor of develop.exposure. */
#define EXPOSURE(file_name, usual, text)                                                \
  {                                                                                     \
    .name = file_name, .member = "develop.exposure", .type = VL_PARAMETER_DOUBLE,       \
    .flags = RULE, .offset = offsetof(vlSceneDefs, develop.exposure), .value = {usual}, \
    .low = 0, .high = (double)INFINITY, .description = text                             \
  }
#define SIZE(name, member, usual, text) \
  PARAMETER(COUNT, name, member, text, VL_DEFAULT(usual), VL_RANGE(1, 65536), .unit = "pixels")
#define COMMON                                                                                 \
  SIZE("xresolution", film.width, 1280, "width of the whole image"),                           \
      SIZE("yresolution", film.height, 720, "height of the whole image"),                      \
      PARAMETER(BLOCK, "filename", output, "name of the image file", .text = "string",         \
                .flags = VL_PARAMETER_RULE),                                                   \
      PARAMETER(BLOCK, "pixelbounds", film.crop,                                               \
                "x0, x1, y0, y1 of the pixels that are rendered; x1, y1 exclusive",            \
                .text = "integer", .flags = VL_PARAMETER_RULE),                                \
      PARAMETER(                                                                               \
          BLOCK, "cropwindow", film.crop,                                                      \
          "the crop window in fractions of the size; used instead of pixelbounds if both "     \
          "are given",                                                                         \
          .text = "float", .flags = VL_PARAMETER_RULE),                                        \
      {.name = "diagonal",                                                                     \
       .member = "camera.lens",                                                                \
       .type = VL_PARAMETER_DOUBLE,                                                            \
       .flags = RULE,                                                                          \
       .value = {35},                                                                          \
       .unit = "mm",                                                                           \
       .description = "diagonal of the sensor; used by realistic cameras"},                    \
      EXPOSURE("iso", 100, "sensitivity: the image is multiplied by iso / 100"),               \
      EXPOSURE("exposuretime", 1, "exposure time: the image is multiplied by it"),             \
      EXPOSURE("imagingratio", 1, "imaging ratio: the image is multiplied by it"),             \
      PARAMETER(STRING, "sensor", film.sensor,                                                 \
                "spectral response: cie1931, or a measured camera (vl_sensor_name)",           \
                .text = NULL, .flags = VL_PARAMETER_RULE),                                     \
      PARAMETER(                                                                               \
          DOUBLE, "whitebalance", film.white_balance,                                          \
          "colour temperature, 1000 to 100000, of the daylight that becomes white; 0: no "     \
          "white balance",                                                                     \
          .flags = VL_PARAMETER_RULE, .unit = "K"),                                            \
      PARAMETER(FLOAT, "maxcomponentvalue", film.max_component,                                \
                "samples with a larger component are scaled down to it", VL_DEFAULT(INFINITY), \
                VL_FROM(0), .flags = VL_PARAMETER_RULE | VL_PARAMETER_INFINITE),               \
  {                                                                                            \
    .name = "savefp16", .member = "", .type = VL_PARAMETER_BOOL, .flags = RULE,                \
    .description = "ignored"                                                                   \
  }

static const vlParameter rgb_parameters[] = {COMMON};
static const vlKindRow rgb_row = {VL_ROW_PARAMETERS(rgb_parameters), .name = "rgb",
                                  .description = "an RGB image"};

static const char *const systems[] = {"camera", "world", NULL};
static const vlParameter gbuffer_parameters[] = {
    COMMON,
    PARAMETER(CHOICE, "coordinatesystem", gbuffer,
              "coordinate system of the channels' points and normals", .choices = systems,
              .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND),
};
static const vlKindRow gbuffer_row = {VL_ROW_PARAMETERS(gbuffer_parameters), .name = "gbuffer",
                                      .description = "an RGB image with ground truth channels"};

#define WAVELENGTH(name, member, usual, text) \
  PARAMETER(DOUBLE, name, member, text, VL_DEFAULT(usual), VL_RANGE(360, 830), .unit = "nm")
static const vlParameter spectral_parameters[] = {
    COMMON,
    PARAMETER(COUNT, "nbuckets", film.buckets, "number of intervals (buckets) of wavelength",
              VL_DEFAULT(16), VL_RANGE(1, 1000)),
    WAVELENGTH("lambdamin", film.lambda_min, 360, "start of the first bucket"),
    WAVELENGTH("lambdamax", film.lambda_max, 830, "end of the last bucket"),
};
static const vlKindRow spectral_row = {
    VL_ROW_PARAMETERS(spectral_parameters), .name = "spectral",
    .description = "an RGB image with a spectrum, in intervals of wavelength"};

#define FILM_ROWS(X)              \
  X(VL_FILM_RGB, rgb_row)         \
  X(VL_FILM_GBUFFER, gbuffer_row) \
  X(VL_FILM_SPECTRAL, spectral_row)
_Static_assert(0 FILM_ROWS(VL_COUNT_KIND) == 0 VL_FILM_KINDS(VL_COUNT_KIND),
               "each film has a row");
const vlKindFamily vl_film_family =
    VL_KIND_FAMILY(FILM_ROWS(VL_LIST_ROW), VL_FILM_KINDS, "films", "film", "Film");
