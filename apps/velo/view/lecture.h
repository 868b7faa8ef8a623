/* view/lecture.h: `velo view --lecture`: its scenes, which are in the program, and its
 * language. */
#ifndef APP_VIEW_LECTURE_H
#define APP_VIEW_LECTURE_H

#include "cli/options.h"

/* The scene that is there before the page names one. */
extern const char lecture_first_scene[];

/* A scene of the lecture by its name, "scenes/lecture/pinhole.pbrt": the name, for as long as
 * the program runs; null: there is no such scene. */
const char *lecture_scene(const char *name);
/* The text of a scene of the lecture, with the files that it includes. The caller frees it.
 * Null: no memory. */
char *lecture_text(const char *scene);
/* What follows the address of the page: its language, from --language, else from the
 * environment. */
const char *lecture_query(const Arguments *arguments);

#endif
