/* camera_files/image_size.c: the image size for files that have none. It is the size that the
 * caller gives, or that of an image beside the file, read from the first bytes of a PNG or
 * JPEG. */
#include <stdio.h>

#include "base/bytes.h"
#include "base/text.h"
#include "camera_files/fields.h"

/* Skips the segments of a JPEG up to the frame header, which holds the size. */
static bool jpeg_size(FILE *file, uint32_t size[2]) {
  unsigned char b[8];
  if (fseek(file, 2, SEEK_SET) != 0)
    return false;
  for (int segments = 0; segments < 1000; segments++) {
    if (fread(b, 1, 4, file) != 4 || b[0] != 0xff)
      return false;
    uint32_t length = (uint32_t)vl_big(b + 2, 2);
    bool frame = b[1] >= 0xc0 && b[1] <= 0xcf && b[1] != 0xc4 && b[1] != 0xc8 && b[1] != 0xcc;
    if (length < 2)
      return false;
    if (frame) {
      if (fread(b, 1, 5, file) != 5)
        return false;
      size[0] = (uint32_t)vl_big(b + 3, 2);
      size[1] = (uint32_t)vl_big(b + 1, 2);
      return true;
    }
    if (fseek(file, (long)length - 2, SEEK_CUR) != 0)
      return false;
  }
  return false;
}

static bool size_of(vlContext *context, const char *path, uint32_t size[2]) {
  unsigned char b[24];
  FILE *file = fopen(path, "rb");
  if (!file)
    return false;
  bool found = false;
  if (fread(b, 1, sizeof b, file) == sizeof b) {
    if (memcmp(b, "\x89PNG\r\n\x1a\n", 8) == 0) {
      size[0] = (uint32_t)vl_big(b + 16, 4);
      size[1] = (uint32_t)vl_big(b + 20, 4);
      found = true;
    } else if (b[0] == 0xff && b[1] == 0xd8) {
      found = jpeg_size(file, size);
    }
  }
  if (found)
    vl_note_input(context, path, VL_OUTPUT_PLAIN);
  fclose(file);
  return found && size[0] >= 1 && size[0] <= 1 << 24 && size[1] >= 1 && size[1] <= 1 << 24;
}

vlResult vl_camera_size_beside(const vlCameraFile *file, const char *const *images,
                               vlCameraRecord *record) {
  static const char *const suffixes[] = {"", ".png", ".jpg", ".jpeg", ".JPG", ".PNG"};
  vlCameraDef *d = &record->camera;
  if (file->def->width && file->def->height) {
    d->width = file->def->width;
    d->height = file->def->height;
    return VL_OK;
  }
  for (; images && *images; images++)
    for (size_t i = 0; i < VL_LENGTH(suffixes); i++) {
      char name[1024], path[4096];
      uint32_t size[2];
      int length = snprintf(name, sizeof name, "%s%s", *images, suffixes[i]);
      if (!**images || length < 0 || (size_t)length >= sizeof name)
        continue;
      if (!vl_path_join(file->path, name, path, sizeof path) ||
          !size_of(file->context, path, size))
        continue;
      d->width = size[0];
      d->height = size[1];
      return VL_OK;
    }
  return vl_camera_wrong(
      file, "%s: the file has no image size%s; give one: --size WIDTHxHEIGHT", file->dialect,
      images && *images ? " and its images are not there" : "");
}

vlResult vl_camera_size_of_image(const vlCameraFile *file, vlCameraRecord *record) {
  char image[300];
  const char *name = vl_file_name(file->path), *dot = strrchr(name, '.');
  snprintf(image, sizeof image, "%.*s", dot ? (int)(dot - name) : 0, name);
  return vl_camera_size_beside(file, (const char *const[]){image, NULL}, record);
}

vlResult vl_camera_sides(const vlCameraFile *file, const json_t *object, const char *width,
                         const char *height, vlCameraRecord *record) {
  if (!json_object_get(object, width) && !json_object_get(object, height))
    return vl_camera_size_beside(file, NULL, record);
  VL_TRY(vl_camera_side(file, object, width, &record->camera.width));
  return vl_camera_side(file, object, height, &record->camera.height);
}

vlResult vl_camera_side_pair(const vlCameraFile *file, const json_t *object, const char *key,
                             vlCameraRecord *record) {
  double size[2] = {0};
  VL_TRY(vl_camera_list(file, object, key, size, 2));
  if (vl_camera_set_sides(&record->camera, size))
    return VL_OK;
  return vl_camera_wrong_in(file, object, key, "%s: \"%s\" is %g x %g; it must be whole pixels",
                            file->dialect, key, size[0], size[1]);
}

vlResult vl_camera_size_pair(const vlCameraFile *file, const json_t *object, const char *key,
                             vlCameraRecord *record) {
  return vl_camera_has(object, key) ? vl_camera_side_pair(file, object, key, record)
                                    : vl_camera_size_beside(file, NULL, record);
}
