/* image/denoise.h: what `velo image denoise` and `velo render --denoise` share. */
#ifndef APP_IMAGE_DENOISE_H
#define APP_IMAGE_DENOISE_H

#include "cli/options.h"
#include "velo/denoise.h"

extern const Choice denoiser_choices[];
/* Reports the statistics of denoising. */
void denoise_report(const vlDenoiseStats *stats);
/* Writes the denoiser's name to the image's header attribute velo.denoiser. */
vlResult denoise_name(vlImage *clean, vlDenoiser denoiser);

#endif
