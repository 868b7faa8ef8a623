/* base/error.h: filling vlError. All functions accept a null error. Each returns the code, so
 * that callers can write `return vl_fail(...)`. */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

#include "base/attributes.h"
#include "velo/base.h"
#include "velo/scene_base.h"

/* End of the message about a def that was not made by the default function of this ABI
 * version. */
#define VL_BAD_COOKIE "def.cookie is not that of a default def of this version"

vlResult vl_fail(vlError *error, vlResult code, const char *format, ...) VL_PRINTF(3, 4);
/* vl_fail with a source location; file may be null. */
vlResult vl_fail_at(vlError *error, vlResult code, const char *file, uint32_t line,
                    uint32_t column, const char *format, ...) VL_PRINTF(6, 7);
/* The same with the place of a scene's text. */
vlResult vl_fail_source(vlError *error, vlResult code, vlSource source, const char *format, ...)
    VL_PRINTF(4, 5);
/* Fills in VL_ERROR_ARGUMENT. */
vlResult vl_fail_argument(vlError *error, const char *format, ...) VL_PRINTF(2, 3);
/* Fills in VL_ERROR_MEMORY with its common message. */
vlResult vl_fail_memory(vlError *error);
void vl_error_clear(vlError *error);

/* Makes a call that returns a vlResult. After an error the function that holds the line returns
 * this result at once; so it must have nothing to free. */
#define VL_TRY(...)                        \
  do {                                     \
    const vlResult vl_tried = __VA_ARGS__; \
    if (vl_tried != VL_OK)                 \
      return vl_tried;                     \
  } while (0)

#endif
