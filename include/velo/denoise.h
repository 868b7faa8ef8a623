/** @file
 * velo/denoise.h: a denoised copy of a rendered image. The rendered image is never changed. docs/denoising.md describes
 * the method. */
#ifndef VELO_DENOISE_H
#define VELO_DENOISE_H

#include "velo/base.h"
#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Which denoiser. VELO: velo's own, without training. OIDN: Intel Open Image Denoise, a neural network, loaded at run
 * time from the user's libOpenImageDenoise.so.2 (or .so.1, .so.0). */
typedef enum vlDenoiser { VL_DENOISER_VELO, VL_DENOISER_OIDN } vlDenoiser;

/** How to denoise. */
typedef struct vlDenoiseDef {
  uint32_t cookie;
  vlDenoiser denoiser; /**< default VL_DENOISER_VELO */
  /** File of the Open Image Denoise library; null (default): the system's, by its usual names. */
  const char *library;
} vlDenoiseDef;
/** The default def. */
VL_API vlDenoiseDef vl_default_denoise_def(void);

/** What was done. */
typedef struct vlDenoiseStats {
  uint64_t not_finite; /**< pixels with a value that is not finite; they are filled from their neighbours */
  bool features;       /**< the image has channels of features */
  double seconds;      /**< duration of the call */
} vlDenoiseStats;

/** Makes a float image R G B (and A, copied, where the image has it), owned by the caller: the image without most of
 * its noise, biased. Needs of `image` the linear channels R G B, for VL_DENOISER_VELO also error.R .G .B (their
 * standard errors, VL_CHANNEL_ERROR); uses feature.albedo, feature.N and feature.disparity (VL_CHANNEL_FEATURES) where
 * they are. Attributes are copied.
 *
 * VL_DENOISER_VELO has the same bits for any number of threads and on any instruction set; it runs on the context's
 * workers. A pixel is the constant of a weighted linear fit of its neighbourhood's radiance over albedo to the features
 * (Bitterli et al. 2016, "Nonlinearly weighted first-order regression for denoising Monte Carlo renderings"), weighted
 * by the distance of patches relative to their standard errors (Rousselle et al. 2012, "Adaptive rendering with
 * non-local means filtering").
 *
 * def, stats and error may be null. Errors: ARGUMENT, SCENE (channels are missing, or the image has fewer than two
 * samples per pixel), MISSING (no Open Image Denoise library), UNSUPPORTED (a library without the functions that are
 * needed, or an error that it reports), MEMORY. */
VL_API vlResult vl_denoise(const vlImage *image, const vlDenoiseDef *def, vlImage **clean, vlDenoiseStats *stats,
                           vlError *error);

#ifdef __cplusplus
}
#endif
#endif
