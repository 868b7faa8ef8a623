/* cli/kinds.h: the kinds of velo/schema.h (materials, samplers, ...) and the sensors as choices
 * of options. */
#ifndef APP_CLI_KINDS_H
#define APP_CLI_KINDS_H

#include "cli/choice.h"
#include "velo/schema.h"

/* The names of a family's kinds, or of "sensors" (vl_sensor_name), each followed by its alias,
 * and then further names. list: first the family's name, then the further names with their
 * values, then a null name. All lists with further names of one family must be the same.
 * Constant, never freed; the first call for each list must not run beside others. */
const Choice *kind_choices(const Choice *list);
/* The name of a kind in scene files. */
const char *kind_name(const char *family, int kind);

#endif
