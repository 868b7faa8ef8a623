/* render/scene_options.h: what `velo render` says about the scene itself: which camera, moment and variant of a glTF
 * file, and what is added where the file has no camera or light. */
#ifndef APP_RENDER_SCENE_OPTIONS_H
#define APP_RENDER_SCENE_OPTIONS_H

#include "cli/options.h"
#include "velo/velo.h"

/* Loads the scene and completes it; *lamps: it is glTF and has lights of its own. -1, or the exit code when all has
 * been said. */
int scene_open(vlContext *context, const char *path, const Arguments *arguments, vlScene **scene, bool *lamps);
/* --camera names one of the scene's own cameras: the file is glTF, and no file has that name. */
bool scene_camera_is_own(const char *path, const Arguments *arguments);

#endif
