/* image/image.h: what the image commands share. */
#ifndef APP_IMAGE_IMAGE_H
#define APP_IMAGE_IMAGE_H

#include "velo/velo.h"

/* Context and image; -1, or the exit code when all has been said. */
int image_context(vlContext **context);
int image_load(vlContext *context, const char *path, vlImage **image);
/* Checks that what went to stdout arrived. */
int image_finish_output(int status);

#endif
