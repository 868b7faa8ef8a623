/* render/blend.h: `velo render scene.blend`: Blender renders it, a child process without a
 * window, by velo's add-on (blender/velo_blender/headless.py), which gets the options of the
 * command that Blender can follow. The files are written to temporary ones and renamed here. */
#ifndef APP_RENDER_BLEND_H
#define APP_RENDER_BLEND_H

#include "cli/options.h"

/* Whether the command's scene is a file of Blender, by its suffix. */
bool blend_wanted(const Arguments *arguments);
/* Renders it. Returns the exit code. */
int blend_run(const Arguments *arguments);

#endif
