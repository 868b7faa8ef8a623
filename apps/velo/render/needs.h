/* render/needs.h: options that have an effect only with something else: a glTF file, a film, a certain tracer. */
#ifndef APP_RENDER_NEEDS_H
#define APP_RENDER_NEEDS_H

#include "render/run.h"

/* Both report each given option that has no effect in this render: as a note, with --strict-options as an error. The
 * first is called when scene, camera and outputs are known, the second when the tracer is. They return -1, or the exit
 * code after an error. Frames of an animation are reported once. */
int needs_check_job(Render *render, const Arguments *arguments);
int needs_check_tracer(Render *render, const Arguments *arguments);

#endif
