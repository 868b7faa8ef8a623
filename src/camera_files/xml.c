/* camera_files/xml.c: XML by expat, made into a tree: an element is an object with its attributes by name, "<": its
 * tag, "#": its line, "/": the elements in it. Text is ignored. A document type is refused, and with it every
 * entity that a file could define; depth and number of elements are bounded. */
#include <expat.h>
#include <string.h>

#include "camera_files/files.h"

enum { MAX_DEPTH = 32, MAX_ELEMENTS = 20000 };

typedef struct {
  const vlCameraFile *file;
  XML_Parser parser;
  const char *const *wanted; /* tags of the root, or below it; others there are ignored with all in them */
  json_t *open[MAX_DEPTH];   /* held by the one before */
  int depth, skipped;        /* skipped: open elements that are ignored */
  uint32_t elements;
  vlResult result;
} Builder;

static uint32_t line_of(const Builder *b) {
  return (uint32_t)XML_GetCurrentLineNumber(b->parser);
}

static void stop(Builder *b, vlResult result) {
  b->result = result;
  XML_StopParser(b->parser, XML_FALSE);
}

static bool is_among(const char *const *tags, const char *tag) {
  while (*tags && strcmp(*tags, tag) != 0) tags++;
  return *tags != NULL;
}

static bool is_wanted(const Builder *b, const char *tag) {
  if (b->depth != 1 || is_among(b->wanted, tag)) return true;
  return is_among(b->wanted, json_string_value(json_object_get(b->open[0], "<")));
}

static void on_start(void *data, const char *tag, const char **attributes) {
  Builder *b = data;
  if (b->result != VL_OK) return; /* expat may go on to the end of its buffer */
  if (b->skipped || !is_wanted(b, tag)) {
    b->skipped++;
    return;
  }
  uint32_t line = line_of(b), column = (uint32_t)XML_GetCurrentColumnNumber(b->parser) + 1;
  if (b->depth == MAX_DEPTH || ++b->elements > MAX_ELEMENTS) {
    stop(b, vl_camera_wrong_at(b->file, line, column, "%s for a camera",
                               b->depth == MAX_DEPTH ? "nested too deeply" : "too many elements"));
    return;
  }
  json_t *element = json_object();
  int failed = json_object_set_new(element, "<", json_string(tag));
  failed |= json_object_set_new(element, "#", json_real(line));
  failed |= json_object_set_new(element, "/", json_array());
  for (; *attributes && !failed; attributes += 2)
    failed |= json_object_set_new(element, attributes[0], json_string(attributes[1]));
  if (!failed && b->depth > 0) failed = json_array_append(json_object_get(b->open[b->depth - 1], "/"), element);
  if (failed) stop(b, vl_fail_memory(b->file->error));
  if (b->depth > 0 || failed) json_decref(element); /* the root stays with the builder */
  if (!failed) b->open[b->depth++] = element;
}

static void on_end(void *data, const char *tag) {
  Builder *b = data;
  (void)tag;
  if (b->result != VL_OK) return;
  if (b->skipped)
    b->skipped--;
  else if (b->depth > 1)
    b->depth--;
}

static void on_document_type(void *data, const char *name, const char *system, const char *public_id, int internal) {
  Builder *b = data;
  (void)name, (void)system, (void)public_id, (void)internal;
  if (b->result == VL_OK)
    stop(b, vl_camera_wrong_at(b->file, line_of(b), 1, "a document type (DOCTYPE, entities) is not taken"));
}

vlResult vl_camera_xml(const vlCameraFile *file, const char *text, size_t size, const char *const *wanted,
                       json_t **tree) {
  Builder b = {.file = file, .wanted = wanted, .result = VL_OK};
  *tree = NULL;
  b.parser = XML_ParserCreate(NULL);
  if (!b.parser) return vl_fail_memory(file->error);
  XML_SetUserData(b.parser, &b);
  XML_SetElementHandler(b.parser, on_start, on_end);
  XML_SetStartDoctypeDeclHandler(b.parser, on_document_type);
  XML_SetParamEntityParsing(b.parser, XML_PARAM_ENTITY_PARSING_NEVER);
  enum { STEP = 1 << 24 }; /* expat counts in int */
  enum XML_Status status = XML_STATUS_OK;
  for (size_t at = 0; status == XML_STATUS_OK && at < size; at += STEP) {
    size_t n = size - at < STEP ? size - at : STEP;
    status = XML_Parse(b.parser, text + at, (int)n, at + n == size);
  }
  if (status != XML_STATUS_OK && b.result == VL_OK) {
    enum XML_Error code = XML_GetErrorCode(b.parser);
    b.result = code == XML_ERROR_NO_MEMORY
                   ? vl_fail_memory(file->error)
                   : vl_camera_wrong_at(file, line_of(&b), (uint32_t)XML_GetCurrentColumnNumber(b.parser) + 1,
                                        "not XML: %s", XML_ErrorString(code));
  }
  XML_ParserFree(b.parser);
  if (b.result == VL_OK)
    *tree = b.open[0];
  else
    json_decref(b.open[0]);
  return b.result;
}
