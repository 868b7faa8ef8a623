/* render/animate.h: --animate and --turntable: frames of an animated model, or of a camera that goes around it. Each
 * frame is a render of its own, with the receipt of the command that makes it alone. */
#ifndef APP_RENDER_ANIMATE_H
#define APP_RENDER_ANIMATE_H

#include "cli/options.h"
#include "velo/velo.h"

/* Renders one image. exposure: that of all frames, in stops; NaN until the first frame has been metered. */
typedef int AnimateRender(const Command *command, const Arguments *arguments, float *exposure);

bool animate_wanted(const Arguments *arguments);
/* Renders the frames one after the other. Returns the exit code; the first failure ends it. */
int animate_run(const Command *command, const Arguments *arguments, AnimateRender *render);

/* --turn: turns the scene's camera about the axis `up` through the middle of the scene. automatic: the camera was made
 * for the scene; then it keeps a distance at which every angle shows all of the scene. */
void turn_camera(vlScene *scene, bool automatic, const double up[3], double degrees);

#endif
