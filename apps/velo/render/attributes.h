/* render/attributes.h: the header attributes of a rendered image: camera, colour, settings. Nothing that differs
 * between two equal runs is written: no times, no host name, no number of threads. */
#ifndef APP_RENDER_ATTRIBUTES_H
#define APP_RENDER_ATTRIBUTES_H

#include "render/job.h"

vlResult attributes_set(vlImage *image, const Job *job, uint32_t spp);
/* Adds the camera of the second view with the prefix "right.". */
vlResult attributes_set_view(vlImage *image, const Job *job, const char *view);
/* Adds the number, name and time of a trajectory's frame. name may be empty, time may be VL_UNSET. */
vlResult attributes_set_frame(vlImage *image, uint32_t number, const char *name, double time);
/* Adds OpenEXR's attribute "view" to the image of one eye. */
vlResult attributes_set_eye(vlImage *image, const char *view);

#endif
