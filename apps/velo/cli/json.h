/* cli/json.h: writes JSON to a stream, one value after the other; the writer inserts commas.
 * Invalid UTF-8 is replaced by replacement characters, numbers that are not finite by null. */
#ifndef APP_CLI_JSON_H
#define APP_CLI_JSON_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "cli/macros.h"

typedef struct Json {
  FILE *out;
  bool comma; /* a value precedes the next one */
} Json;

/* key is null inside arrays and for the outermost value. bracket: '{' or '[' to begin, '}' or
 * ']' to end. */
void json_begin(Json *json, const char *key, char bracket);
void json_end(Json *json, char bracket);
/* A null text is left out, with its key. */
void json_text(Json *json, const char *key, const char *text);
void json_number(Json *json, const char *key, double number);
/* avoids a clash with jansson's json_integer, which the library links */
#define json_integer json_put_integer
void json_integer(Json *json, const char *key, int64_t number);
/* Several members: "name %s, size %u, mean %g", with their values. %s: as of json_text; %g: a
 * number; %u, %d, %lld: whole numbers; %i: whether something is so. */
void json_put(Json *json, const char *members, ...) PRINTF(2, 3);
void json_put_list(Json *json, const char *members, va_list values);
/* Begins the one object that a command prints to stdout; json_close ends it and the line. */
Json *json_open(void);
void json_close(Json *json);
/* File, line and column of the object, each where it is known: null, or 0. */
void json_location(Json *json, const char *file, uint32_t line, uint32_t column);
/* Arrays. */
void json_numbers(Json *json, const char *key, const double *numbers, uint32_t count);
void json_integers(Json *json, const char *key, const uint32_t *numbers, uint32_t count);
void json_bool(Json *json, const char *key, bool value);

/* The shortest decimal that reads back as the same number. */
void format_number(char *text, size_t size, double number);
/* The number of that decimal, where a number of single precision is all that is known. */
double shortest_float(float number);

#endif
