/* camera_files/usda.c: parses USD's text form, as far as cameras need it, into a tree. A prim
 * is an object with its properties by name (numbers, words and lists of them; tuples are
 * lists), "<": its type, "@": its name, "#": its line, "|": its column, "/": its child prims.
 * The root holds the layer's metadata by name. Properties of cameras, render settings and
 * transforms are kept; all others, above all meshes, are skipped without being stored. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "base/text.h"
#include "camera_files/files.h"

enum { MAX_DEPTH = 64, MAX_PRIMS = 20000, MAX_NUMBERS = 64 };

typedef struct {
  const vlCameraFile *file;
  const char *start, *at, *end;
  uint32_t line;
  uint32_t prims;
  vlResult result;
} Parser;

static uint32_t column_of(const Parser *p) {
  const char *first = p->at;
  while (first > p->start && first[-1] != '\n')
    first--;
  return (uint32_t)(p->at - first) + 1;
}

static bool fail(Parser *p, const char *what) {
  if (p->result == VL_OK)
    p->result = vl_camera_wrong_at(p->file, p->line, column_of(p), "not USD: %s", what);
  return false;
}

static bool memory(Parser *p) {
  if (p->result == VL_OK)
    p->result = vl_fail_memory(p->file->error);
  return false;
}

/* Skips blanks and comments; false at the end. */
static bool skip(Parser *p) {
  for (; p->at < p->end; p->at++) {
    if (*p->at == '\n') {
      p->line++;
    } else if (*p->at == '#') {
      while (p->at + 1 < p->end && p->at[1] != '\n')
        p->at++;
    } else if (!isspace((unsigned char)*p->at) && *p->at != ';') {
      return true;
    }
  }
  return false;
}

/* Whether a string begins here. */
static bool at_string(const Parser *p) {
  return *p->at == '"' || *p->at == '\'';
}

static bool next_is(Parser *p, char c) {
  return skip(p) && *p->at == c;
}

static bool take(Parser *p, char c) {
  if (!next_is(p, c))
    return false;
  p->at++;
  return true;
}

/* Length of the identifier at the current position: xformOp:translate, double3, camera.name. */
static size_t word(Parser *p) {
  const char *s = p->at;
  while (s < p->end && (isalnum((unsigned char)*s) || strchr("_:.!", *s)) && *s)
    s++;
  return (size_t)(s - p->at);
}

/* Whether the word at the current position begins a prim. */
static bool begins_prim(const Parser *p, size_t length) {
  return vl_has_word_of("def over class", p->at, length);
}

/* Parses a string after its opening quote (one or three). *text, *length: its contents. */
static bool string(Parser *p, const char **text, size_t *length) {
  char quote = *p->at;
  size_t quotes = p->end - p->at >= 3 && p->at[1] == quote && p->at[2] == quote ? 3 : 1;
  *text = p->at += quotes;
  for (; p->at < p->end; p->at++) {
    if (*p->at == '\\' && p->at + 1 < p->end) {
      p->at++;
    } else if (*p->at == quote && (quotes == 1 || (p->end - p->at >= 3 && p->at[1] == quote &&
                                                   p->at[2] == quote))) {
      *length = (size_t)(p->at - *text);
      p->at += quotes;
      return true;
    } else if (*p->at == '\n' && quotes == 1) {
      break;
    }
    if (*p->at == '\n')
      p->line++;
  }
  return fail(p, "a string has no end");
}

/* Parses any value. *value (may be null: not stored) is a new reference, or null for values
 * that are not kept. */
static bool value(Parser *p, int depth, json_t **result);

static bool list(Parser *p, int depth, char close, json_t **result) {
  json_t *items = result ? json_array() : NULL;
  p->at++;
  while (!take(p, close)) {
    json_t *item = NULL;
    if (p->at >= p->end)
      fail(p, "a list has no end");
    if (p->result == VL_OK && depth == 0)
      fail(p, "lists are nested too deeply");
    if (p->result != VL_OK || !value(p, depth - 1, items ? &item : NULL)) {
      json_decref(item);
      break;
    }
    if (item && json_array_size(items) < MAX_NUMBERS)
      json_array_append_new(items, item);
    else
      json_decref(item);
    take(p, ',');
  }
  if (result)
    *result = items;
  return p->result == VL_OK;
}

/* Skips { ... } of a dictionary or of time samples, from the brace. */
static bool braces(Parser *p) {
  int depth = 0;
  do {
    const char *text;
    size_t length;
    if (!skip(p))
      return fail(p, "a brace is not closed");
    if (at_string(p)) {
      if (!string(p, &text, &length))
        return false;
      continue;
    }
    depth += (*p->at == '{') - (*p->at == '}');
    p->at++;
  } while (depth > 0);
  return true;
}

static bool value(Parser *p, int depth, json_t **result) {
  const char *text = NULL;
  size_t length = 0;
  if (!skip(p))
    return fail(p, "a value is missing");
  char c = *p->at;
  if (c == '(' || c == '[')
    return list(p, depth, c == '(' ? ')' : ']', result);
  if (c == '{') {
    if (result)
      *result = json_true(); /* time samples: only their presence is recorded */
    return braces(p);
  }
  if (at_string(p)) {
    if (!string(p, &text, &length))
      return false;
    if (result)
      *result = json_stringn(text, length);
    return true;
  }
  if (c == '<' || c == '@') {
    char close = c == '<' ? '>' : '@';
    text = ++p->at;
    while (p->at < p->end && *p->at != close && *p->at != '\n')
      p->at++;
    if (p->at == p->end || *p->at != close)
      return fail(p, "a path has no end");
    if (result)
      *result = json_stringn(text, (size_t)(p->at - text));
    p->at++;
    return true;
  }
  if (isdigit((unsigned char)c) || strchr("+-.", c)) {
    char *end;
    double number = strtod(p->at, &end); /* the text is zero-terminated */
    if (end == p->at)
      return fail(p, "a value is missing");
    if (result)
      *result =
          isfinite(number) ? json_real(number) : json_stringn(p->at, (size_t)(end - p->at));
    p->at = end;
    return true;
  }
  length = word(p);
  if (length == 0)
    return fail(p, "a value is missing");
  if (result)
    *result = json_stringn(p->at, length);
  p->at += length;
  return true;
}

/* Parses a value, and stores it unless `into` is null. */
static bool named_value(Parser *p, const char *name, size_t length, json_t *into) {
  json_t *item = NULL;
  if (!value(p, 4, into ? &item : NULL)) {
    json_decref(item);
    return false;
  }
  return !item || json_object_setn_new(into, name, length, item) == 0 || memory(p);
}

/* Parses ( ... ) after a prim or property, or at the layer's head; values of the head are
 * stored in `into`. */
static bool metadata(Parser *p, json_t *into) {
  if (!take(p, '('))
    return p->result == VL_OK;
  while (!take(p, ')')) {
    const char *name;
    size_t length;
    if (!skip(p))
      return fail(p, "a parenthesis is not closed");
    if (at_string(p)) { /* a comment */
      if (!string(p, &name, &length))
        return false;
      continue;
    }
    name = p->at;
    length = word(p);
    if (length == 0)
      return fail(p, "a name is missing in parentheses");
    p->at += length;
    if (!take(p, '='))
      continue; /* `prepend`, `delete`, ... precede the name */
    if (!named_value(p, name, length, into))
      return false;
  }
  return true;
}

static bool is_kept(const json_t *prim, const char *name, size_t length) {
  const char *type = json_string_value(json_object_get(prim, "<"));
  if (length >= 7 && memcmp(name, "xformOp", 7) == 0)
    return true;
  return type && (vl_text_is(type, "Camera") || strncmp(type, "Render", 6) == 0);
}

/* Parses [custom] [uniform] type name [= value] [(metadata)]: the last word before = or ( is
 * the name. */
static bool property(Parser *p, json_t *prim) {
  const char *name = p->at;
  size_t length = 0;
  while (p->at < p->end && !strchr("\n#=(;", *p->at)) {
    size_t more = word(p);
    if (more) {
      name = p->at;
      length = more;
    } else if (!strchr(" \t\r[]", *p->at)) {
      return fail(p, "something stands where a property should");
    }
    p->at += more ? more : 1;
  }
  if (p->at < p->end && *p->at == '=') {
    p->at++;
    if (!named_value(p, name, length, is_kept(prim, name, length) ? prim : NULL))
      return false;
  }
  return metadata(p, NULL);
}

static bool prim(Parser *p, json_t *parent, int depth);

static bool body(Parser *p, json_t *self, int depth) {
  while (!take(p, '}')) {
    if (!skip(p))
      return fail(p, "a prim is not closed");
    size_t length = word(p);
    if (length == 0)
      return fail(p, "something stands where a property or a prim should");
    bool is_prim = begins_prim(p, length);
    if (vl_has_word_of("variantSet", p->at, length)) {
      p->at += length;
      const char *text;
      if (!skip(p) || !at_string(p))
        return fail(p, "a variant set has no name");
      if (!string(p, &text, &length) || !take(p, '=') || !next_is(p, '{'))
        return fail(p, "a variant set is empty");
      if (!braces(p))
        return false;
    } else if (!(is_prim ? prim(p, self, depth) : property(p, self))) {
      return false;
    }
  }
  return true;
}

/* Parses def [Type] "name" (metadata) { ... }, from its first word. */
static bool prim(Parser *p, json_t *parent, int depth) {
  const char *text = "", *type;
  size_t length = word(p), type_length;
  bool stored = !vl_has_word_of("class", p->at, length);
  if (depth == 0 || ++p->prims > MAX_PRIMS)
    return fail(p, depth == 0 ? "nested too deeply" : "too many prims");
  p->at += length;
  if (!skip(p))
    return fail(p, "a prim has no name");
  type = p->at;
  type_length = word(p);
  p->at += type_length;
  uint32_t line = p->line, column = column_of(p);
  if (!skip(p) || !at_string(p))
    return fail(p, "a prim has no name");
  if (!string(p, &text, &length))
    return false;
  json_t *self = json_object();
  int failed = json_object_set_new(self, "<", json_stringn(type, type_length));
  failed |= json_object_set_new(self, "@", json_stringn(text, length));
  failed |= json_object_set_new(self, "#", json_real(line));
  failed |= json_object_set_new(self, "|", json_real(column));
  failed |= json_object_set_new(self, "/", json_array());
  if (stored && !failed)
    failed = json_array_append(json_object_get(parent, "/"), self);
  bool good = failed ? memory(p) : metadata(p, NULL);
  if (good && !take(p, '{'))
    good = fail(p, "a prim has no body");
  if (good)
    good = body(p, self, depth - 1);
  json_decref(self);
  return good;
}

vlResult vl_camera_usda(const vlCameraFile *file, const char *text, size_t size,
                        json_t **tree) {
  Parser p = {
      .file = file, .start = text, .at = text, .end = text + size, .line = 1, .result = VL_OK};
  json_t *root = json_object();
  *tree = NULL;
  if (!root || json_object_set_new(root, "/", json_array()) != 0)
    memory(&p);
  if (p.result == VL_OK)
    metadata(&p, root);
  while (p.result == VL_OK && skip(&p)) {
    if (begins_prim(&p, word(&p)))
      prim(&p, root, MAX_DEPTH);
    else
      fail(&p, "something stands where a prim should");
  }
  if (p.result == VL_OK)
    *tree = root;
  else
    json_decref(root);
  return p.result;
}
