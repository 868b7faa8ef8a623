/* camera_files/yaml.c: parses YAML by libyaml into the same tree as JSON. An alias becomes a
 * copy of the value that its anchor names. The number of values in a file with aliases is
 * limited, since a small file could otherwise expand without bound. "<<" merges maps. OpenCV's
 * first line "%YAML:1.0" is not a valid YAML directive and is ignored, its tabs count as
 * blanks, and a key's colon needs no blank after it. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <yaml.h>

#include "base/text.h"
#include "camera_files/files.h"

enum { MAX_DEPTH = 32, MAX_ANCHORS = 256, MAX_COPIES = 100000 };

typedef struct Builder {
  json_t *tree[MAX_DEPTH]; /* open lists and maps; each is owned by the one before it */
  char *key[MAX_DEPTH];    /* key of the next value, in maps */
  int depth;
  json_t *root;
  char *anchor[MAX_ANCHORS]; /* names, and the values, each owned by the tree */
  json_t *anchored[MAX_ANCHORS];
  uint32_t anchors, copies; /* copies: values made by aliases */
} Builder;

static vlResult wrong_at(const vlCameraFile *file, yaml_mark_t mark, const char *what) {
  return vl_fail_at(file->error, VL_ERROR_SCENE, file->path, (uint32_t)mark.line + 1,
                    (uint32_t)mark.column + 1, "%s", what);
}

/* Converts plain numbers, booleans and null; everything else is text. */
static json_t *scalar(const yaml_event_t *event) {
  const char *text = (const char *)event->data.scalar.value;
  size_t length = event->data.scalar.length;
  if (event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE) {
    char *end;
    if (length == 0 || vl_text_is(text, "~") || vl_text_is(text, "null"))
      return json_null();
    if (vl_text_is(text, "true"))
      return json_true();
    if (vl_text_is(text, "false"))
      return json_false();
    if (strchr("+-.0123456789", text[0])) {
      double value = strtod(text, &end);
      if (end == text + length && isfinite(value))
        return json_real(value);
    }
  }
  return json_stringn(text, length);
}

/* Adds a value to the innermost open list or map; takes the reference. */
static vlResult add(const vlCameraFile *file, Builder *b, json_t *value, yaml_mark_t mark) {
  if (!value)
    return vl_fail_memory(file->error);
  if (b->depth == 0) {
    b->root = value;
    return VL_OK;
  }
  json_t *parent = b->tree[b->depth - 1];
  char **key = &b->key[b->depth - 1];
  if (json_is_array(parent))
    return json_array_append_new(parent, value) == 0 ? VL_OK : vl_fail_memory(file->error);
  bool twice = json_object_get(parent, *key) != NULL;
  int failed = json_object_set_new(parent, *key, value);
  vl_free(file->context, *key);
  *key = NULL;
  if (twice)
    return wrong_at(file, mark, "a key stands twice in one map");
  return failed ? vl_fail_memory(file->error) : VL_OK;
}

static vlResult locate(const vlCameraFile *file, yaml_mark_t mark) {
  bool pushed =
      vl_camera_push_location(file, (uint32_t)mark.line + 1, (uint32_t)mark.column + 1);
  return pushed ? VL_OK : vl_fail_memory(file->error);
}

/* Counts the values of a copy, which are all at the location of the alias. */
static vlResult locate_copy(const vlCameraFile *file, Builder *b, const json_t *value,
                            yaml_mark_t mark) {
  const char *key;
  json_t *child;
  if (++b->copies > MAX_COPIES)
    return wrong_at(file, mark, "the aliases make more than 100,000 values");
  VL_TRY(locate(file, mark));
  if (json_is_object(value)) {
    json_object_foreach((json_t *)value, key, child) VL_TRY(locate_copy(file, b, child, mark));
  } else {
    VL_EACH(child, value)
      VL_TRY(locate_copy(file, b, child, mark));
  }
  return VL_OK;
}

static vlResult remember(const vlCameraFile *file, Builder *b, const yaml_char_t *name,
                         json_t *value, yaml_mark_t mark) {
  if (!name)
    return VL_OK;
  uint32_t i = 0;
  while (i < b->anchors && !vl_text_is(b->anchor[i], (const char *)name))
    i++; /* an anchor may be used again */
  if (i == MAX_ANCHORS)
    return wrong_at(file, mark, "more than 256 anchors");
  if (i == b->anchors) {
    b->anchor[i] = vl_strdup(file->context, (const char *)name);
    if (!b->anchor[i])
      return vl_fail_memory(file->error);
    b->anchors++;
  }
  b->anchored[i] = value;
  return VL_OK;
}

/* Adds the fields of a map that the open one does not have: "<<: *name". */
static vlResult merge(const vlCameraFile *file, Builder *b, const json_t *from,
                      yaml_mark_t mark) {
  json_t *into = b->tree[b->depth - 1], *child;
  const char *key;
  if (!json_is_object(from))
    return wrong_at(file, mark, "\"<<\" needs an alias of a map");
  json_object_foreach((json_t *)from, key, child) {
    if (json_object_get(into, key))
      continue;
    VL_TRY(locate_copy(file, b, child, mark));
    if (json_object_set_new(into, key, json_deep_copy(child)) != 0)
      return vl_fail_memory(file->error);
  }
  vl_free(file->context, b->key[b->depth - 1]);
  b->key[b->depth - 1] = NULL;
  return VL_OK;
}

static vlResult alias(const vlCameraFile *file, Builder *b, const yaml_event_t *event) {
  const char *name = (const char *)event->data.alias.anchor;
  json_t *value = NULL;
  for (uint32_t i = 0; i < b->anchors; i++)
    if (vl_text_is(b->anchor[i], name))
      value = b->anchored[i];
  if (!value)
    return wrong_at(file, event->start_mark, "an alias whose anchor is not there");
  for (int i = 0; i < b->depth; i++)
    if (b->tree[i] == value)
      return wrong_at(file, event->start_mark, "an alias inside of its own anchor");
  const char *key = b->depth ? b->key[b->depth - 1] : NULL;
  if (vl_text_is(key, "<<"))
    return merge(file, b, value, event->start_mark);
  VL_TRY(locate_copy(file, b, value, event->start_mark));
  return add(file, b, json_deep_copy(value), event->start_mark);
}

static vlResult take_value(const vlCameraFile *file, Builder *b, json_t *value,
                           const yaml_char_t *anchor, yaml_mark_t mark) {
  vlResult result = locate(file, mark);
  if (result != VL_OK)
    json_decref(value);
  else
    result = add(file, b, value, mark);
  return result == VL_OK ? remember(file, b, anchor, value, mark) : result;
}

static vlResult take(const vlCameraFile *file, Builder *b, const yaml_event_t *event) {
  bool key_next =
      b->depth > 0 && json_is_object(b->tree[b->depth - 1]) && !b->key[b->depth - 1];
  switch (event->type) {
    case YAML_SCALAR_EVENT:
      if (!key_next)
        return take_value(file, b, scalar(event), event->data.scalar.anchor, event->start_mark);
      b->key[b->depth - 1] = vl_strdup(file->context, (const char *)event->data.scalar.value);
      return b->key[b->depth - 1] ? VL_OK : vl_fail_memory(file->error);
    case YAML_SEQUENCE_START_EVENT:
    case YAML_MAPPING_START_EVENT: {
      if (key_next)
        return wrong_at(file, event->start_mark, "a key must be a word");
      if (b->depth == MAX_DEPTH)
        return wrong_at(file, event->start_mark, "nested too deeply for a camera");
      bool list = event->type == YAML_SEQUENCE_START_EVENT;
      json_t *value = list ? json_array() : json_object();
      VL_TRY(take_value(
          file, b, value,
          list ? event->data.sequence_start.anchor : event->data.mapping_start.anchor,
          event->start_mark));
      b->tree[b->depth++] = value;
      return VL_OK;
    }
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
      b->depth--;
      return VL_OK;
    case YAML_ALIAS_EVENT:
      if (key_next)
        return wrong_at(file, event->start_mark, "a key must be a word");
      return alias(file, b, event);
    case YAML_NO_EVENT:
    case YAML_STREAM_START_EVENT:
    case YAML_STREAM_END_EVENT:
    case YAML_DOCUMENT_START_EVENT:
    case YAML_DOCUMENT_END_EVENT:
      break;
  }
  return VL_OK;
}

/* OpenCV's own parser takes tabs for blanks, and "Viewer.PointSize:2" (in ORB-SLAM 2's files)
 * for a key and its value. *size becomes that of the copy. */
static char *as_yaml(const vlCameraFile *file, const char *text, size_t *size) {
  char *copy = vl_alloc_array(file->context, *size + 1, 2);
  size_t n = 0;
  bool in_key = true; /* all of the line so far are letters of a key */
  for (size_t i = 0; copy && i < *size; i++) {
    bool letter = isalnum((unsigned char)text[i]) || text[i] == '.' || text[i] == '_';
    copy[n++] = text[i] == '\t' ? ' ' : text[i];
    if (in_key && text[i] == ':' && i + 1 < *size && !isspace((unsigned char)text[i + 1]))
      copy[n++] = ' ';
    in_key = text[i] == '\n' || (in_key && letter);
  }
  if (copy)
    copy[n] = 0;
  *size = n;
  return copy;
}

vlResult vl_camera_yaml(const vlCameraFile *file, const char *text, size_t size,
                        json_t **tree) {
  Builder b = {.depth = 0};
  yaml_parser_t parser;
  *tree = NULL;
  /* the line end is kept, for line numbers */
  size_t skip = size >= 6 && memcmp(text, "%YAML:", 6) == 0 ? strcspn(text, "\n") : 0;
  char *copy = skip ? as_yaml(file, text, &size) : NULL;
  if (skip && !copy)
    return vl_fail_memory(file->error);
  if (!yaml_parser_initialize(&parser)) {
    vl_free(file->context, copy);
    return vl_fail_memory(file->error);
  }
  const char *source = (copy ? copy : text) + skip;
  yaml_parser_set_input_string(&parser, (const unsigned char *)source, size - skip);
  vlResult result = VL_OK;
  int documents = 0;
  for (bool done = false; result == VL_OK && !done;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      if (parser.error == YAML_MEMORY_ERROR)
        result = vl_fail_memory(file->error);
      else
        result = vl_fail_at(file->error, VL_ERROR_SCENE, file->path,
                            (uint32_t)parser.problem_mark.line + 1,
                            (uint32_t)parser.problem_mark.column + 1, "not YAML: %s",
                            parser.problem ? parser.problem : "cannot be read");
      break;
    }
    done = event.type == YAML_STREAM_END_EVENT;
    bool second = event.type == YAML_DOCUMENT_START_EVENT && ++documents > 1;
    size_t after = event.end_mark.index;
    if (second && source[after + strspn(source + after, " \t\r\n.")] == 0)
      done = true; /* "---" at the end, as ROS prints it after a message */
    else if (second)
      result = wrong_at(file, event.start_mark, "a second document in one file");
    else
      result = take(file, &b, &event);
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  vl_free(file->context, copy);
  for (int i = 0; i < MAX_DEPTH; i++)
    vl_free(file->context, b.key[i]);
  for (uint32_t i = 0; i < b.anchors; i++)
    vl_free(file->context, b.anchor[i]);
  if (result != VL_OK)
    json_decref(b.root);
  else
    *tree = b.root;
  return result;
}
