/* scene/scene.h: what the scene commands share. */
#ifndef APP_SCENE_SCENE_H
#define APP_SCENE_SCENE_H

#include "cli/options.h"
#include "velo/velo.h"

/* The option of all scene commands that says where a scene's files may lie. */
#define SCENE_SANDBOX_OPTION(id)                                                                                      \
  {                                                                                                                   \
    (id), 0, "sandbox", OPTION_FOLDERS, "DIR",                                                                        \
        "the files that the scene names must lie in DIR or beneath it, links followed; several times for several", 0, \
        0, NULL                                                                                                       \
  }

/* A context with its --sandbox, whose log goes there. -1: made; else the exit code, and it has been said. */
int scene_context(vlContext **context, const Arguments *arguments, vlLogFn *log, void *log_user);

#endif
