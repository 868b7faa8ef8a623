/* view/view.h: `velo view`: the parts of the command. */
#ifndef APP_VIEW_VIEW_H
#define APP_VIEW_VIEW_H

#include "render/lens_options.h"

/* Indices into Arguments.values, behind those of the lens. The other options are those of `velo
 * render`. */
enum {
  VIEW_PORT = RENDER_OPTIONS,
  VIEW_LISTEN,
  VIEW_NO_OPEN,
  VIEW_LECTURE,
  VIEW_LANGUAGE,
  VIEW_EXPOSE,
  VIEW_OPTIONS
};
_Static_assert((int)VIEW_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

enum { LANGUAGE_ENGLISH, LANGUAGE_ITALIAN }; /* of --language */

extern Option view_options[];

/* Runs the command. Returns the exit code. */
int view_run(const Arguments *arguments);

#endif
