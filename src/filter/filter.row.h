/* filter/filter.row.h: for the files that hold rows of pixel filters: the sizes are pbrt-v4's;
 * Blackman-Harris is not one of pbrt's. */
#ifndef FILTER_FILTER_ROW_H
#define FILTER_FILTER_ROW_H

#include "schema/schema.h"
#include "velo/filter.h"

#define PARAMETER(name, member, text, ...) \
  VL_PARAMETER(FLOAT, vlPixelFilter, name, member, text, __VA_ARGS__)
#define PIXELS(...) VL_DEFAULT(__VA_ARGS__), .unit = "pixels", .flags = VL_PARAMETER_ABOVE_LOW
#define RADII(size)                                                               \
  PARAMETER("xradius", radius_x, "half of the filter's width", PIXELS(size),      \
            VL_RANGE(0, VL_MAX_FILTER_RADIUS)),                                   \
      PARAMETER("yradius", radius_y, "half of the filter's height", PIXELS(size), \
                VL_RANGE(0, VL_MAX_FILTER_RADIUS))

#endif
