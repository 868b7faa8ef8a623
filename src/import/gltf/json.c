/* import/gltf/json.c: errors that name a location in the JSON; typed members. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

vlGltf *vl_gltf_of(const vlGltfLocation *location) {
  while (location->up)
    location = location->up;
  return location->g;
}

size_t vl_gltf_write_location(const vlGltfLocation *location, char *text, size_t size) {
  if (!location->up)
    return 0;
  size_t n = vl_gltf_write_location(location->up, text, size);
  if (n + 1 >= size)
    return n;
  int wrote = location->index == VL_GLTF_NONE
                  ? snprintf(text + n, size - n, "%s%.60s", n ? "." : "", location->key)
                  : snprintf(text + n, size - n, "%s%.60s[%zu]", n ? "." : "", location->key,
                             location->index);
  return wrote < 0 ? n : n + (size_t)wrote < size ? n + (size_t)wrote : size - 1;
}

const json_t *vl_gltf_json(const vlGltfLocation *at) {
  static const char within[] = "extensions.";
  if (!at->up)
    return at->g->root;
  const json_t *value = vl_gltf_json(at->up);
  const char *key = at->key;
  if (strncmp(key, within, sizeof within - 1) == 0) {
    value = json_object_get(value, "extensions");
    key += sizeof within - 1;
  }
  value = json_object_get(value, key);
  return at->index == VL_GLTF_NONE ? value : json_array_get(value, at->index);
}

enum { MESSAGE = 512 };

static void write_message(const vlGltfLocation *location, const char *text,
                          char message[MESSAGE]) {
  size_t n = vl_gltf_write_location(location, message, MESSAGE);
  snprintf(message + n, MESSAGE - n, "%s%s", n ? ": " : "", text);
}

bool vl_gltf_fail_code(vlResult code, const vlGltfLocation *location, const char *format, ...) {
  const vlGltf *g = vl_gltf_of(location);
  char text[MESSAGE], message[MESSAGE];
  VL_FORMAT(text, format);
  write_message(location, text, message);
  return vl_scene_fail(g->scene, code, (vlSource){g->path, 0, 0}, "%s", message);
}

bool vl_gltf_fail(const vlGltfLocation *location, const char *format, ...) {
  char text[MESSAGE];
  VL_FORMAT(text, format);
  return vl_gltf_fail_code(VL_ERROR_SCENE, location, "%s", text);
}

bool vl_gltf_fail_key(const vlGltfLocation *at, const char *key, const char *format, ...) {
  char text[MESSAGE];
  VL_FORMAT(text, format);
  return vl_gltf_fail(VL_GLTF_KEY(at, key), "%s", text);
}

static void warn(vlLogLevel level, vlResult code, const vlGltfLocation *location,
                 const char *text) {
  const vlGltf *g = vl_gltf_of(location);
  char message[MESSAGE];
  write_message(location, text, message);
  vlError where;
  vl_fail_at(&where, code, g->path, 0, 0, " ");
  vl_log(g->context, level, &where, "%s", message);
}

void vl_gltf_warn(vlLogLevel level, const vlGltfLocation *location, const char *format, ...) {
  char text[MESSAGE];
  VL_FORMAT(text, format);
  warn(level, VL_ERROR_SCENE, location, text);
}

void vl_gltf_warn_missing(const vlGltfLocation *location, const char *format, ...) {
  char text[MESSAGE];
  VL_FORMAT(text, format);
  warn(VL_LOG_WARNING, VL_ERROR_MISSING, location, text);
}

bool vl_gltf_once(vlGltf *g, uint32_t bit) {
  bool first = !(g->reported & bit);
  g->reported |= bit;
  return first;
}

/* ---- members ----------------------------------------------------------------------------- */

static const char *kind_of(const json_t *value) {
  switch (json_typeof(value)) {
    case JSON_OBJECT:
      return "an object";
    case JSON_ARRAY:
      return "an array";
    case JSON_STRING:
      return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
      return "a number";
    case JSON_NULL:
      return "null";
    case JSON_TRUE:
    case JSON_FALSE:
      return "true or false";
  }
  return "nothing";
}

static bool wrong_kind(const vlGltfLocation *at, const char *key, const char *wanted,
                       const json_t *found) {
  return vl_gltf_fail_key(at, key, "must be %s, found %s", wanted, kind_of(found));
}

/* Looks up a member of this kind. *value is null if it is not there. Returns false after an
 * error. */
static bool member(const vlGltfLocation *at, const char *key, const char *wanted,
                   const json_t **value) {
  *value = json_object_get(vl_gltf_json(at), key);
  if (!*value || vl_text_is(kind_of(*value), wanted))
    return true;
  wrong_kind(at, key, wanted, *value);
  *value = NULL;
  return false;
}

static bool in_range(const vlGltfLocation *at, double value) {
  return fabs(value) <= 3e38 || vl_gltf_fail(at, "%g is out of range", value);
}

bool vl_gltf_number(const vlGltfLocation *at, const char *key, double *value) {
  const json_t *v;
  if (!member(at, key, "a number", &v))
    return false;
  if (v)
    *value = json_number_value(v);
  return !v || in_range(VL_GLTF_KEY(at, key), *value);
}

bool vl_gltf_float(const vlGltfLocation *at, const char *key, float *value) {
  double x = *value;
  bool ok = vl_gltf_number(at, key, &x);
  *value = (float)x;
  return ok;
}

bool vl_gltf_numbers(const vlGltfLocation *at, const char *key, size_t count, double *values) {
  const json_t *v;
  if (!member(at, key, "an array", &v))
    return false;
  if (v && json_array_size(v) != count)
    return vl_gltf_fail_key(at, key, "must hold %zu numbers, found %zu", count,
                            json_array_size(v));
  for (size_t i = 0; v && i < count; i++) {
    const json_t *x = json_array_get(v, i);
    const vlGltfLocation *here = VL_GLTF_ITEM(at, key, i);
    if (!json_is_number(x))
      return vl_gltf_fail(here, "must be a number, found %s", kind_of(x));
    values[i] = json_number_value(x);
    if (!in_range(here, values[i]))
      return false;
  }
  return true;
}

bool vl_gltf_bool(const vlGltfLocation *at, const char *key, bool *value) {
  const json_t *v;
  const bool ok = member(at, key, "true or false", &v);
  if (v)
    *value = json_is_true(v);
  return ok;
}

bool vl_gltf_text(const vlGltfLocation *at, const char *key, const char **value) {
  const json_t *v;
  const bool ok = member(at, key, "a string", &v);
  if (v)
    *value = json_string_value(v);
  return ok;
}

bool vl_gltf_choice(const vlGltfLocation *at, const char *key, const char *const *names,
                    int count, int *value) {
  const char *text = names[*value];
  if (!vl_gltf_text(at, key, &text))
    return false;
  char list[160] = "";
  for (int i = 0; i < count; i++) {
    if (vl_text_is(text, names[i])) {
      *value = i;
      return true;
    }
    vl_list_name(list, sizeof list, names[i]);
  }
  return vl_gltf_fail_key(at, key, "unknown name \"%s\" (known%s)", vl_short_text(text).text,
                          list);
}

static bool whole(const vlGltfLocation *at, const char *key, const json_t *v, size_t *value) {
  if (!json_is_number(v))
    return wrong_kind(at, key, "a whole number", v);
  double x = json_number_value(v); /* some exporters write integers as 3.0 */
  if (!(x >= 0 && x <= 9007199254740992.0) || x != floor(x))
    return vl_gltf_fail_key(at, key, "must be a whole number from 0 on, found %.17g", x);
  *value = (size_t)x;
  return true;
}

bool vl_gltf_size_in(const vlGltfLocation *at, const json_t *object, const char *key,
                     size_t *value) {
  const json_t *v = json_object_get(object, key);
  return !v || whole(at, key, v, value);
}

bool vl_gltf_size(const vlGltfLocation *at, const char *key, size_t *value) {
  return vl_gltf_size_in(at, vl_gltf_json(at), key, value);
}

bool vl_gltf_index_in(const vlGltfLocation *at, const json_t *object, const char *key,
                      size_t limit, size_t *index) {
  *index = VL_GLTF_NONE;
  if (!vl_gltf_size_in(at, object, key, index))
    return false;
  if (*index == VL_GLTF_NONE || *index < limit)
    return true;
  return limit ? vl_gltf_fail_key(at, key, "%zu: there are only %zu (0 to %zu)", *index, limit,
                                  limit - 1)
               : vl_gltf_fail_key(at, key, "%zu: there are none", *index);
}

bool vl_gltf_index(const vlGltfLocation *at, const char *key, size_t limit, size_t *index) {
  return vl_gltf_index_in(at, vl_gltf_json(at), key, limit, index);
}

bool vl_gltf_need_index(const vlGltfLocation *at, const char *key, size_t limit,
                        size_t *index) {
  if (!vl_gltf_index(at, key, limit, index))
    return false;
  return *index != VL_GLTF_NONE || vl_gltf_fail(at, "\"%s\" is missing", key);
}

size_t vl_gltf_peek(const json_t *object, const char *key, size_t limit) {
  const json_t *value = json_object_get(object, key);
  const double index = json_number_value(value);
  return json_is_number(value) && index >= 0 && index < (double)limit ? (size_t)index
                                                                      : VL_GLTF_NONE;
}

const json_t *vl_gltf_peek_positions(const vlGltf *g, const json_t *primitive) {
  return vl_gltf_item(
      g, "accessors",
      vl_gltf_peek(json_object_get(primitive, "attributes"), "POSITION", g->accessor_count));
}

bool vl_gltf_element(const vlGltfLocation *at, const json_t *value, size_t limit,
                     const char *what, size_t *index) {
  const double x = json_number_value(value);
  if (!json_is_number(value) || !(x >= 0 && x < (double)limit) || x != floor(x))
    return vl_gltf_fail(at, "there is no such %s", what);
  *index = (size_t)x;
  return true;
}

bool vl_gltf_object(const vlGltfLocation *at, const char *key, const json_t **value) {
  return member(at, key, "an object", value);
}

bool vl_gltf_array(const vlGltfLocation *at, const char *key, const json_t **value,
                   size_t *count) {
  const bool ok = member(at, key, "an array", value);
  *count = json_array_size(*value);
  return ok;
}

const json_t *vl_gltf_extension(const json_t *object, const char *name) {
  const json_t *found = json_object_get(json_object_get(object, "extensions"), name);
  return json_is_object(found) ? found : NULL;
}

const json_t *vl_gltf_item(const vlGltf *g, const char *array, size_t index) {
  return json_array_get(json_object_get(g->root, array), index);
}
