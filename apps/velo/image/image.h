/* image/image.h: declarations shared by the image commands. */
#ifndef APP_IMAGE_IMAGE_H
#define APP_IMAGE_IMAGE_H

#include "velo/film.h"
#include "velo/image.h"
#include "velo/render.h"

/* Reads an image. Returns -1, or the exit code after reporting the error. */
int image_load(vlContext *context, const char *path, vlImage **image);
/* Makes an image of floats. names: of its channels; null: the usual ones. */
vlResult image_make(vlContext *context, uint32_t width, uint32_t height, uint32_t channels,
                    const char *const *names, vlImage **image);
/* The same, as large as another image. */
vlResult image_make_like(vlContext *context, const vlImage *like, uint32_t channels,
                         const char *const *names, vlImage **image);
/* Renders a film and develops it. */
vlResult image_render(vlContext *context, const vlWorld *world, const vlCamera *camera,
                      const vlFilmDef *film, const vlRenderDef *render,
                      const vlDevelopDef *develop, vlImage **image, vlError *error);
/* Sets an attribute that is a text. */
vlResult image_set_text(vlImage *image, const char *name, const char *text);
/* width * height. */
size_t image_pixel_count(const vlImage *image);
/* Finds the channels "R", "G", "B" behind a prefix such as "albedo."; -1: it is not there.
 * Returns whether all are. */
bool image_find_rgb(const vlImage *image, const char *prefix, int rgb[3]);

#endif
