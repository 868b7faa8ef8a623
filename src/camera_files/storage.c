/* camera_files/storage.c: converts OpenCV's FileStorage in XML, <opencv_storage>, to the same
 * tree as its YAML form. An element with children becomes an object, or a list if all children
 * are <_>. Text becomes a number, a list of numbers separated by blanks, or a string. An
 * element with type_id="opencv-matrix" becomes an object of rows, cols and data. XML with
 * another root is returned unchanged. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "base/text.h"
#include "camera_files/files.h"

/* Records the line and column of an element of vl_camera_xml. False: out of memory. */
static bool push_location(const vlCameraFile *file, const json_t *element) {
  return vl_camera_push_location(file,
                                 (uint32_t)json_number_value(json_object_get(element, "#")),
                                 (uint32_t)json_number_value(json_object_get(element, "|")));
}

static json_t *token(const char *text, size_t length) {
  char copy[64], *end;
  if (length >= 2 && text[0] == '"' && text[length - 1] == '"')
    return json_stringn(text + 1, length - 2);
  if (length < sizeof copy) {
    memcpy(copy, text, length);
    copy[length] = 0;
    double value = strtod(copy, &end);
    if (*end == 0 && end != copy && isfinite(value))
      return json_real(value);
  }
  return json_stringn(text, length);
}

/* The next word or quoted string; null at the end. */
static const char *next_token(const char **at, size_t *length) {
  while (isspace((unsigned char)**at))
    ++*at;
  const char *first = *at;
  if (!*first)
    return NULL;
  const char *quote = *first == '"' ? strchr(first + 1, '"') : NULL;
  if (quote)
    *at = quote + 1;
  else
    while (**at && !isspace((unsigned char)**at))
      ++*at;
  *length = (size_t)(*at - first);
  return first;
}

static json_t *value_of(const vlCameraFile *file, const json_t *element, const char *text) {
  size_t length = 0, first_length = 0;
  const char *first = next_token(&text, &first_length),
             *next = first ? next_token(&text, &length) : NULL;
  if (!first)
    return json_string("");
  json_t *value = token(first, first_length);
  if (!next)
    return value;
  json_t *list = json_array();
  bool failed = json_array_append_new(list, value) != 0 || !push_location(file, element);
  for (; next && !failed; next = next_token(&text, &length))
    failed =
        json_array_append_new(list, token(next, length)) != 0 || !push_location(file, element);
  if (!failed)
    return list;
  json_decref(list);
  return NULL;
}

static json_t *convert(const vlCameraFile *file, const json_t *element, int depth) {
  const json_t *children = json_object_get(element, "/"), *child;
  const char *text = vl_camera_text(element, "$");
  if (!push_location(file, element) || depth == 0)
    return NULL;
  if (json_array_size(children) == 0)
    return value_of(file, element, text ? text : "");
  bool list = true, failed = false;
  VL_EACH(child, children)
    list = list && vl_camera_has_tag(child, "_");
  json_t *value = list ? json_array() : json_object();
  VL_EACH(child, children) {
    if (failed)
      break;
    json_t *item = convert(file, child, depth - 1);
    if (list)
      failed = !item || json_array_append_new(value, item) != 0;
    else
      failed = !item || json_object_set_new(value, vl_camera_text(child, "<"), item) != 0;
  }
  if (!failed)
    return value;
  json_decref(value);
  return NULL;
}

vlResult vl_camera_storage(const vlCameraFile *file, const char *text, size_t size,
                           json_t **tree) {
  json_t *root;
  *tree = NULL;
  vlResult result = vl_camera_xml(file, text, size, NULL, &root);
  if (result != VL_OK)
    return result;
  if (!vl_camera_has_tag(root, "opencv_storage")) {
    *tree = root; /* a file of another tool: the elements hold their own lines in the file */
    return VL_OK;
  }
  if (!(*tree = convert(file, root, 32)))
    result = vl_fail_memory(file->error);
  json_decref(root);
  return result;
}
