/* render/race.h: --tracer auto: a short race chooses the tracer, or the number of light paths
 * (velo/choose.h). */
#ifndef APP_RENDER_RACE_H
#define APP_RENDER_RACE_H

#include "render/run.h"

/* Checks what --tracer auto cannot be combined with, before the scene is loaded. Returns -1, or
 * the exit code after reporting the error. */
int race_check(const Render *render, const Arguments *arguments);
/* Sets Job.race: whether there is a race before the render, as asked for or by default. */
void race_plan(Render *render, const Arguments *arguments);
/* Runs the race, reports its result, and sets the tracer and the number of light paths. Returns
 * -1, or the exit code after reporting the error. */
int race_run(Render *render, const Arguments *arguments);

#endif
