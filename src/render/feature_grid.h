/* render/feature_grid.h: the features of one sample of each pixel of a region and its border,
 * and the kernels that add them to the region's pixels and find where they vary. */
#ifndef RENDER_FEATURE_GRID_H
#define RENDER_FEATURE_GRID_H

#include <string.h>

#include "base/isa.h"
#include "render/reconstruct.h"

/* Albedo, normal, disparity; most pixels of a side of a region. */
enum { VL_FEATURES = 7, VL_FEATURE_SIDE = 64 };
enum { VL_FEATURE_PIXELS = VL_FEATURE_SIDE * VL_FEATURE_SIDE };
enum {
  VL_FEATURE_GRID =
      (VL_FEATURE_SIDE + 2 * VL_SHARED_BORDER) * (VL_FEATURE_SIDE + 2 * VL_SHARED_BORDER)
};
_Static_assert((int)VL_FEATURE_GRID == (int)VL_PAD(VL_FEATURE_GRID),
               "rows of weights are padded");
_Static_assert((int)VL_FEATURE_SIDE % (int)VL_LANES == 0,
               "a row is divided into whole vectors");

/* A pixel of the region or its border, from the border's corner. */
typedef struct vlFeaturePoint {
  uint8_t x, y;
} vlFeaturePoint;

/* The features of one sample of each pixel, row by row (vlFeatureRegion.stride), and the
 * samples' weights along x and y in the pixels around (reconstruct.h). Vectors of VL_LANES
 * values begin at pixels of the tile: they end in the arrays, but may read what was never set,
 * for pixels that do not count. */
typedef struct vlFeatureGrid {
  vlFeaturePoint points[VL_FEATURE_GRID]; /* those whose samples are traced, row by row */
  float value[VL_FEATURES][VL_FEATURE_GRID];
  float x[2 * VL_SHARED_BORDER + 1][VL_FEATURE_GRID],
      y[2 * VL_SHARED_BORDER + 1][VL_FEATURE_GRID];
  float first[VL_FEATURES][VL_FEATURE_GRID]; /* values of the first sample */
  float varies[VL_FEATURE_GRID];   /* 1: a later sample differs from the first one; 0 */
  float counts[VL_FEATURE_PIXELS]; /* 1: the pixel counts the sample; 0 */
  float sums[VL_FEATURES + 1][VL_FEATURE_PIXELS]; /* of all samples; the last: of weights */
} vlFeatureGrid;

/* Pixels inside the crop window, from x0, y0 on, and the border of pixels around them whose
 * samples count, too (none if pixels have samples of their own). */
typedef struct vlFeatureRegion {
  uint32_t x0, y0, width, height, border[2];
  uint32_t stride, count; /* pixels of a row and of all rows, with the border */
} vlFeatureRegion;

typedef struct vlFeatureKernels {
  /* Adds the grid's features to its sums of the region's pixels that count the sample, each
   * times its weight, and the weights to sums[VL_FEATURES]. Rows of sums are VL_FEATURE_SIDE
   * apart; the pixels of a row behind the region's width, up to whole vectors, have no meaning.
   */
  void (*add)(vlFeatureGrid *grid, const vlFeatureRegion *region);
  /* Sets `varies` where one of the first n values differs from the first sample's. */
  void (*compare)(vlFeatureGrid *grid, uint32_t n);
} vlFeatureKernels;
VL_KERNEL_TABLE(vlFeatureKernels, vl_feature)

#endif
