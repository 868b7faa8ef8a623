/* image/denoise.h: what `velo image denoise` and `velo render --denoise` share. */
#ifndef APP_IMAGE_DENOISE_H
#define APP_IMAGE_DENOISE_H

#include "cli/options.h"
#include "velo/velo.h"

extern const Choice denoiser_choices[];
/* Reports what denoising met. */
void denoise_report(const vlDenoiseStats *stats);
/* Names the denoiser in the image's header: velo.denoiser. */
vlResult denoise_name(vlImage *clean, vlDenoiser denoiser);

#endif
