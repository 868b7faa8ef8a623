/* base/json.h: jansson's parser, and whether it got all the memory that it needed. */
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <jansson.h>
#include <stdbool.h>

#include "base/context.h"

/* json_loadb, once for a text that is right. jansson reports a refused allocation as a mistake
 * of the text, or not at all; here it is an error whose code is json_error_out_of_memory. */
json_t *vl_json_parse(const char *text, size_t size, size_t flags, json_error_t *error);
/* Whether vl_json_parse failed because memory was refused. */
bool vl_json_lacks_memory(const json_error_t *error);
/* The text of a tree, with the flags of json_dumps, and `end`; freed with vl_free. Null: out of
 * memory. */
char *vl_json_text(vlContext *context, const json_t *tree, size_t flags, const char *end);

#endif
