/* render/reconstruct.h: the pixel filter over all samples that it covers. A sample's film point
 * is uniform in its own pixel, and the sample counts in every pixel whose filter covers the
 * point (pbrt, 3rd edition, 7.8). So a pixel has about 1 / integral(f^2) times as many samples
 * as it takes itself: 2.25 times for the triangle of radius 1, 3 times for pbrt's Gaussian. The
 * samples of neighbouring pixels have their errors in common.
 *
 * A block of pixels also renders the samples of the pixels around it that its filters reach. So
 * a block depends on no other block, and crop windows, tiles and passes do not change the
 * image. */
#ifndef RENDER_RECONSTRUCT_H
#define RENDER_RECONSTRUCT_H

#include "filter/filter.h"
#include "velo/render.h"

enum { VL_SHARED_SIDE = 128, VL_SHARED_BORDER = 2, VL_SHARED_SAMPLES = 2 };
/* Most samples of a block with its border, for one sample index. */
enum {
  VL_SHARED_GRID =
      (VL_SHARED_SIDE + 2 * VL_SHARED_BORDER) * (VL_SHARED_SIDE + 2 * VL_SHARED_BORDER)
};

/* Whether pixels share samples: the render def says so, the film has no spectra, and the filter
 * has no negative lobes, reaches beyond its pixel and not too far. */
bool vl_shares_samples(const vlFilmDef *film, const vlRenderDef *def);

/* The filter as pixels that share samples need it; valid as long as the film. */
typedef struct vlReconstruction {
  vlFilterCurve curve[2];
  uint32_t border[2]; /* pixels of the border along x and y */
  bool skips;         /* the filter does not reach all points of the border */
} vlReconstruction;
vlReconstruction vl_reconstruction_of(const vlFilterTable *filter);
/* The sum of the squared correlations of a pixel's error with those of all pixels, itself
 * included, where the samples are independent and alike. */
double vl_reconstruction_correlation(const vlReconstruction *r);

/* The weight of a sample in the pixel that lies (dx, dy) pixels from the sample's own; (x, y):
 * its film point, from its pixel's corner. */
static inline float vl_shared_weight(const vlReconstruction *r, float x, float y, int32_t dx,
                                     int32_t dy) {
  return vl_filter_curve_at(&r->curve[0], x - (0.5f + (float)dx)) *
         vl_filter_curve_at(&r->curve[1], y - (0.5f + (float)dy));
}

/* The samples of one index in a block and its border, row by row. x, y: the filter's values
 * along an axis in the pixels around, from the one that is border[0] (border[1]) pixels before
 * the sample's own. */
typedef struct vlSharedGrid {
  float color[4][VL_SHARED_GRID]; /* red, green, blue, alpha */
  float x[2 * VL_SHARED_BORDER + 1][VL_SHARED_GRID],
      y[2 * VL_SHARED_BORDER + 1][VL_SHARED_GRID];
  bool skipped[VL_SHARED_GRID]; /* the sample counts in none of the block's pixels and need not
                                   be traced */
} vlSharedGrid;

/* A block: its pixels, from x0, y0 on, without the border. */
typedef struct vlSharedBlock {
  int32_t x0, y0;
  uint32_t width, height;
} vlSharedBlock;

/* The filter's values along an axis (0: x) in the pixels around n samples, from the pixel
 * border[axis] before the sample's own: rows of VL_PAD(n) values, `stride` apart. at: the film
 * points from their pixels' corners. */
void vl_shared_taps(const vlReconstruction *r, const vlFilterKernels *kernels, int axis,
                    uint32_t n, const float *at, float *rows, size_t stride);
enum { VL_SHARED_LANES = 128 };
typedef struct vlSharedTaps {
  float along[2][2 * VL_SHARED_BORDER + 1][VL_SHARED_LANES];
} vlSharedTaps;
/* Whether a pixel of the block counts a sample of the pixel (x, y) of the grid. film_x, film_y:
 * its film point, from its pixel's corner. */
bool vl_shared_counts(const vlReconstruction *r, const vlSharedBlock *block, uint32_t x,
                      uint32_t y, float film_x, float film_y);
/* Leaves out the sample at grid point `at`: its weights are 0. */
void vl_shared_skip(const vlReconstruction *r, vlSharedGrid *g, uint32_t at);
/* Stores a sample at grid point `at`; its filter values are those of lane `lane`. A sample that
 * does not count (it is not finite) has weight 0. */
void vl_shared_store(const vlReconstruction *r, vlSharedGrid *g, uint32_t at,
                     const float color[4], const vlSharedTaps *taps, uint32_t lane,
                     bool counts);
/* The weighted means of the samples over the pixels of the block's rows [first, last), row by
 * row, and their weights. */
void vl_shared_gather(const vlReconstruction *r, const vlSharedGrid *g,
                      const vlSharedBlock *block, uint32_t first, uint32_t last,
                      float *const color[4], float *weight);

#endif
