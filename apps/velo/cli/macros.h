/* cli/macros.h: steps that may fail, texts in arrays. */
#ifndef APP_CLI_MACROS_H
#define APP_CLI_MACROS_H

#include <stdarg.h>
#include <stdio.h>

/* Takes a step that returns -1, or an exit code after reporting the error. With an exit code
 * the function that holds the line returns it at once; so it must have nothing to free. */
#define TRY(...)                    \
  do {                              \
    const int tried_ = __VA_ARGS__; \
    if (tried_ >= 0)                \
      return tried_;                \
  } while (0)
/* The same in a function that returns a vlResult, of a call that returns one. */
#define TRY_RESULT(...)                  \
  do {                                   \
    const vlResult tried_ = __VA_ARGS__; \
    if (tried_ != VL_OK)                 \
      return tried_;                     \
  } while (0)

/* The number of an array's elements. */
#define LENGTH(array) (sizeof(array) / sizeof *(array))
/* Writes a text into an array of characters, as snprintf does. */
#define text_set(array, ...) snprintf(array, sizeof(array), __VA_ARGS__)

/* An argument that a function of a common type does not need. */
#define UNUSED __attribute__((unused))
/* Takes a format as printf does, and its values: their numbers among the arguments, from 1. */
#define PRINTF(text, values) __attribute__((format(printf, text, values)))
/* In a function of a format and its values: makes the text, an array. */
#define FORMATTED(text, format)                 \
  char text[2048];                              \
  do {                                          \
    va_list args;                               \
    va_start(args, format);                     \
    vsnprintf(text, sizeof text, format, args); \
    va_end(args);                               \
  } while (0)

#endif
