/* distortion/compile.h: for the files of the distortions: a kind's coefficients become those of
 * the common form (distortion/distortion.h). */
#ifndef DISTORTION_COMPILE_H
#define DISTORTION_COMPILE_H

#include "base/error.h"
#include "velo/distortion.h"

/* Sets the members that are not those of no distortion. k: n coefficients, finite, as many as
 * the row allows. */
typedef vlResult vlDistortionCompile(const double *k, uint32_t n, vlDistortionMap *m,
                                     vlError *error);

#endif
