/* schema/given.h: what the checks of defs and of given values share. */
#ifndef SCHEMA_GIVEN_H
#define SCHEMA_GIVEN_H

#include "velo/setting.h"

/* Whether a number in the def's unit is finite (or may be infinite, or unset), whole if it must
 * be, and in range. */
bool vl_in_range(const vlParameter *row, double x);
/* Writes `NAME must be RULE; it is VALUE`, as vl_given_check does for a value that does not
 * fit. */
void vl_put_wrong(const vlParameter *row, const char *name, const vlGiven *given, char *message,
                  size_t size);

#endif
