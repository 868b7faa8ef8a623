/* image/header.h: the camera that attributes.c wrote into an image's header, read back. */
#ifndef APP_IMAGE_HEADER_H
#define APP_IMAGE_HEADER_H

#include "velo/velo.h"

/* -1, or the exit code when all has been said. x0, y0: the image's first pixel in the whole image (crops). optics:
 * the camera's lens of many elements, to be destroyed after it; null where it has none. */
int header_camera(vlContext *context, const vlImage *image, const char *path, vlCamera *camera, vlOptics **optics,
                  uint32_t *x0, uint32_t *y0);

/* The whole image's camera as a def, with lens radius, focus, shutter times and exposure; the opening's shape, tilt,
 * the shutter's curve, motion and the clipping planes are not in headers. */
int header_camera_def(const vlImage *image, const char *path, vlCameraDef *def);

#endif
