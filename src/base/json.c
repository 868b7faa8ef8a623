/* base/json.c: see json.h. */
#include "base/json.h"

#include <string.h>

/* What a longer token, a part of a scene, lacks is found when it is read. */
enum { MAX_PAD = 3 << 19 };

static void lack_memory(json_error_t *error) {
  /* where json_error_code looks */
  error->text[JSON_ERROR_TEXT_LENGTH - 1] = json_error_out_of_memory;
}

/* What jansson reads: the text as the second element of an array, whose first is a string of x,
 * the pad. jansson loses bytes of a long token, without an error, if its buffer for tokens
 * cannot grow. It has one buffer, so once the pad is read whole, no shorter token makes the
 * buffer grow. */
typedef struct Part {
  const char *text; /* null: the pad's letters */
  size_t size;
} Part;
enum { PARTS = 5 };
typedef struct Padded {
  Part parts[PARTS];
  int part;
  size_t at; /* number of bytes of the part that were read */
} Padded;

/* A json_load_callback_t. */
static size_t read_padded(void *buffer, size_t room, void *data) {
  Padded *p = data;
  while (p->part < PARTS && p->at == p->parts[p->part].size) {
    p->part++;
    p->at = 0;
  }
  if (p->part == PARTS)
    return 0;
  const Part *part = &p->parts[p->part];
  size_t n = part->size - p->at < room ? part->size - p->at : room;
  if (part->text)
    memcpy(buffer, part->text + p->at, n);
  else
    memset(buffer, 'x', n);
  p->at += n;
  return n;
}

/* The length of the longest token, with its quotes and escapes. */
static size_t longest_token(const char *text, size_t size) {
  size_t longest = 0, start = 0;
  bool quoted = false;
  for (size_t i = 0; i < size; i++) {
    char c = text[i];
    bool ends = !quoted && strchr(" \t\r\n,:[]{}", c);
    if (c == '"')
      quoted = !quoted;
    else if (c == '\\' && quoted)
      i++;
    if (ends)
      start = i + 1;
    else if (i + 1 - start > longest)
      longest = i + 1 - start;
  }
  return longest;
}

/* The buffer's size doubles. Its last growth for the pad is far from the closing quote: jansson
 * would read on if that byte was lost. */
static size_t pad_for(size_t longest) {
  size_t pad = 24;
  while (pad < longest && pad < MAX_PAD)
    pad *= 2;
  return pad;
}

json_t *vl_json_parse(const char *text, size_t size, size_t flags, json_error_t *error) {
  size_t pad = pad_for(longest_token(text, size));
  Padded padded = {.parts = {{"[\"", 2}, {NULL, pad}, {"\",", 2}, {text, size}, {"\n]", 2}}};
  json_t *both = json_load_callback(read_padded, &padded, flags, error);
  json_t *tree = json_array_size(both) == 2 ? json_incref(json_array_get(both, 1)) : NULL;
  bool whole = json_string_length(json_array_get(both, 0)) == pad;
  json_decref(both);
  if (json_is_array(tree) || json_is_object(tree)) {
    if (whole)
      return tree;
    json_decref(tree);
    lack_memory(error);
    return NULL;
  }
  json_decref(tree);
  /* The message about the text alone. What is wrong is wrong without the array, too. */
  bool deep = !both && json_error_code(error) == json_error_stack_overflow;
  tree = json_loadb(text, size, flags, error);
  if (tree && deep)
    return tree; /* as deep as jansson allows, without the array */
  json_t *probe = json_string("whether there is memory for a short string");
  if (tree || !probe)
    lack_memory(error);
  json_decref(tree);
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
