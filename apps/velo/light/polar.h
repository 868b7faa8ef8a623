/* light/polar.h: the polar diagram of a luminaire as an SVG image. */
#ifndef APP_LIGHT_POLAR_H
#define APP_LIGHT_POLAR_H

#include "velo/lamp.h"

/* Intensity in candela in the plane of C (radians, and of C + 180 degrees), at an angle from
 * the nadir (radians, negative: in the half plane of C + 180 degrees). */
double polar_intensity(const vlLamp *lamp, double c, double angle);
/* Writes the image to a file. Returns the exit code; errors are reported. */
int polar_write(vlContext *context, const char *path, const vlLamp *lamp,
                const vlLampInfo *info, const char *title);

#endif
