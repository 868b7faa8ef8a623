/* base/json.c: see json.h. */
#include "base/json.h"

#include <string.h>

enum { SMALL = 1 << 20 };

static void lack_memory(json_error_t *error) {
  error->text[JSON_ERROR_TEXT_LENGTH - 1] =
      json_error_out_of_memory; /* where json_error_code looks */
}

/* jansson loses bytes of a long string, without an error, if its buffer cannot grow. Small
 * texts are parsed a second time, so that this is found. Large texts are scenes: their errors
 * are found when they are read. */
static json_t *checked(json_t *tree, const char *text, size_t size, size_t flags,
                       json_error_t *error) {
  json_t *again = size <= SMALL ? json_loadb(text, size, flags, error) : NULL;
  if (size > SMALL || (again && json_equal(tree, again))) {
    json_decref(again);
    return tree;
  }
  json_decref(tree);
  json_decref(again);
  lack_memory(error);
  return NULL;
}

json_t *vl_json_parse(const char *text, size_t size, size_t flags, json_error_t *error) {
  json_t *tree = json_loadb(text, size, flags, error);
  if (tree)
    return checked(tree, text, size, flags, error);
  json_error_t other;
  json_t *again = json_loadb(text, size, flags, &other); /* wrong text is wrong twice */
  json_t *probe = json_string("whether there is memory for a short string");
  if (again || !probe)
    lack_memory(error);
  json_decref(again);
  json_decref(probe);
  return NULL;
}

bool vl_json_lacks_memory(const json_error_t *error) {
  return json_error_code(error) == json_error_out_of_memory;
}

char *vl_json_text(vlContext *context, const json_t *tree, size_t flags, const char *end) {
  size_t size = json_dumpb(tree, NULL, 0, flags);
  char *text = size ? vl_alloc(context, size + strlen(end) + 1) : NULL;
  if (!text || json_dumpb(tree, text, size, flags) != size) {
    vl_free(context, text);
    return NULL;
  }
  memcpy(text + size, end, strlen(end) + 1);
  return text;
}
