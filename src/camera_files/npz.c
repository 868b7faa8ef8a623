/* camera_files/npz.c: what np.savez(file, mtx=mtx, dist=dist) writes after OpenCV's
 * calibration: a ZIP archive with a member NAME.npy for each array (NumPy's documentation,
 * numpy.savez and numpy.lib.format; PKWARE's APPNOTE, 4.3). The arrays become the tree that
 * OpenCV's files have. Arrays of other meaning are refused by name. */
#include <stdio.h>
#include <zlib.h>

#include "base/bytes.h"
#include "base/text.h"
#include "camera_files/numpy.h"
#include "camera_files/opencv.h"

enum { ENTRY = 46, LOCAL = 30, END = 22, MAX_NUMBERS = 64 };

/* What calibrations save beside the camera and what says nothing about it: errors, the poses
 * and corners of the boards, the matrix of undistorted images. */
static const char ignored[] =
    "ret rms error mean_error reprojection_error rvecs tvecs objpoints imgpoints newcameramtx "
    "newCameraMtx new_camera_matrix";

/* Reads an array of at most MAX_NUMBERS numbers by rows as a list; without dimensions, a
 * number. Null: it is another one. */
static json_t *read_array(const char *text, size_t size) {
  vlNumpyArray array;
  if (!vl_numpy_open(text, size, &array) || array.count > MAX_NUMBERS)
    return NULL;
  if (array.dimensions == 0)
    return json_real(vl_numpy_at(&array, 0));
  json_t *list = json_array();
  for (size_t i = 0; i < array.count; i++) {
    json_t *item = json_real(vl_numpy_at(&array, i)); /* null if it is not finite */
    if (!item) {
      json_decref(list);
      return NULL;
    }
    json_array_append_new(list, item);
  }
  return list;
}

/* Reads the member of an entry of the archive's directory into the tree. */
static vlResult read_member(const vlCameraFile *file, const char *text, size_t size,
                            const char *entry, json_t *tree) {
  char name[64];
  size_t length = vl_little(entry + 28, 2), bytes = vl_little(entry + 20, 4),
         at = vl_little(entry + 42, 4);
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
  if (vl_little(entry + 10, 2) != 0)
    return vl_camera_wrong(file, "npz: \"%s\" is compressed; np.savez writes it as it is",
                           name);
  if (at > size || size - at < LOCAL || memcmp(text + at, "PK\3\4", 4) != 0)
    return vl_camera_wrong(file, "npz: \"%s\" is cut off", name);
  at += LOCAL + vl_little(text + at + 26, 2) + vl_little(text + at + 28, 2);
  if (at > size || size - at < bytes)
    return vl_camera_wrong(file, "npz: \"%s\" is cut off", name);
  if (crc32_z(0, (const unsigned char *)text + at, bytes) != vl_little(entry + 16, 4))
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
  return size > LOCAL + END && memcmp(text, "PK\3\4", 4) == 0 && vl_little(text + 26, 2) > 4 &&
         LOCAL + vl_little(text + 26, 2) < size &&
         memcmp(text + LOCAL + vl_little(text + 26, 2) - 4, ".npy", 4) == 0;
}

vlResult vl_npz_read(const vlCameraFile *file, const char *text, size_t size,
                     vlCameraRecord *record) {
  size_t end = size - END;
  while (end > 0 && memcmp(text + end, "PK\5\6", 4) != 0)
    end--;
  size_t at = end ? vl_little(text + end + 16, 4) : size;
  uint32_t count = end ? (uint32_t)vl_little(text + end + 10, 2) : 0;
  json_t *tree = json_object();
  vlResult result = !tree       ? vl_fail_memory(file->error)
                    : count > 0 ? VL_OK
                                : vl_camera_wrong(file, "npz: the archive is cut off");
  for (uint32_t i = 0; i < count && result == VL_OK; i++) {
    size_t length = 0;
    bool there = at <= size && size - at >= ENTRY && memcmp(text + at, "PK\1\2", 4) == 0;
    if (there)
      length = ENTRY + vl_little(text + at + 28, 2) + vl_little(text + at + 30, 2) +
               vl_little(text + at + 32, 2);
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
