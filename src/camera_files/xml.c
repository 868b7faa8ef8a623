/* camera_files/xml.c: parses XML with expat into a tree of JSON objects, one for each element.
 * The object has the element's attributes by name, and these members:
 *   "<"  its tag
 *   "#"  its line
 *   "|"  its column
 *   "/"  its child elements
 *   "$"  its text, if all elements are kept
 * A document type is an error, so a file cannot define entities. Depth and number of elements
 * are bounded. */
#include <expat.h>

#include "base/text.h"
#include "camera_files/files.h"

enum { MAX_DEPTH = 32, MAX_ELEMENTS = 2000000, MAX_WANTED = 20000 };

typedef struct {
  const vlCameraFile *file;
  XML_Parser parser;
  const char *const *wanted; /* see vl_camera_xml */
  VL_ARRAY(char) text;       /* of the innermost open element so far */
  json_t *open[MAX_DEPTH];   /* the open elements; each is owned by the one before it */
  int depth;                 /* number of open elements that are kept */
  int skipped;               /* number of open elements that are ignored */
  uint32_t elements;
  vlResult result;
} Builder;

static uint32_t line_of(const Builder *b) {
  return (uint32_t)XML_GetCurrentLineNumber(b->parser);
}

static uint32_t column_of(const Builder *b) {
  return (uint32_t)XML_GetCurrentColumnNumber(b->parser) + 1;
}

static void stop(Builder *b, vlResult result) {
  b->result = result;
  XML_StopParser(b->parser, XML_FALSE);
}

static bool is_among(const char *const *tags, const char *tag) {
  while (*tags && !vl_text_is(*tags, tag))
    tags++;
  return *tags != NULL;
}

static bool is_wanted(const Builder *b, const char *tag) {
  if (!b->wanted || b->depth != 1 || is_among(b->wanted, tag))
    return true;
  return is_among(b->wanted, json_string_value(json_object_get(b->open[0], "<")));
}

/* An element without children and text; null if out of memory. */
static json_t *new_element(const Builder *b, const char *tag, const char **attributes) {
  json_t *element = json_object();
  int failed = json_object_set_new(element, "<", json_string(tag));
  failed |= json_object_set_new(element, "#", json_real(line_of(b)));
  failed |= json_object_set_new(element, "|", json_real(column_of(b)));
  failed |= json_object_set_new(element, "/", json_array());
  for (; *attributes && !failed; attributes += 2)
    failed |= json_object_set_new(element, attributes[0], json_string(attributes[1]));
  if (!failed)
    return element;
  json_decref(element);
  return NULL;
}

static void on_start(void *data, const char *tag, const char **attributes) {
  Builder *b = data;
  if (b->result != VL_OK)
    return; /* expat may continue to the end of its buffer */
  if (b->skipped || !is_wanted(b, tag)) {
    b->skipped++;
    return;
  }
  const char *excess = NULL;
  if (b->depth == MAX_DEPTH)
    excess = "nested too deeply";
  else if (++b->elements > (b->wanted ? MAX_WANTED : MAX_ELEMENTS))
    excess = "too many elements";
  if (excess) {
    stop(b, vl_camera_wrong_at(b->file, line_of(b), column_of(b), "%s for a camera", excess));
    return;
  }
  b->text.count = 0;
  json_t *element = new_element(b, tag, attributes);
  bool kept = element != NULL;
  if (kept && b->depth > 0) /* the parent takes over the reference, even if this fails */
    kept = json_array_append_new(json_object_get(b->open[b->depth - 1], "/"), element) == 0;
  if (!kept) {
    stop(b, vl_fail_memory(b->file->error));
    return;
  }
  b->open[b->depth] = element;
  b->depth++;
}

static void on_end(void *data, VL_UNUSED const char *tag) {
  Builder *b = data;
  if (b->result != VL_OK)
    return;
  if (b->skipped) {
    b->skipped--;
    return;
  }
  if (!b->wanted && b->text.count) { /* the text of an element without children */
    json_t *text = json_stringn(b->text.items, b->text.count);
    if (json_object_set_new(b->open[b->depth - 1], "$", text ? text : json_string("")) != 0)
      stop(b, vl_fail_memory(b->file->error));
  }
  b->text.count = 0;
  if (b->depth > 1)
    b->depth--;
}

static void on_text(void *data, const char *text, int length) {
  Builder *b = data;
  if (b->result != VL_OK || b->wanted || b->skipped || length <= 0)
    return;
  if (!VL_RESERVE(b->file->context, &b->text, (size_t)length)) {
    stop(b, vl_fail_memory(b->file->error));
    return;
  }
  memcpy(b->text.items + b->text.count, text, (size_t)length);
  b->text.count += (size_t)length;
}

static void on_document_type(void *data, VL_UNUSED const char *name,
                             VL_UNUSED const char *system, VL_UNUSED const char *public_id,
                             VL_UNUSED int internal) {
  Builder *b = data;
  if (b->result == VL_OK)
    stop(b, vl_camera_wrong_at(b->file, line_of(b), 1,
                               "a document type (DOCTYPE, entities) is not taken"));
}

vlResult vl_camera_xml(const vlCameraFile *file, const char *text, size_t size,
                       const char *const *wanted, json_t **tree) {
  Builder b = {.file = file, .wanted = wanted, .result = VL_OK};
  *tree = NULL;
  b.parser = XML_ParserCreate(NULL);
  if (!b.parser)
    return vl_fail_memory(file->error);
  XML_SetUserData(b.parser, &b);
  XML_SetElementHandler(b.parser, on_start, on_end);
  XML_SetCharacterDataHandler(b.parser, on_text);
  XML_SetStartDoctypeDeclHandler(b.parser, on_document_type);
  XML_SetParamEntityParsing(b.parser, XML_PARAM_ENTITY_PARSING_NEVER);
  enum { STEP = 1 << 24 }; /* expat's sizes are int */
  enum XML_Status status = XML_STATUS_OK;
  for (size_t at = 0; status == XML_STATUS_OK && at < size; at += STEP) {
    size_t n = size - at < STEP ? size - at : STEP;
    status = XML_Parse(b.parser, text + at, (int)n, at + n == size);
  }
  enum XML_Error code = XML_GetErrorCode(b.parser);
  if (status != XML_STATUS_OK && b.result == VL_OK && code == XML_ERROR_NO_MEMORY)
    b.result = vl_fail_memory(file->error);
  else if (status != XML_STATUS_OK && b.result == VL_OK)
    b.result = vl_camera_wrong_at(file, line_of(&b), column_of(&b), "not XML: %s",
                                  XML_ErrorString(code));
  XML_ParserFree(b.parser);
  VL_ARRAY_FREE(file->context, &b.text);
  if (b.result == VL_OK)
    *tree = b.open[0];
  else
    json_decref(b.open[0]);
  return b.result;
}

bool vl_camera_xml_root(const char *text, char tag[64]) {
  for (;;) {
    const char *end = NULL;
    text += strspn(text, " \t\r\n");
    if (strncmp(text, "<?", 2) == 0)
      end = strstr(text, "?>");
    else if (strncmp(text, "<!--", 4) == 0)
      end = strstr(text, "-->");
    else
      break;
    if (!end)
      return false;
    text = end + (*end == '?' ? 2 : 3);
  }
  if (*text++ != '<')
    return false;
  size_t length = strcspn(text, " \t\r\n/>");
  if (length == 0 || length > 63)
    return false;
  memcpy(tag, text, length);
  tag[length] = 0;
  return true;
}

bool vl_camera_has_tag(const json_t *element, const char *tag) {
  return vl_text_is(vl_camera_text(element, "<"), tag);
}

const json_t *vl_camera_child(const json_t *element, const char *tag) {
  const json_t *child;
  VL_EACH_CHILD(child, element) {
    if (vl_camera_has_tag(child, tag))
      return child;
  }
  return NULL;
}

vlResult vl_camera_wrong_element(const vlCameraFile *file, const json_t *element,
                                 const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  return vl_camera_wrong_at(file, (uint32_t)json_number_value(json_object_get(element, "#")),
                            (uint32_t)json_number_value(json_object_get(element, "|")),
                            "%s: %s", file->dialect, message);
}

vlResult vl_camera_element_numbers(const vlCameraFile *file, const json_t *element,
                                   double *values, uint32_t count) {
  const char *text = vl_camera_text(element, "$"), *tag = vl_camera_text(element, "<");
  if (text && vl_camera_parse_all(text, values, count) == count)
    return VL_OK;
  return vl_camera_wrong_element(file, element, "<%s> must hold %u finite number%s",
                                 vl_short_text(tag).text, count, count == 1 ? "" : "s");
}

vlResult vl_camera_child_number(const vlCameraFile *file, const json_t *element,
                                const char *tag, bool needed, double *value) {
  const json_t *child = vl_camera_child(element, tag);
  if (child)
    return vl_camera_element_numbers(file, child, value, 1);
  if (!needed)
    return VL_OK;
  return vl_camera_wrong_element(file, element, "<%s> has no <%s>",
                                 vl_short_text(vl_camera_text(element, "<")).text, tag);
}
