/* base/error.h: filling vlError. All functions accept a null error. Each returns the code, so that callers can write
 * `return vl_fail(...)`. */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

#include "velo/base.h"

/* End of the message about a def that no default function made, or that of another ABI version. */
#define VL_BAD_COOKIE "def.cookie is not that of a default def of this version"

vlResult vl_fail(vlError *error, vlResult code, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* With a source location; file may be null. */
vlResult vl_fail_at(vlError *error, vlResult code, const char *file, uint32_t line, uint32_t column, const char *format,
                    ...) __attribute__((format(printf, 6, 7)));
/* Out of memory, with the same message everywhere. */
vlResult vl_fail_memory(vlError *error);
void vl_error_clear(vlError *error);

#endif
