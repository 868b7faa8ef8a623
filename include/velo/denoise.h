/** @file
 * velo/denoise.h: a denoised copy of a rendered image. The rendered image is never changed.
 * docs/denoising.md describes the method. */
#ifndef VELO_DENOISE_H
#define VELO_DENOISE_H

#include "velo/base.h"
#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The denoisers. VELO: velo's own, which uses no trained model. OIDN: Intel Open Image
 * Denoise, a neural network, loaded at run time from the user's libOpenImageDenoise.so.2 (or
 * .so.1, .so.0). */
typedef enum vlDenoiser { VL_DENOISER_VELO, VL_DENOISER_OIDN } vlDenoiser;

/** How to denoise. */
typedef struct vlDenoiseDef {
  uint32_t cookie;
  vlDenoiser denoiser; /**< default VL_DENOISER_VELO */
  /** File of the Open Image Denoise library; null (default): the names above (also without
   * number), in the loader's search path. Read during the call only. */
  const char *library;
  /** VL_DENOISER_VELO: stops the call within one tile of 64 x 16 pixels per worker. Default
   * null.
   */
  const vlCancel *cancel;
  /** VL_DENOISER_VELO: the result also has the channels error.R .G .B: the estimated standard
   * error of its remaining noise, without its bias. Default false. */
  bool errors;
} vlDenoiseDef;
/** The default def. */
VL_API vlDenoiseDef vl_default_denoise_def(void);

/** What was done. */
typedef struct vlDenoiseStats {
  uint64_t not_finite; /**< pixels with a colour or standard error that is not finite; they are
                          filled from their neighbours; 0 for VL_DENOISER_OIDN */
  bool features;       /**< the image has all channels of features, and they were used */
  double seconds;      /**< duration of the call */
} vlDenoiseStats;

/** Makes a denoised copy of `image` in *clean, owned by the caller: a float image R G B (A is
 * copied if there is one; see also def.errors), with much less noise and some bias. `image`
 * must have the linear channels R G B. VL_DENOISER_VELO also needs their standard errors:
 * feature.error.R .G .B, which VL_CHANNEL_ERROR | VL_CHANNEL_FEATURES gives, or error.R .G .B.
 * Both denoisers use the features feature.albedo, feature.N and feature.disparity
 * (VL_CHANNEL_FEATURES) if all their channels are there. Attributes are copied.
 *
 * VL_DENOISER_VELO runs on the workers of the image's context. Its bits depend neither on the
 * number of threads nor on the instruction set. It fits the radiance around a pixel by a
 * weighted linear function of the features and of the position; the function's value at the
 * pixel is the result (Bitterli et al. 2016, "Nonlinearly weighted first-order regression for
 * denoising Monte Carlo renderings"). The weights compare patches of pixels, relative to their
 * standard errors (Rousselle et al. 2012, "Adaptive rendering with non-local means filtering").
 *
 * def, stats and error may be null. Errors: ARGUMENT, SCENE (channels are missing, or the image
 * has fewer than two samples per pixel), MISSING (no Open Image Denoise library), UNSUPPORTED
 * (the library lacks a function or reports an error), CANCELLED, MEMORY. *clean is null after
 * an error. */
VL_API vlResult vl_denoise(const vlImage *image, const vlDenoiseDef *def, vlImage **clean,
                           vlDenoiseStats *stats, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
