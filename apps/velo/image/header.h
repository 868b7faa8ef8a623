/* image/header.h: reads texts of an image's header, and the camera that render/attributes.c
 * wrote into it. */
#ifndef APP_IMAGE_HEADER_H
#define APP_IMAGE_HEADER_H

#include "velo/camera.h"
#include "velo/image.h"

/* When the rows of a rolling shutter's image were seen as ground truth. */
typedef enum HeaderRows { ROWS_NONE, ROWS_EACH, ROWS_ONE, ROWS_UNKNOWN } HeaderRows;

/* The text of an attribute. Null: there is none of this name, or it is no text. */
const char *header_text(const vlImage *image, const char *name);

/* Makes the camera. x0, y0: position of the image's first pixel in the uncropped image. optics:
 * the camera's lens of many elements, or null; the caller destroys it after the camera. Returns
 * -1, or the exit code after reporting the error. */
int header_camera(vlContext *context, const vlImage *image, const char *path, vlCamera *camera,
                  vlOptics **optics, uint32_t *x0, uint32_t *y0);

/* The camera of a rolling shutter whose rows see different things, made from the header's.
 * Returns how the header says that ground truth was seen: ROWS_EACH, ROWS_ONE, or ROWS_UNKNOWN;
 * ROWS_NONE: the rows have the same camera, which is at rest or reads all at once. */
HeaderRows header_rows(const vlImage *image, const vlCamera *camera, vlCamera *rolling);
/* The camera at the time of a pixel's row (or column). */
void header_row_camera(const vlCamera *rolling, uint32_t x, uint32_t y, vlCamera *camera);

/* Reads the camera of the uncropped image as a def, with lens radius, focus, shutter times and
 * exposure. Headers do not hold the aperture's shape, the tilt, the shutter's curve, the motion
 * or the clipping planes. */
int header_camera_def(const vlImage *image, const char *path, vlCameraDef *def);

#endif
