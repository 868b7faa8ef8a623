/* render/noise.h: --noise: adaptive sampling. */
#ifndef APP_RENDER_NOISE_H
#define APP_RENDER_NOISE_H

#include "render/job.h"
#include "render/outputs.h"

/* Checks --noise and what it cannot be combined with. Returns -1, or the exit code after reporting the error. */
int noise_check(const Arguments *arguments);
/* Sets the threshold and the display transform of the outputs in defs. Without --spp the largest number of samples is
 * that of the sampler's sequence. Returns -1, or the exit code after reporting the error. */
int noise_apply(const Arguments *arguments, const Outputs *outputs, vlSceneDefs *defs);
/* Reports how many samples the blocks have, and how many blocks are above the threshold. */
void noise_report(const vlRenderDef *def, const vlRenderStats *stats);

#endif
