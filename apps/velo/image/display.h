/* image/display.h: light of any colour space to the 8-bit sRGB image that people look at. */
#ifndef APP_IMAGE_DISPLAY_H
#define APP_IMAGE_DISPLAY_H

#include "velo/velo.h"

/* As vl_image_view, for images whose chromaticities attribute names another space than Rec.709 too. */
vlResult display_image(vlContext *context, const vlImage *image, vlView view, float exposure, vlImage **result);

#endif
