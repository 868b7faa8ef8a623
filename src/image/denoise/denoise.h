/* image/denoise/denoise.h: the denoiser's planes and kernels; private to the denoiser.
 * docs/denoising.md describes the method. */
#ifndef IMAGE_DENOISE_DENOISE_H
#define IMAGE_DENOISE_DENOISE_H

#include "base/isa.h"
#include "image/image.h"
#include "velo/denoise.h"

/* A tile of pixels is the unit of work. The neighbours of a pixel lie in a window of (2
 * VL_DENOISE_RADIUS + 1)^2 pixels. Two pixels are compared by patches of (2 VL_DENOISE_PATCH +
 * 1)^2 pixels around them. */
enum {
  VL_DENOISE_TILE_X = 64,
  VL_DENOISE_TILE_Y = 16,
  VL_DENOISE_TILE = VL_DENOISE_TILE_X * VL_DENOISE_TILE_Y,
  VL_DENOISE_RADIUS = 6,
  VL_DENOISE_PATCH = 2,
  VL_DENOISE_ROWS = VL_DENOISE_TILE_Y + VL_DENOISE_RADIUS,
  VL_DENOISE_BORDER = 32, /* width of the planes' border in pixels; at least radius + patch */
  VL_DENOISE_NEIGHBOURS = 81, /* pixels of a window that are used */
  VL_DENOISE_STEP = 4, /* distance of the points of the lattice for wide windows in pixels */
  VL_DENOISE_FEATURES = 7, /* albedo, normal, logarithm of the disparity */
  /* of a fit: slopes of the features, slopes of x and y, and the constant */
  VL_DENOISE_UNKNOWNS = VL_DENOISE_FEATURES + 2 + 1
};
_Static_assert((int)VL_DENOISE_BORDER >= (int)VL_DENOISE_RADIUS + (int)VL_DENOISE_PATCH,
               "windows end in the border");

/* Variance of a mean of pixels, over that of pixels with independent noise: pixels share
 * samples (docs/filters.md). */
#define VL_DENOISE_CORRELATION 3.0f

/* Planes with a border on all sides. The pointers are to pixel (0, 0); rows are `stride` floats
 * apart. */
typedef struct vlDenoisePlanes {
  uint32_t width, height;
  ptrdiff_t stride;
  float bandwidth2;              /* square of k in docs/denoising.md */
  float *color[3], *variance[3]; /* the colour, and the variance of its noise */
  float *feature[VL_DENOISE_FEATURES];
  float *valid; /* 1 for valid pixels; 0 outside of the image and where a value is not finite */
  float *result[3];
  float *noise[3]; /* the variance of the result's noise, if the pixels' noise is independent */
  float *slope[3][VL_DENOISE_FEATURES + 2]; /* slopes of the fits; null: not wanted */
} vlDenoisePlanes;

/* Working memory of one worker. */
typedef struct vlDenoiseScratch {
  float weight[VL_DENOISE_NEIGHBOURS][VL_DENOISE_TILE];
  int8_t dx[VL_DENOISE_NEIGHBOURS], dy[VL_DENOISE_NEIGHBOURS]; /* their offsets */
  int neighbours;                                              /* their number */
  /* Of a pair of opposite offsets: distances of pixels, their sums along x, and weights of
   * neighbours that are valid. */
  float distance[VL_DENOISE_ROWS + 2 * VL_DENOISE_PATCH][VL_DENOISE_TILE_X + 2 * 16];
  float sums[VL_DENOISE_ROWS + 2 * VL_DENOISE_PATCH][VL_DENOISE_TILE_X + 16];
  float near[VL_DENOISE_ROWS][VL_DENOISE_TILE_X + 16];
} vlDenoiseScratch;

typedef struct vlDenoiseKernels {
  /* Fits the pixels of the tile whose first pixel is (x, y). */
  void (*tile)(const vlDenoisePlanes *planes, vlDenoiseScratch *scratch, uint32_t x,
               uint32_t y);
  /* Corrects pixels by the fits of the lattice: rows from the lattice's row j to the next,
   * VL_DENOISE_STEP * VL_LANES pixels from column i on. */
  void (*correct)(const vlDenoisePlanes *planes, const vlDenoisePlanes *lattice, int32_t i,
                  int32_t j);
  /* Finds the outliers of a row: writes the factors that scale them to result[0], 1 for other
   * pixels. Reads the means of R, G and B of valid pixels in result[1] (0 for others, and
   * outside of the image), of rows up to a distance of 3. */
  void (*cap)(const vlDenoisePlanes *planes, uint32_t y);
  /* Writes the variances of a row, raised, to the planes `result`. Reads those of rows up to a
   * distance of 3, and of the border. */
  void (*raise)(const vlDenoisePlanes *planes, uint32_t y);
} vlDenoiseKernels;
VL_KERNEL_TABLE(vlDenoiseKernels, vl_denoise)

/* The kernels `correct`, `cap` and `raise`, for hot files. */
void vl_denoise_correct(const vlDenoisePlanes *planes, const vlDenoisePlanes *lattice,
                        int32_t i, int32_t j);
void vl_denoise_cap(const vlDenoisePlanes *planes, uint32_t y);
void vl_denoise_raise(const vlDenoisePlanes *planes, uint32_t y);

/* The image's channels that the denoisers read; -1: there is none. */
typedef struct vlDenoiseChannels {
  int color[3], error[3], alpha, feature[VL_DENOISE_FEATURES];
  bool features; /* the image has all feature channels */
} vlDenoiseChannels;

/* Denoises the image's colours by Intel Open Image Denoise (oidn.c). The result goes to
 * `clean`, a float image of `channels` channels. Errors: MISSING, UNSUPPORTED, MEMORY. */
vlResult vl_denoise_oidn(const vlImage *image, const vlDenoiseChannels *channels,
                         const char *library, vlImage *clean, vlError *error);

#endif
