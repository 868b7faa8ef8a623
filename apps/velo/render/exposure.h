/* render/exposure.h: how bright 8-bit images are made: by --exposure, or metered. */
#ifndef APP_RENDER_EXPOSURE_H
#define APP_RENDER_EXPOSURE_H

#include "cli/options.h"
#include "velo/velo.h"

/* --exposure EV or auto; -1: go on, else the exit code. */
int exposure_parse(const OptionValue *value, float *ev, bool *meter);
/* The EV, in tenths, that makes the geometric mean of a linear image's luminances 0.18. What is black or nearly so
 * (below a thousandth of the mean) does not count, nor what lies behind everything (alpha 0). */
float exposure_meter(const vlImage *image);
void exposure_tell(float ev);

#endif
