/* attributes.h: what a picture's header says about how it was made: camera, colour, settings. Nothing that changes
 * between two runs: no times, no host, no threads. */
#ifndef APP_ATTRIBUTES_H
#define APP_ATTRIBUTES_H

#include "job.h"

vlResult attributes_set(vlImage *image, const Job *job, uint32_t spp);

#endif
