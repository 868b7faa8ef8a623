/* image/header.h: reads the camera that render/attributes.c wrote into an image's header. */
#ifndef APP_IMAGE_HEADER_H
#define APP_IMAGE_HEADER_H

#include "velo/camera.h"
#include "velo/image.h"

/* Makes the camera. x0, y0: position of the image's first pixel in the uncropped image. optics:
 * the camera's lens of many elements, or null; the caller destroys it after the camera. Returns
 * -1, or the exit code after reporting the error. */
int header_camera(vlContext *context, const vlImage *image, const char *path, vlCamera *camera,
                  vlOptics **optics, uint32_t *x0, uint32_t *y0);

/* Reads the camera of the uncropped image as a def, with lens radius, focus, shutter times and
 * exposure. Headers do not hold the aperture's shape, the tilt, the shutter's curve, the motion
 * or the clipping planes. */
int header_camera_def(const vlImage *image, const char *path, vlCameraDef *def);

#endif
