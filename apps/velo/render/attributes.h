/* render/attributes.h: what an image's header says about how it was made: camera, colour, settings. Nothing that
 * changes between two runs: no times, no host, no threads. */
#ifndef APP_RENDER_ATTRIBUTES_H
#define APP_RENDER_ATTRIBUTES_H

#include "render/job.h"

vlResult attributes_set(vlImage *image, const Job *job, uint32_t spp);
/* The camera of a second view beside the first one's: the same names behind "right." */
vlResult attributes_set_view(vlImage *image, const Job *job, const char *view);
/* Which frame of a trajectory; name may be empty, time unset. */
vlResult attributes_set_frame(vlImage *image, uint32_t number, const char *name, double time);
/* Of an image that is one eye's: OpenEXR's attribute "view". */
vlResult attributes_set_eye(vlImage *image, const char *view);

#endif
