/** @file
 * velo/filter.h: pixel filters: the struct with their parameters. */
#ifndef VELO_FILTER_H
#define VELO_FILTER_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { VL_MAX_FILTER_RADIUS = 32 /**< of pixel filters, pixels */ };

/** A pixel reconstruction filter (pbrt book 8.8). */
typedef struct vlPixelFilter {
  uint32_t kind; /**< a vlPixelFilterKind (velo/filter_kinds.h): which fields below are read */
  float radius_x, radius_y; /**< half of the filter's extent along x and y, pixels */
  float sigma;              /**< Gaussian: standard deviation, pixels */
  float b, c;               /**< Mitchell: its parameters */
  float tau;                /**< Lanczos: number of cycles of the sinc */
} vlPixelFilter;

#ifdef __cplusplus
}
#endif
#endif
