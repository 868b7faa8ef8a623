/** @file
 * velo/filter_kinds.h: pixel filters: their kinds. */
#ifndef VELO_FILTER_KINDS_H
#define VELO_FILTER_KINDS_H

#include "velo/filter.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each kind of pixel filter. velo/schema.h describes the kinds and their
 * parameters. */
#define VL_PIXEL_FILTER_KINDS(X)        \
  X(VL_PIXEL_FILTER_BOX, box)           \
  X(VL_PIXEL_FILTER_TRIANGLE, triangle) \
  X(VL_PIXEL_FILTER_GAUSSIAN, gaussian) \
  X(VL_PIXEL_FILTER_MITCHELL, mitchell) \
  X(VL_PIXEL_FILTER_LANCZOS, lanczos)   \
  X(VL_PIXEL_FILTER_BLACKMAN_HARRIS, blackman_harris)
/** The kinds of pixel filters: VL_PIXEL_FILTER_BOX and so on, from VL_PIXEL_FILTER_KINDS. */
typedef enum vlPixelFilterKind {
#define VL_KIND(kind, name) kind,
  VL_PIXEL_FILTER_KINDS(VL_KIND)
#undef VL_KIND
} vlPixelFilterKind;
/** The default filter of a kind, with pbrt-v4's default sizes. */
VL_API vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind);

#ifdef __cplusplus
}
#endif
#endif
