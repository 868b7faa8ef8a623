/* base/error.h: filling vlError. All take a null error. Each returns the code, so that `return vl_fail(...)` reads
 * well. */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

#include "velo/base.h"

vlResult vl_fail(vlError *error, vlResult code, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* With a place; file may be null. */
vlResult vl_fail_at(vlError *error, vlResult code, const char *file, uint32_t line, uint32_t column, const char *format,
                    ...) __attribute__((format(printf, 6, 7)));
/* Out of memory, the same words everywhere. */
vlResult vl_fail_memory(vlError *error);
void vl_error_clear(vlError *error);

#endif
