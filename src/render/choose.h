/* render/choose.h: declarations shared by choose.c and its tests. */
#ifndef RENDER_CHOOSE_H
#define RENDER_CHOOSE_H

#include "velo/choose.h"

/* Sets the work of all trials from their error, missing light and cost, and choice->tracer and
 * light_paths to the best trial. samples: how many times the samples of the race the image
 * has. */
void vl_choose_by_work(vlTracerChoice *choice, double samples);

#endif
