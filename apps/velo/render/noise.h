/* render/noise.h: --noise: adaptive sampling. */
#ifndef APP_RENDER_NOISE_H
#define APP_RENDER_NOISE_H

#include "render/job.h"
#include "render/outputs.h"

/* Parses 1%, 0.5% or 0.01. The result is a fraction of white; 0: the text is wrong. */
double noise_threshold(const char *text);
/* Checks --noise and what it cannot be combined with. Returns -1, or the exit code after
 * reporting the error. */
int noise_check(const Arguments *arguments);
/* Sets the threshold and the display transform of the outputs in defs. Without --spp the
 * largest number of samples is that of the sampler's sequence. */
void noise_apply(const Arguments *arguments, const Outputs *outputs, vlSceneDefs *defs);
/* Sets the exposure of the outputs, after it was metered, in two defs. many: several images are
 * rendered, whose defs are copies. Returns -1, or the exit code after reporting that the
 * exposure is not known. */
int noise_expose(const Outputs *outputs, bool many, vlRenderDef *render, vlRenderDef *whole);
/* Reports how many samples the blocks have, and how many blocks are above the threshold. */
void noise_report(const vlRenderDef *def, const vlRenderStats *stats);

#endif
