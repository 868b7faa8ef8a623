/* base/error.c: see error.h. */
#include "base/error.h"

#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void set_error(vlError *error, vlResult code, const char *file, uint32_t line,
                      uint32_t column, const char *format, va_list args) {
  error->code = code;
  error->line = line;
  error->column = column;
  snprintf(error->file, sizeof error->file, "%s", file ? file : "");
  vl_make_printable(error->file);
  vsnprintf(error->message, sizeof error->message, format, args);
  vl_make_printable(error->message);
}

vlResult vl_fail(vlError *error, vlResult code, const char *format, ...) {
  va_list args;
  va_start(args, format);
  if (error)
    set_error(error, code, NULL, 0, 0, format, args);
  va_end(args);
  return code;
}

vlResult vl_fail_at(vlError *error, vlResult code, const char *file, uint32_t line,
                    uint32_t column, const char *format, ...) {
  va_list args;
  va_start(args, format);
  if (error)
    set_error(error, code, file, line, column, format, args);
  va_end(args);
  return code;
}

vlResult vl_fail_source(vlError *error, vlResult code, vlSource source, const char *format,
                        ...) {
  va_list args;
  va_start(args, format);
  if (error)
    set_error(error, code, source.file, source.line, source.column, format, args);
  va_end(args);
  return code;
}

vlResult vl_fail_argument(vlError *error, const char *format, ...) {
  char text[sizeof error->message];
  VL_FORMAT(text, format);
  return vl_fail(error, VL_ERROR_ARGUMENT, "%s", text);
}

vlResult vl_fail_memory(vlError *error) {
  return vl_fail(error, VL_ERROR_MEMORY, "out of memory");
}

void vl_error_clear(vlError *error) {
  if (error)
    memset(error, 0, sizeof *error);
}

const char *vl_result_name(vlResult result) {
  switch (result) {
    case VL_OK:
      return "ok";
    case VL_ERROR_ARGUMENT:
      return "bad argument";
    case VL_ERROR_MEMORY:
      return "out of memory";
    case VL_ERROR_SCENE:
      return "scene error";
    case VL_ERROR_MISSING:
      return "missing file";
    case VL_ERROR_IO:
      return "input/output error";
    case VL_ERROR_UNSUPPORTED:
      return "not supported";
    case VL_CANCELLED:
      return "cancelled";
  }
  return "unknown result";
}
