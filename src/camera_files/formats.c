/* camera_files/formats.c: the table of camera file formats (dialects). Each dialect's own file
 * defines its row. */
#include "camera_files/formats.h"
#include "base/text.h"

#define FORMAT(dialect, format) [dialect] = &format,
const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT] = {
    VL_CAMERA_FORMATS(FORMAT)};

#define DIALECT(dialect, format) dialect,
static const vlCameraDialect order[] = {VL_CAMERA_FORMATS(DIALECT)};

static bool has_marks(const vlCameraFormat *format, const json_t *tree) {
  const json_t *object = format->marks_in ? json_object_get(tree, format->marks_in) : tree;
  if (format->marks_in && json_is_array(object))
    object = json_array_get(object, 0);
  size_t count = 0, found = 0, length;
  for (const char *at = format->marks; at && *at; at += length + strspn(at + length, " ")) {
    length = strcspn(at, " ");
    found += json_object_getn(object, at, length) != NULL;
    count++;
  }
  return format->one_mark ? found > 0 : count > 0 && found == count;
}

vlCameraDialect vl_camera_dialect_of_tree(const json_t *tree) {
  for (size_t i = 0; i < VL_LENGTH(order); i++) {
    const vlCameraFormat *format = vl_camera_formats[order[i]];
    if (format->is_tree ? format->is_tree(tree) : has_marks(format, tree))
      return order[i];
  }
  return VL_CAMERA_DIALECT_AUTO;
}

vlCameraDialect vl_camera_dialect_of_text(const char *text, size_t size) {
  for (int i = 1; i < VL_CAMERA_DIALECT_COUNT; i++)
    if (vl_camera_formats[i]->is_text && vl_camera_formats[i]->is_text(text, size))
      return (vlCameraDialect)i;
  return VL_CAMERA_DIALECT_AUTO;
}
