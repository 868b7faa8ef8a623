/* camera_files/yaml.c: YAML by libyaml, made into the tree that JSON gives. Anchors are refused: a small file could
 * grow without end by them. OpenCV's first line "%YAML:1.0" is no directive of YAML's and is ignored. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "camera_files/files.h"

enum { MAX_DEPTH = 32 };

typedef struct {
  json_t *tree[MAX_DEPTH]; /* open lists and maps; each is held by the one before it */
  char *key[MAX_DEPTH];    /* of the value to come, in maps */
  int depth;
  json_t *root;
} Builder;

static vlResult wrong_at(const vlCameraFile *file, yaml_mark_t mark, const char *what) {
  return vl_fail_at(file->error, VL_ERROR_SCENE, file->path, (uint32_t)mark.line + 1, (uint32_t)mark.column + 1, "%s",
                    what);
}

/* Plain numbers, true and false, nothing; the rest is text. */
static json_t *scalar(const yaml_event_t *event) {
  const char *text = (const char *)event->data.scalar.value;
  size_t length = event->data.scalar.length;
  if (event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE) {
    char *end;
    if (length == 0 || strcmp(text, "~") == 0 || strcmp(text, "null") == 0) return json_null();
    if (strcmp(text, "true") == 0) return json_true();
    if (strcmp(text, "false") == 0) return json_false();
    if (strchr("+-.0123456789", text[0])) {
      double value = strtod(text, &end);
      if (end == text + length && isfinite(value)) return json_real(value);
    }
  }
  return json_stringn(text, length);
}

/* Takes the reference. */
static vlResult add(const vlCameraFile *file, Builder *b, json_t *value, yaml_mark_t mark) {
  if (!value) return vl_fail_memory(file->error);
  if (b->depth == 0) {
    b->root = value;
    return VL_OK;
  }
  json_t *parent = b->tree[b->depth - 1];
  char **key = &b->key[b->depth - 1];
  if (json_is_array(parent)) return json_array_append_new(parent, value) == 0 ? VL_OK : vl_fail_memory(file->error);
  bool twice = json_object_get(parent, *key) != NULL;
  int failed = json_object_set_new(parent, *key, value);
  vl_free(file->context, *key);
  *key = NULL;
  if (twice) return wrong_at(file, mark, "a key stands twice in one map");
  return failed ? vl_fail_memory(file->error) : VL_OK;
}

static vlResult take(const vlCameraFile *file, Builder *b, const yaml_event_t *event) {
  bool key_next = b->depth > 0 && json_is_object(b->tree[b->depth - 1]) && !b->key[b->depth - 1];
  switch (event->type) {
    case YAML_SCALAR_EVENT:
      if (!key_next) return add(file, b, scalar(event), event->start_mark);
      b->key[b->depth - 1] = vl_strdup(file->context, (const char *)event->data.scalar.value);
      return b->key[b->depth - 1] ? VL_OK : vl_fail_memory(file->error);
    case YAML_SEQUENCE_START_EVENT:
    case YAML_MAPPING_START_EVENT: {
      if (key_next) return wrong_at(file, event->start_mark, "a key must be a word");
      if (b->depth == MAX_DEPTH) return wrong_at(file, event->start_mark, "nested too deeply for a camera");
      json_t *value = event->type == YAML_SEQUENCE_START_EVENT ? json_array() : json_object();
      vlResult result = add(file, b, value, event->start_mark);
      if (result == VL_OK) b->tree[b->depth++] = value;
      return result;
    }
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT: b->depth--; return VL_OK;
    case YAML_ALIAS_EVENT:
      return wrong_at(file, event->start_mark, "anchors of YAML are not taken; write the value out");
    default: return VL_OK;
  }
}

vlResult vl_camera_yaml(const vlCameraFile *file, const char *text, size_t size, json_t **tree) {
  Builder b = {.depth = 0};
  yaml_parser_t parser;
  *tree = NULL;
  if (!yaml_parser_initialize(&parser)) return vl_fail_memory(file->error);
  /* the line end stays, so that lines are counted right */
  size_t skip = size >= 6 && memcmp(text, "%YAML:", 6) == 0 ? strcspn(text, "\n") : 0;
  yaml_parser_set_input_string(&parser, (const unsigned char *)text + skip, size - skip);
  vlResult result = VL_OK;
  int documents = 0;
  for (bool done = false; result == VL_OK && !done;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      if (parser.error == YAML_MEMORY_ERROR)
        result = vl_fail_memory(file->error);
      else
        result = vl_fail_at(file->error, VL_ERROR_SCENE, file->path, (uint32_t)parser.problem_mark.line + 1,
                            (uint32_t)parser.problem_mark.column + 1, "not YAML: %s",
                            parser.problem ? parser.problem : "cannot be read");
      break;
    }
    done = event.type == YAML_STREAM_END_EVENT;
    if (event.type == YAML_DOCUMENT_START_EVENT && ++documents > 1)
      result = wrong_at(file, event.start_mark, "a second document in one file");
    else
      result = take(file, &b, &event);
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  for (int i = 0; i < MAX_DEPTH; i++) vl_free(file->context, b.key[i]);
  if (result != VL_OK)
    json_decref(b.root);
  else
    *tree = b.root;
  return result;
}
