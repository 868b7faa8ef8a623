/* render/first_image.h: the image of a model that nothing but its file describes: few samples,
 * denoised (docs/denoising.md, docs/decisions/0028-a-denoised-first-image.md). */
#ifndef APP_RENDER_FIRST_IMAGE_H
#define APP_RENDER_FIRST_IMAGE_H

#include "render/run.h"

/* Samples per pixel; a constant, so that the bytes depend neither on time nor on the machine.
 */
enum { FIRST_IMAGE_SPP = 8 };

/* Whether the rule holds: the file is a model, velo adds its camera or its light, every output
 * is a .png, .jpg or .tga, and every option is one that asks for no other quality than the
 * default. Call when the outputs are chosen. */
bool first_image_wanted(const Render *render, const Arguments *arguments);
/* Sets samples and denoiser where the rule holds. */
void first_image_plan(Render *render, const Arguments *arguments);

#endif
