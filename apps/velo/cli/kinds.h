/* cli/kinds.h: the kinds of velo/schema.h (materials, samplers, ...) as choices of options. */
#ifndef APP_CLI_KINDS_H
#define APP_CLI_KINDS_H

#include "cli/choice.h"
#include "velo/schema.h"

/* The names of a family's kinds, each followed by its aliases, and further names. list: the
 * family's name, the further names, and null; a family has one list with further names.
 * Constant, never freed. */
const Choice *kind_choices(const Choice *list);
/* The name of a kind in scene files. */
const char *kind_name(const char *family, int kind);

#endif
