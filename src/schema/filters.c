/* schema/filters.c: rows of the pixel filters. Their sizes are pbrt-v4's; Blackman-Harris is
 * not one of pbrt's. */
#include "schema/schema.h"
#include "velo/filter.h"

#define PARAMETER(name, member, text, ...) \
  VL_PARAMETER(FLOAT, vlPixelFilter, name, member, text, __VA_ARGS__)
#define PIXELS(...) VL_DEFAULT(__VA_ARGS__), .unit = "pixels", .flags = VL_PARAMETER_ABOVE_LOW
#define RADII(size)                                                                            \
  PARAMETER("xradius", radius_x, "half of the filter's width", PIXELS(size), VL_RANGE(0, 64)), \
      PARAMETER("yradius", radius_y, "half of the filter's height", PIXELS(size),              \
                VL_RANGE(0, 64))

static const vlParameter box_parameters[] = {RADII(0.5)};
VL_KIND_ROW(box, .name = "box", .traits = VL_TRAIT_PBRT_NAME,
            .description = "constant weight in a rectangle")

static const vlParameter triangle_parameters[] = {RADII(2)};
VL_KIND_ROW(triangle, .name = "triangle", .traits = VL_TRAIT_PBRT_NAME,
            .description = "weight that falls linearly from the centre to 0 at the edge")

static const vlParameter gaussian_parameters[] = {
    RADII(1.5),
    PARAMETER("sigma", sigma, "standard deviation of the Gaussian", PIXELS(0.5),
              VL_RANGE(0, 1e6)),
};
VL_KIND_ROW(gaussian, .name = "gaussian", .traits = VL_TRAIT_PBRT_NAME,
            .description = "a Gaussian minus its value at the radius, so that it ends at 0")

static const vlParameter mitchell_parameters[] = {
    RADII(2),
    PARAMETER("B", b, "parameter B of Mitchell and Netravali", VL_DEFAULT(1.0 / 3.0),
              VL_RANGE(-10, 10)),
    PARAMETER("C", c, "parameter C of Mitchell and Netravali", VL_DEFAULT(1.0 / 3.0),
              VL_RANGE(-10, 10)),
};
VL_KIND_ROW(mitchell, .name = "mitchell", .traits = VL_TRAIT_PBRT_NAME,
            .description = "the cubic filter of Mitchell and Netravali")

static const vlParameter lanczos_parameters[] = {
    RADII(4),
    PARAMETER("tau", tau, "number of periods of the sinc in the window", VL_DEFAULT(3),
              VL_RANGE(0, 1e6), .flags = VL_PARAMETER_ABOVE_LOW),
};
VL_KIND_ROW(lanczos, .name = "sinc", .alias = "lanczos", .traits = VL_TRAIT_PBRT_NAME,
            .description = "a sinc, windowed by a wider sinc (Lanczos)")

static const vlParameter blackman_harris_parameters[] = {RADII(2)};
VL_KIND_ROW(blackman_harris, .name = "blackmanharris", .alias = "blackman-harris",
            .description = "the Blackman-Harris window")

#define ROW(NAME, name) [VL_PIXEL_FILTER_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_pixel_filter_family, VL_PIXEL_FILTER_KINDS, ROW, "filters", "pixel filter",
               "PixelFilter")

vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind) {
  vlPixelFilter filter = {.kind = kind};
  const vlKindRow *row = vl_kind_row(&vl_pixel_filter_family, (int)kind);
  if (row)
    vl_row_set_defaults(row, &filter);
  return filter;
}
