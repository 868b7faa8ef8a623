/* scene/scene.h: declarations shared by the scene commands. */
#ifndef APP_SCENE_SCENE_H
#define APP_SCENE_SCENE_H

#include "cli/options.h"
#include "cli/report.h"
#include "velo/load.h"

/* The option of all scene commands that restricts the location of a scene's files. */
#define SCENE_SANDBOX_OPTION(id)                                                             \
  {                                                                                          \
    (id), "sandbox",                                                                         \
        "a file that the scene names must be in DIR or below it, after links are resolved; " \
        "may be given several times",                                                        \
        OPTION_FOLDERS, "DIR"                                                                \
  }

/* The option of all scene commands that adds folders to look in. */
#define SCENE_SEARCH_OPTION(id)                                                         \
  {                                                                                     \
    (id), "search-path",                                                                \
        "folder in which files that the scene names are also looked for; may be given " \
        "several times",                                                                \
        OPTION_SEARCH, "DIR"                                                            \
  }

/* prove.c: renders both files and prints the ratio of their radiance per material. Returns the
 * exit code. */
int convert_prove(vlContext *context, const vlLoadDef *load, const char *from, const char *to);
/* info_names.c */
void info_print_names(const vlScene *scene);
void info_print_choices(const vlScene *scene);
void info_json_names(Json *json, const vlScene *scene);
void info_json_choices(Json *json, const vlScene *scene);

#endif
