/** @file
 * velo/filter.h: pixel filters: their kinds, and the struct with their parameters. */
#ifndef VELO_FILTER_H
#define VELO_FILTER_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(NAME, name) for each kind of pixel filter. velo/schema.h describes the kinds and their
 * parameters. */
#define VL_PIXEL_FILTER_KINDS(X) \
  X(BOX, box)                    \
  X(TRIANGLE, triangle)          \
  X(GAUSSIAN, gaussian)          \
  X(MITCHELL, mitchell)          \
  X(LANCZOS, lanczos)            \
  X(BLACKMAN_HARRIS, blackman_harris)
/** The kinds of pixel filters: VL_PIXEL_FILTER_BOX and so on, from VL_PIXEL_FILTER_KINDS. */
typedef enum vlPixelFilterKind {
#define VL_KIND(NAME, name) VL_PIXEL_FILTER_##NAME,
  VL_PIXEL_FILTER_KINDS(VL_KIND)
#undef VL_KIND
} vlPixelFilterKind;
/** A pixel reconstruction filter (pbrt book 8.8). */
typedef struct vlPixelFilter {
  vlPixelFilterKind kind;   /**< which fields below are read */
  float radius_x, radius_y; /**< half of the filter's extent along x and y, pixels */
  float sigma;              /**< Gaussian: standard deviation, pixels */
  float b, c;               /**< Mitchell: its parameters */
  float tau;                /**< Lanczos: number of cycles of the sinc */
} vlPixelFilter;
/** The default filter of a kind, with pbrt-v4's default sizes. */
VL_API vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind);

#ifdef __cplusplus
}
#endif
#endif
