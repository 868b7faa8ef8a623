/* camera_files/npz.c: what np.savez(file, mtx=mtx, dist=dist) writes after OpenCV's
 * calibration: a ZIP archive with a member NAME.npy for each array (NumPy's documentation,
 * numpy.savez and numpy.lib.format; PKWARE's APPNOTE, 4.3). The arrays become the tree that
 * OpenCV's files have. Arrays of other meaning are refused by name. */
#include <stdio.h>
#include <zlib.h>

#include "base/text.h"
#include "camera_files/opencv.h"

enum { ENTRY = 46, LOCAL = 30, END = 22, MAX_NUMBERS = 64 };

/* What calibrations save beside the camera and what says nothing about it: errors, the poses
 * and corners of the boards, the matrix of undistorted images. */
static const char ignored[] =
    "ret rms error mean_error reprojection_error rvecs tvecs objpoints imgpoints newcameramtx "
    "newCameraMtx new_camera_matrix";

static uint32_t little_endian(const char *text, int bytes) {
  uint32_t value = 0;
  for (int i = bytes; i-- > 0;)
    value = value << 8 | (unsigned char)text[i];
  return value;
}

static double number_at(const char *at, bool whole, int bytes) {
  uint32_t low = little_endian(at, 4);
  uint64_t bits = bytes == 8 ? (uint64_t)little_endian(at + 4, 4) << 32 | low : low;
  float narrow;
  double value;
  memcpy(&narrow, &low, sizeof narrow);
  memcpy(&value, &bits, sizeof value);
  if (whole)
    return bytes == 8 ? (double)(int64_t)bits : (double)(int32_t)low;
  return bytes == 8 ? value : (double)narrow;
}

/* Reads an array of at most MAX_NUMBERS numbers by rows as a list; without dimensions, a
 * number. Null: it is another one. */
static json_t *read_array(const char *text, size_t size) {
  char header[272] = "";
  if (size < 10 || memcmp(text, "\x93NUMPY\1", 7) != 0)
    return NULL;
  size_t length = little_endian(text + 8, 2), left = size - 10;
  if (length >= 256 || length > left)
    return NULL;
  memcpy(header, text + 10, length);
  left -= length;
  const char *shape = strstr(header, "'shape': ("), *type = strstr(header, "'descr': '<");
  bool columns = strstr(header, "'fortran_order': True") != NULL;
  if (!shape || !type)
    return NULL;
  bool whole = type[11] == 'i';
  int bytes = type[12] == '8' ? 8 : 4;
  if ((!whole && type[11] != 'f') || (type[12] != '8' && type[12] != '4') || type[13] != '\'')
    return NULL;
  unsigned long sides[2] = {1, 1}, count = 1;
  int dimensions = 0;
  for (char *at = (char *)shape + 10, *end; *at != ')'; dimensions++) {
    unsigned long side = strtoul(at, &end, 10);
    if (end == at || side < 1 || side > MAX_NUMBERS || (count *= side) > MAX_NUMBERS)
      return NULL;
    if (dimensions < 2)
      sides[dimensions] = side;
    at = end + strspn(end, ", ");
  }
  if (count * (size_t)bytes > left || (columns && dimensions > 2))
    return NULL;
  json_t *list = json_array();
  for (unsigned long i = 0; i < count; i++) {
    unsigned long k = columns ? i % sides[1] * sides[0] + i / sides[1] : i;
    const char *at = text + 10 + length + k * (size_t)bytes;
    double value = number_at(at, whole, bytes);
    json_t *item = json_real(value); /* null if it is not finite */
    if (!item || (dimensions == 0 && list)) {
      json_decref(list);
      return item;
    }
    json_array_append_new(list, item);
  }
  return list;
}

/* Reads the member of an entry of the archive's directory into the tree. */
static vlResult read_member(const vlCameraFile *file, const char *text, size_t size,
                            const char *entry, json_t *tree) {
  char name[64];
  size_t length = little_endian(entry + 28, 2), bytes = little_endian(entry + 20, 4),
         at = little_endian(entry + 42, 4);
  snprintf(name, sizeof name, "%.*s", (int)(length < 60 ? length : 60), entry + ENTRY);
  if (vl_ends_with(name, ".npy"))
    name[strlen(name) - 4] = 0;
  if (vl_has_word(ignored, name))
    return VL_OK;
  if (strncmp(name, "arr_", 4) == 0)
    return vl_camera_wrong(file,
                           "npz: the arrays have no names: np.savez(file, mtx=..., "
                           "dist=...) gives them some");
  if (!vl_opencv_is_field(name))
    return vl_camera_wrong(
        file, "npz: \"%s\" is no field of OpenCV's cameras; there are mtx, dist, image_size",
        vl_short_text(name).text);
  if (little_endian(entry + 10, 2) != 0)
    return vl_camera_wrong(file, "npz: \"%s\" is compressed; np.savez writes it as it is",
                           name);
  if (at > size || size - at < LOCAL || memcmp(text + at, "PK\3\4", 4) != 0)
    return vl_camera_wrong(file, "npz: \"%s\" is cut off", name);
  at += LOCAL + little_endian(text + at + 26, 2) + little_endian(text + at + 28, 2);
  if (at > size || size - at < bytes)
    return vl_camera_wrong(file, "npz: \"%s\" is cut off", name);
  if (crc32_z(0, (const unsigned char *)text + at, bytes) != little_endian(entry + 16, 4))
    return vl_camera_wrong(file, "npz: \"%s\" is damaged: its CRC is another", name);
  json_t *value = read_array(text + at, bytes);
  if (!value)
    return vl_camera_wrong(
        file, "npz: \"%s\" must be an array of finite float64, float32 or whole numbers", name);
  const json_t *number;
  if (vl_opencv_is_lens(name) && json_array_size(value) == 4)
    VL_EACH(number, value)
      if (json_number_value(number) != 0.0) {
        json_decref(value);
        return vl_camera_wrong(
            file,
            "npz: \"%s\" holds 4 numbers, which may be those of a fisheye or k1 k2 p1 p2; for "
            "the latter add a 0, fisheyes need YAML with distortion_model: fisheye",
            name);
      }
  return json_object_set_new(tree, name, value) == 0 ? VL_OK : vl_fail_memory(file->error);
}

bool vl_npz_is(const char *text, size_t size) {
  return size > LOCAL + END && memcmp(text, "PK\3\4", 4) == 0 &&
         little_endian(text + 26, 2) > 4 && LOCAL + little_endian(text + 26, 2) < size &&
         memcmp(text + LOCAL + little_endian(text + 26, 2) - 4, ".npy", 4) == 0;
}

vlResult vl_npz_read(const vlCameraFile *file, const char *text, size_t size,
                     vlCameraRecord *record) {
  size_t end = size - END;
  while (end > 0 && memcmp(text + end, "PK\5\6", 4) != 0)
    end--;
  size_t at = end ? little_endian(text + end + 16, 4) : size;
  uint32_t count = end ? little_endian(text + end + 10, 2) : 0;
  json_t *tree = json_object();
  vlResult result = !tree       ? vl_fail_memory(file->error)
                    : count > 0 ? VL_OK
                                : vl_camera_wrong(file, "npz: the archive is cut off");
  for (uint32_t i = 0; i < count && result == VL_OK; i++) {
    size_t length = 0;
    bool there = at <= size && size - at >= ENTRY && memcmp(text + at, "PK\1\2", 4) == 0;
    if (there)
      length = ENTRY + little_endian(text + at + 28, 2) + little_endian(text + at + 30, 2) +
               little_endian(text + at + 32, 2);
    if (!there || size - at < length)
      result = vl_camera_wrong(file, "npz: the archive's directory is cut off");
    else
      result = read_member(file, text, size, text + at, tree);
    at += length;
  }
  if (result == VL_OK)
    result = vl_camera_read_opencv(file, tree, record);
  json_decref(tree);
  return result;
}
