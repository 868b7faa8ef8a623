/* scene/scene.h: declarations shared by the scene commands. */
#ifndef APP_SCENE_SCENE_H
#define APP_SCENE_SCENE_H

#include "cli/options.h"
#include "velo/velo.h"

/* The option of all scene commands that restricts the location of a scene's files. */
#define SCENE_SANDBOX_OPTION(id)                                                                                      \
  {                                                                                                                   \
    (id), 0, "sandbox", OPTION_FOLDERS, "DIR",                                                                        \
        "the files that the scene names must lie in DIR or beneath it, links followed; several times for several", 0, \
        0, NULL                                                                                                       \
  }

/* The option of all scene commands that adds folders to look in. */
#define SCENE_SEARCH_OPTION(id)                                                                       \
  {                                                                                                   \
    (id), 0, "search-path", OPTION_SEARCH, "DIR",                                                     \
        "look in DIR, too, for the files that the scene names; several times for several", 0, 0, NULL \
  }

/* Creates a context with the options' --sandbox folder and a log callback. Returns -1, or the exit code after reporting
 * the error. */
int scene_context(vlContext **context, const Arguments *arguments, vlLogFn *log, void *log_user);

#endif
