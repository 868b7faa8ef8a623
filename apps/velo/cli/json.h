/* cli/json.h: writing JSON, one value after the other, to a stream. Strings that are not UTF-8 get replacement
 * characters, numbers that are not finite become null; commas are kept by the writer. */
#ifndef APP_CLI_JSON_H
#define APP_CLI_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct Json {
  FILE *out;
  bool comma; /* a value stands before the next one */
} Json;

/* key is null inside arrays and for the outermost value. bracket is '{' or '['; the end takes '}' or ']'. */
void json_begin(Json *json, const char *key, char bracket);
void json_end(Json *json, char bracket);
void json_text(Json *json, const char *key, const char *text);
void json_number(Json *json, const char *key, double number);
/* jansson, which the library is made of, has a json_integer too: linked together they must not be the same. */
#define json_integer json_put_integer
void json_integer(Json *json, const char *key, int64_t number);
void json_bool(Json *json, const char *key, bool truth);

/* The shortest decimal that reads back as the same number. */
void format_number(char *text, size_t size, double number);

#endif
