/* cli/kinds.h: the kinds of velo/schema.h as choices of options. */
#ifndef APP_CLI_KINDS_H
#define APP_CLI_KINDS_H

#include "cli/choice.h"
#include "velo/schema.h"

/* The family of that name; null: none. */
const vlKindFamily *kind_family(const char *name);
/* Names and aliases of the family's kinds, each kind's together; constant, never freed. */
const Choice *kind_choices(const char *family);
/* A kind's name in files. */
const char *kind_name(const char *family, int kind);

#endif
