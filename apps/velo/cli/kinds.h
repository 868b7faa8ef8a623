/* cli/kinds.h: the kinds of velo/schema.h (materials, samplers, ...) as choices of options. */
#ifndef APP_CLI_KINDS_H
#define APP_CLI_KINDS_H

#include "cli/choice.h"
#include "velo/schema.h"

/* The names of the family's kinds, each followed by its aliases. Constant, never freed. */
const Choice *kind_choices(const char *family);
/* The name of a kind in scene files. */
const char *kind_name(const char *family, int kind);

#endif
