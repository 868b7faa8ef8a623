/* render/attributes.h: the header attributes of a rendered image: camera, colour, settings.
 * Nothing that differs between two equal runs is written: no times, no host name, no number of
 * threads. */
#ifndef APP_RENDER_ATTRIBUTES_H
#define APP_RENDER_ATTRIBUTES_H

#include "render/job.h"
#include "velo/image.h"

vlResult attributes_set(vlImage *image, const Job *job, uint32_t spp);
/* Adds the camera of the second view with the prefix "right.". */
vlResult attributes_set_view(vlImage *image, const Job *job, const char *view);
/* Adds the number, name and time of a trajectory's frame. name may be empty, time may be
 * VL_UNSET. */
vlResult attributes_set_frame(vlImage *image, uint32_t number, const char *name, double time);
/* Makes an image that has only attributes, those that a film keeps: of the image of the whole
 * render, or of an eye. *image is destroyed by the caller, also after an error. */
vlResult attributes_make(const Job *job, const char *eye, vlImage **image);
/* Copies the attributes of a further layer, or of null, to the first image of a file, whose
 * header describes all. */
vlResult attributes_add_layer(vlImage *image, const vlImage *layer);

#endif
