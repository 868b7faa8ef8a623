/* image/display.h: converts linear light of any colour space to an 8-bit sRGB image. */
#ifndef APP_IMAGE_DISPLAY_H
#define APP_IMAGE_DISPLAY_H

#include "velo/image.h"

/* Like vl_image_view, but first converts the image to Rec.709 if its chromaticities attribute
 * names another colour space. alpha: the image is R G B A, premultiplied, and the result has
 * its alpha; otherwise alpha is ignored. The caller owns *result. */
vlResult display_image(vlContext *context, const vlImage *image, vlView view, float exposure,
                       bool alpha, vlImage **result);

#endif
