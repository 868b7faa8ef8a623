/* render/first_image.h: the image of a model that nothing but its file describes: few samples,
 * denoised (docs/denoising.md, docs/decisions/0028-a-denoised-first-image.md). */
#ifndef APP_RENDER_FIRST_IMAGE_H
#define APP_RENDER_FIRST_IMAGE_H

#include "render/run.h"

/* Samples per pixel; a constant, so that the bytes depend neither on time nor on the machine.
 */
enum { FIRST_IMAGE_SPP = 8 };

/* Sets samples and denoiser where the rule holds. */
void first_image_plan(Render *render, const Arguments *arguments);

#endif
