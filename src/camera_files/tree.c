/* camera_files/tree.c: reads values from a file's tree, with errors that name the field;
 * collects text for writing. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/bytes.h"
#include "base/json.h"
#include "base/text.h"
#include "camera_files/files.h"

vlResult vl_camera_wrong(const vlCameraFile *file, const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  return vl_fail_at(file->error, VL_ERROR_SCENE, file->path, 0, 0, "%s", message);
}

vlResult vl_camera_cannot_hold(const vlCameraFile *file, const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  return vl_fail_at(file->error, VL_ERROR_UNSUPPORTED, file->path, 0, 0, "%s cannot hold %s",
                    file->dialect, message);
}

vlResult vl_camera_wrong_at(const vlCameraFile *file, uint32_t line, uint32_t column,
                            const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  return vl_fail_at(file->error, VL_ERROR_SCENE, file->path, line, column, "%s", message);
}

/* Records the positions of the values of a valid JSON text. The position of a value is its
 * first character; keys have none. */
static bool locate_json(const vlCameraFile *file, const char *text, size_t size) {
  const char *end = text + size, *line_start = text;
  uint32_t line = 1;
  for (const char *at = text; at < end && *at;) {
    const char *first = at;
    if (*at == '\n') {
      line++;
      line_start = at + 1;
    }
    if (strchr(" \t\r\n,:]}", *at)) {
      at++;
      continue;
    }
    if (*at == '"') {
      for (at++; at < end && *at != '"'; at++)
        at += *at == '\\';
      at++;
      const char *next = at < end ? at + strspn(at, " \t\r\n") : at;
      if (next < end && *next == ':')
        continue; /* a key */
    } else if (*at == '[' || *at == '{') {
      at++;
    } else {
      at += strcspn(at, " \t\r\n,:]}");
    }
    if (!vl_camera_push_location(file, line, (uint32_t)(first - line_start) + 1))
      return false;
  }
  return true;
}

static vlResult parse_json(const vlCameraFile *file, const char *text, size_t size,
                           json_t **tree) {
  json_error_t location;
  *tree =
      vl_json_parse(text, size, JSON_DECODE_INT_AS_REAL | JSON_REJECT_DUPLICATES, &location);
  if (!*tree && vl_json_lacks_memory(&location))
    return vl_fail_memory(file->error);
  if (!*tree)
    return vl_fail_at(file->error, VL_ERROR_SCENE, file->path,
                      location.line > 0 ? (uint32_t)location.line : 0,
                      location.column > 0 ? (uint32_t)location.column : 0, "not JSON: %.*s%s",
                      (int)vl_json_problem_length(location.text), location.text,
                      json_error_code(&location) == json_error_end_of_input_expected
                          ? "; of a recording with a value in each line, give one line"
                          : "");
  return locate_json(file, text, size) ? VL_OK : vl_fail_memory(file->error);
}

vlResult vl_camera_tree(const vlCameraFile *file, const char *text, size_t size,
                        json_t **tree) {
  size_t first = strspn(text, " \t\r\n");
  vlResult result;
  *tree = NULL;
  /* .glb: a header of 12 bytes, then a JSON chunk, which consists of its length, "JSON" and the
   * text */
  if (size >= 20 && memcmp(text, "glTF", 4) == 0 && memcmp(text + 16, "JSON", 4) == 0) {
    const size_t length = vl_little32(text + 12);
    if (length > size - 20)
      return vl_camera_wrong(file, "not glTF: the file is cut off");
    text += 20;
    size = length;
    first = 0;
  }
  if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) { /* byte order mark */
    text += 3;
    size -= 3;
    first = strspn(text, " \t\r\n");
  }
  if (first >= size)
    return vl_camera_wrong(file, "the file is empty");
  bool list = text[first] == '[';
  if (list && !vl_camera_push_location(file, 1, 1))
    return vl_fail_memory(file->error);
  if (text[first] == '{' || list)
    result = parse_json(file, text, size, tree);
  else if (text[first] == '<')
    result = vl_camera_storage(file, text, size, tree);
  else
    result = vl_camera_yaml(file, text, size, tree);
  if (result == VL_OK && list) {
    json_t *wrapped = json_object();
    if (json_object_set_new(wrapped, "[]", *tree) != 0)
      result = vl_fail_memory(file->error);
    *tree = wrapped;
  } else if (result == VL_OK && !json_is_object(*tree)) {
    result = vl_camera_wrong(file, "no camera file: it holds no named fields");
  }
  if (result != VL_OK) {
    json_decref(*tree);
    *tree = NULL;
  } else if (file->locations) {
    file->locations->root = *tree;
  }
  return result;
}

bool vl_camera_has(const json_t *object, const char *key) {
  return json_object_get(object, key) != NULL;
}

bool vl_camera_has_in(const json_t *object, const char *key, const char *inner) {
  const json_t *value = json_object_get(object, key);
  if (json_is_array(value))
    value = json_array_get(value, 0);
  return json_object_get(value, inner) != NULL;
}

vlResult vl_camera_field(const vlCameraFile *file, const json_t *object, const char *key,
                         const json_t **value) {
  *value = json_object_get(object, key);
  if (*value)
    return VL_OK;
  const char *names[64], *other;
  size_t count = 0;
  json_t *unused;
  json_object_foreach((json_t *)object, other, unused) if (count < 64) names[count++] = other;
  const char *near = vl_nearest_name(key, names, count);
  return vl_camera_wrong_in(file, object, NULL, "%s: the field \"%s\" is missing%s%.60s%s",
                            file->dialect, key, near ? "; did you mean it by \"" : "",
                            near ? near : "", near ? "\"?" : "");
}

vlResult vl_camera_word(const vlCameraFile *file, const json_t *object, const char *key,
                        const char **text) {
  const json_t *value;
  vlResult result = vl_camera_field(file, object, key, &value);
  *text = json_string_value(value);
  return result;
}

double vl_camera_parse(const char *text, char **end) {
  const char *first = text + strspn(text, " \t\r\n,;");
  double value = strtod(first, end);
  if (*end == first)
    *end = (char *)text;
  return value;
}

uint32_t vl_camera_parse_all(const char *text, double *values, uint32_t max) {
  for (uint32_t count = 0; count <= max; count++) {
    char *end;
    const double value = vl_camera_parse(text, &end);
    if (end == text)
      return text[strspn(text, " \t\r\n,;")] ? max + 1 : count;
    if (!isfinite(value))
      break;
    if (count < max)
      values[count] = value;
    text = end;
  }
  return max + 1;
}

/* Reads a number at object[key], or in a list of lists there. */
static vlResult number_of(const vlCameraFile *file, const json_t *object, const json_t *value,
                          const char *key, double *number) {
  bool own = json_is_string(value) || json_is_array(value) || json_is_object(value);
  if (json_is_number(value)) {
    *number = json_number_value(value);
    return VL_OK;
  }
  if (json_is_string(value))
    return vl_camera_wrong_in(file, value, NULL,
                              "%s: \"%s\" holds \"%s\", which is no finite number",
                              file->dialect, key, vl_short_text(json_string_value(value)).text);
  return vl_camera_wrong_in(file, own ? value : object, own ? NULL : key,
                            "%s: \"%s\" must be a number", file->dialect, key);
}

vlResult vl_camera_number(const vlCameraFile *file, const json_t *object, const char *key,
                          double *value) {
  const json_t *field;
  VL_TRY(vl_camera_field(file, object, key, &field));
  return number_of(file, object, field, key, value);
}

vlResult vl_camera_optional(const vlCameraFile *file, const json_t *object, const char *key,
                            double *value) {
  const json_t *field = json_object_get(object, key);
  return field ? number_of(file, object, field, key, value) : VL_OK;
}

vlGiven vl_json_given(const json_t *item) {
  if (json_is_null(item))
    return (vlGiven){.kind = VL_GIVEN_NOTHING};
  if (json_is_boolean(item))
    return (vlGiven){.kind = VL_GIVEN_FLAG, .number = json_is_true(item)};
  if (json_is_number(item))
    return (vlGiven){.kind = VL_GIVEN_NUMBER, .number = json_number_value(item)};
  if (json_is_string(item))
    return (vlGiven){.kind = VL_GIVEN_TEXT, .text = json_string_value(item)};
  return (vlGiven){.kind = VL_GIVEN_OTHER};
}

vlResult vl_camera_side(const vlCameraFile *file, const json_t *object, const char *key,
                        uint32_t *value) {
  const json_t *field;
  double number;
  VL_TRY(vl_camera_field(file, object, key, &field));
  const vlGiven given = vl_json_given(field);
  char name[120];
  char message[VL_GIVEN_MESSAGE];
  snprintf(name, sizeof name, "%s: \"%s\"", file->dialect, key);
  if (!vl_given_check(vl_setting(VL_SETTING_CAMERA, "width"), name, &given, &number, message))
    return vl_camera_wrong_in(file, object, key, "%s", message);
  *value = (uint32_t)number;
  return VL_OK;
}

vlResult vl_camera_size(const vlCameraFile *file, double aspect, vlCameraRecord *record) {
  const vlCameraFileDef *def = file->def;
  double width = def->width, height = def->height;
  record->size_assumed = !def->width || !def->height;
  if (record->size_assumed) {
    height = 720.0;
    width = floor(720.0 * aspect + 0.5);
  }
  if (!(width >= 1.0 && width <= 1 << 24))
    return vl_camera_wrong(file, "%s: an aspect ratio of %g gives no image", file->dialect,
                           aspect);
  record->camera.width = (uint32_t)width;
  record->camera.height = (uint32_t)height;
  return VL_OK;
}

/* Appends the numbers of a list; nested lists to a depth of two. */
static vlResult collect(const vlCameraFile *file, const json_t *list, const char *key,
                        int depth, double *values, uint32_t max, uint32_t *count) {
  json_t *item;
  VL_EACH(item, list) {
    if (json_is_array(item) && depth > 0) {
      VL_TRY(collect(file, item, key, depth - 1, values, max, count));
    } else {
      if (*count == max)
        return vl_camera_wrong_in(file, list, NULL, "%s: \"%s\" holds more than %u numbers",
                                  file->dialect, key, max);
      VL_TRY(number_of(file, list, item, key, &values[*count]));
      ++*count;
    }
  }
  return VL_OK;
}

vlResult vl_camera_numbers(const vlCameraFile *file, const json_t *object, const char *key,
                           double *values, uint32_t min, uint32_t max, uint32_t *count) {
  const json_t *field;
  VL_TRY(vl_camera_field(file, object, key, &field));
  return vl_camera_numbers_of(file, object, key, field, values, min, max, count);
}

vlResult vl_camera_numbers_of(const vlCameraFile *file, const json_t *object, const char *key,
                              const json_t *field, double *values, uint32_t min, uint32_t max,
                              uint32_t *count) {
  uint32_t found = 0;
  double rows = VL_UNSET, columns = VL_UNSET;
  if (json_is_object(field)) {
    VL_TRY(vl_camera_number(file, field, "rows", &rows));
    VL_TRY(vl_camera_number(file, field, "cols", &columns));
    field = json_object_get(field, "data");
  }
  if (!json_is_array(field))
    return vl_camera_wrong_in(file, object, key, "%s: \"%s\" must be a list of numbers",
                              file->dialect, key);
  VL_TRY(collect(file, field, key, 1, values, max, &found));
  if (found < min)
    return vl_camera_wrong_in(file, object, key, "%s: \"%s\" holds %u numbers; it must hold %u",
                              file->dialect, key, found, min);
  if (!vl_is_unset(rows) && rows * columns != found)
    return vl_camera_wrong_in(file, object, key, "%s: \"%s\" says %g x %g and holds %u numbers",
                              file->dialect, key, rows, columns, found);
  if (count)
    *count = found;
  return VL_OK;
}

vlResult vl_camera_list(const vlCameraFile *file, const json_t *object, const char *key,
                        double *values, uint32_t count) {
  return vl_camera_numbers(file, object, key, values, count, count, NULL);
}

const char *vl_camera_text(const json_t *object, const char *key) {
  return json_string_value(json_object_get(object, key));
}

const void *vl_camera_row(const void *rows, size_t count, size_t size, const char *name) {
  for (const char *row = rows; count > 0; row += size, count--)
    if (vl_text_is(name, *(const char *const *)(const void *)row))
      return row;
  return NULL;
}

bool vl_camera_is_frame(const vlCameraFile *file, uint32_t index, const char *name) {
  const char *wish = file->def->frame;
  char number[16];
  if (file->looked)
    *file->looked = true;
  if (file->ordinal)
    return index == *file->ordinal;
  if (!wish)
    return index == 0;
  if (name && vl_text_is(wish, name))
    return true;
  snprintf(number, sizeof number, "%u", index);
  return vl_text_is(wish, number);
}

bool vl_camera_count(const vlCameraFile *file, bool taken, const char *name,
                     vlCameraRecord *record) {
  const uint32_t index = record->frames++;
  return !taken && vl_camera_is_frame(file, index, name);
}

void vl_camera_name(vlCameraRecord *record, const char *name) {
  snprintf(record->name, sizeof record->name, "%s", name ? name : "");
}

vlArgumentText vl_camera_asked(const vlCameraFile *file, const char *otherwise) {
  return vl_argument_text(file->def->frame ? file->def->frame : otherwise);
}

vlResult vl_camera_no_frame(const vlCameraFile *file, const char *what,
                            const vlCameraRecord *record) {
  return vl_camera_wrong(file, "%s: there is no %s \"%s\" among the %u", file->dialect, what,
                         vl_camera_asked(file, "0").text, record->frames);
}

vlResult vl_camera_set_k(const vlCameraFile *file, const json_t *object, const char *key,
                         const double k[9], vlCameraDef *def) {
  if (!vl_camera_set_intrinsics(def, k, true))
    return vl_camera_wrong_in(
        file, object, key, "%s: \"%s\" must be fx skew cx, 0 fy cy, 0 0 1", file->dialect, key);
  return VL_OK;
}

void vl_camera_put(vlCameraText *text, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(NULL, 0, format, list);
  va_end(list);
  if (text->failed || n < 0 || !VL_RESERVE(text->context, &text->text, (size_t)n + 1)) {
    text->failed = true;
    return;
  }
  va_start(list, format);
  vsnprintf(text->text.items + text->text.count, (size_t)n + 1, format, list);
  va_end(list);
  text->text.count += (size_t)n;
}

void vl_camera_put_bytes(vlCameraText *text, const char *bytes, size_t count) {
  text->failed = text->failed || !VL_RESERVE(text->context, &text->text, count + 1);
  if (text->failed)
    return;
  memcpy(text->text.items + text->text.count, bytes, count);
  text->text.count += count;
  text->text.items[text->text.count] = 0;
}

void vl_camera_put_text(vlCameraText *text, const vlCameraText *other) {
  text->failed = text->failed || other->failed;
  if (!text->failed && other->text.count)
    vl_camera_put(text, "%.*s", (int)other->text.count, other->text.items);
}

void vl_camera_put_string(vlCameraText *text, const char *string) {
  vl_camera_put(text, "\"");
  for (const char *s = string; *s; s++) {
    if (*s == '"' || *s == '\\')
      vl_camera_put(text, "\\%c", *s);
    else if ((unsigned char)*s < 0x20 || *s == 0x7f)
      vl_camera_put(text, "\\u%04x", (unsigned char)*s);
    else
      vl_camera_put(text, "%c", *s);
  }
  vl_camera_put(text, "\"");
}
