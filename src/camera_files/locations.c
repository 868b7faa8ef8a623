/* camera_files/locations.c: the line and column of each value of a tree. The parsers record the
 * positions in the tree's order, with each value before the values that it contains. A lookup
 * counts the values before the wanted one. */

#include "base/text.h"
#include "camera_files/files.h"

bool vl_camera_push_location(const vlCameraFile *file, uint32_t line, uint32_t column) {
  if (!file->locations)
    return true;
  uint64_t *location = VL_PUSH(file->context, &file->locations->at);
  if (location)
    *location = (uint64_t)line << 32 | column;
  return location != NULL;
}

void vl_camera_locations_free(vlCameraFile *file) {
  if (!file->locations)
    return;
  VL_ARRAY_FREE(file->context, &file->locations->at);
  file->locations = NULL;
}

/* Counts the values before the wanted one. Returns true when it is found. */
static bool count_to(const json_t *node, const json_t *wanted, size_t *index) {
  if (node == wanted)
    return true;
  ++*index;
  const char *key;
  json_t *child;
  if (json_is_object(node)) {
    json_object_foreach((json_t *)node, key,
                        child) if (count_to(child, wanted, index)) return true;
  } else {
    VL_EACH(child, node)
      if (count_to(child, wanted, index))
        return true;
  }
  return false;
}

/* The index of object[key], or of the object. true, false and null are the same value
 * everywhere, so the values of an object are counted by their keys. */
static size_t index_of(const vlCameraLocations *locations, const json_t *object,
                       const char *key) {
  size_t index = 0;
  if (!count_to(locations->root, object, &index))
    return SIZE_MAX;
  if (!key || !json_object_get(object, key))
    return index;
  const char *other;
  json_t *child;
  size_t inner = index + 1;
  json_object_foreach((json_t *)object, other, child) {
    if (vl_text_is(other, key))
      return inner;
    count_to(child, NULL, &inner);
  }
  return index;
}

/* As line << 32 | column; 0 if it is unknown. */
static uint64_t location_of(const vlCameraFile *file, const json_t *object, const char *key) {
  size_t index = file->locations && object ? index_of(file->locations, object, key) : SIZE_MAX;
  return file->locations && index < file->locations->at.count ? file->locations->at.items[index]
                                                              : 0;
}

uint32_t vl_camera_line(const vlCameraFile *file, const json_t *object, const char *key) {
  return (uint32_t)(location_of(file, object, key) >> 32);
}

vlResult vl_camera_wrong_in(const vlCameraFile *file, const json_t *object, const char *key,
                            const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  uint64_t location = location_of(file, object, key);
  return vl_fail_at(file->error, VL_ERROR_SCENE, file->path, (uint32_t)(location >> 32),
                    (uint32_t)location, "%s", message);
}

/* The first object of the tree that has this key. */
static const json_t *holder_of(const json_t *node, const char *key) {
  const char *other;
  json_t *child;
  const json_t *found = NULL;
  if (json_object_get(node, key))
    return node;
  if (json_is_object(node)) {
    json_object_foreach((json_t *)node, other, child) if (!found) found = holder_of(child, key);
  } else {
    VL_EACH(child, node)
      if (!found)
        found = holder_of(child, key);
  }
  return found;
}

void vl_camera_locate_error(const vlCameraFile *file) {
  vlError *error = file->error;
  if (!error || error->line || !file->locations || !file->locations->at.count ||
      !vl_text_is(error->file, file->path))
    return;
  const json_t *root = file->locations->root, *holder = NULL;
  char key[64];
  const char *quote = strchr(error->message, '"'), *end = quote ? strchr(quote + 1, '"') : NULL;
  if (end && end - quote - 1 < (long)sizeof key) {
    memcpy(key, quote + 1, (size_t)(end - quote - 1));
    key[end - quote - 1] = 0;
    holder = holder_of(root, key);
  }
  size_t index = holder ? index_of(file->locations, holder, key) : 0;
  uint64_t location = index < file->locations->at.count ? file->locations->at.items[index] : 0;
  error->line = (uint32_t)(location >> 32);
  error->column = (uint32_t)location;
}
