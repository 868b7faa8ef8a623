/* scene/scene.h: what the scene commands share. */
#ifndef APP_SCENE_SCENE_H
#define APP_SCENE_SCENE_H

#include "velo/velo.h"

/* A context whose log goes there. -1: made; else the exit code, and it has been said. */
int scene_context(vlContext **context, vlLogFn *log, void *log_user);

#endif
