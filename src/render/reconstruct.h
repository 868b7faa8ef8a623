/* render/reconstruct.h: the pixel filter over all samples that it covers. A sample's film point is uniform in its own
 * pixel, and the sample counts in every pixel whose filter covers the point (pbrt, 3rd edition, 7.8). So a pixel has
 * about 1 / integral(f^2) times as many samples as it takes itself: 2.25 times for the triangle of radius 1, 3 times
 * for pbrt's Gaussian. The samples of neighbouring pixels have their errors in common.
 *
 * A block of pixels also renders the samples of the pixels around it that its filters reach. So a block depends on no
 * other block, and crop windows, tiles and passes do not change the image. */
#ifndef RENDER_RECONSTRUCT_H
#define RENDER_RECONSTRUCT_H

#include "film/film.h"
#include "velo/render.h"

enum { VL_SHARED_SIDE = 64, VL_SHARED_BORDER = 2, VL_SHARED_SAMPLES = 2 };
/* Most samples of a block with its border, for one sample index. */
enum { VL_SHARED_GRID = (VL_SHARED_SIDE + 2 * VL_SHARED_BORDER) * (VL_SHARED_SIDE + 2 * VL_SHARED_BORDER) };

/* The pixel filter along x and y, at equal steps from 0 to its radius, scaled to an integral of 1. */
enum { VL_FILTER_STEPS = 1024 }; /* per pixel: linear interpolation is exact to 1e-6 */
typedef struct vlFilterCurve {
  double *values;
  double steps, per_step; /* number of steps, and steps per pixel */
} vlFilterCurve;
/* Error: MEMORY. */
vlResult vl_filter_curve_make(vlContext *context, const vlPixelFilter *filter, int axis, vlFilterCurve *curve);
static inline double vl_filter_curve_at(const vlFilterCurve *c, double x) {
  double at = (x < 0 ? -x : x) * c->per_step;
  if (!(at <= c->steps)) return 0;
  uint32_t k = (uint32_t)at;
  return c->values[k] + (at - k) * (c->values[k + 1] - c->values[k]);
}

/* Whether pixels share samples: the render def says so, the film has no spectra, and the filter has no negative lobes,
 * reaches beyond its pixel and not too far. */
bool vl_shares_samples(const vlFilmDef *film, const vlRenderDef *def);

typedef struct vlReconstruction {
  vlFilterCurve curve[2];
  uint32_t border[2]; /* pixels of the border along x and y */
} vlReconstruction;
vlResult vl_reconstruction_make(vlContext *context, const vlPixelFilter *filter, vlReconstruction *r);
void vl_reconstruction_free(vlContext *context, vlReconstruction *r);

/* The filter's values along an axis (0: x) in the pixels around, from the one border[axis] pixels before the sample's
 * own. at: the film point from its pixel's corner. */
static inline void vl_shared_row(const vlReconstruction *r, int axis, float at, float row[2 * VL_SHARED_BORDER + 1]) {
  for (uint32_t k = 0; k <= 2 * r->border[axis]; k++)
    row[k] = (float)vl_filter_curve_at(&r->curve[axis], (double)at - 0.5 - ((double)k - r->border[axis]));
}
/* The weight of a sample in the pixel that lies (dx, dy) pixels from the sample's own; (x, y): its film point, from its
 * pixel's corner. */
static inline float vl_shared_weight(const vlReconstruction *r, float x, float y, int32_t dx, int32_t dy) {
  return (float)vl_filter_curve_at(&r->curve[0], (double)x - 0.5 - dx) *
         (float)vl_filter_curve_at(&r->curve[1], (double)y - 0.5 - dy);
}

/* The samples of one index in a block and its border, row by row. x, y: the filter's values along an axis in the pixels
 * around, from the one that is border[0] (border[1]) pixels before the sample's own. */
typedef struct vlSharedGrid {
  float color[4][VL_SHARED_GRID]; /* red, green, blue, alpha */
  float x[2 * VL_SHARED_BORDER + 1][VL_SHARED_GRID], y[2 * VL_SHARED_BORDER + 1][VL_SHARED_GRID];
} vlSharedGrid;

/* A block: its pixels, from x0, y0 on, without the border. */
typedef struct vlSharedBlock {
  int32_t x0, y0;
  uint32_t width, height;
} vlSharedBlock;

/* Stores the sample of grid point `at`, whose film point is (x, y) from its pixel's corner. */
void vl_shared_store(const vlReconstruction *r, vlSharedGrid *g, uint32_t at, const float color[4], float x, float y);
/* The weighted means of the samples over the pixels of the block's rows [first, last), row by row, and their weights.
 */
void vl_shared_gather(const vlReconstruction *r, const vlSharedGrid *g, const vlSharedBlock *block, uint32_t first,
                      uint32_t last, float *const color[4], float *weight);

#endif
