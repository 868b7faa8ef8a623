/* image/display.h: converts linear light of any colour space to an 8-bit sRGB image. */
#ifndef APP_IMAGE_DISPLAY_H
#define APP_IMAGE_DISPLAY_H

#include "velo/velo.h"

/* As vl_image_view, but if the image's chromaticities attribute names a colour space other than Rec.709, converts from
 * that space first. The caller owns *result. */
vlResult display_image(vlContext *context, const vlImage *image, vlView view, float exposure, vlImage **result);

#endif
