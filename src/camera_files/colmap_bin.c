/* camera_files/colmap_bin.c: COLMAP's binary model, cameras.bin and images.bin: little-endian
 * records with the same numbers as the text form. The reader converts them to the text form
 * with 17 digits, which keeps all bits. */
#include "camera_files/colmap.h"

#include "base/bytes.h"
#include "base/file.h"
#include "base/text.h"

/* COLMAP's camera models, indexed by number, with their counts of parameters. */
static const struct {
  const char *name;
  uint32_t parameters;
} models[] = {{"SIMPLE_PINHOLE", 3},
              {"PINHOLE", 4},
              {"SIMPLE_RADIAL", 4},
              {"RADIAL", 5},
              {"OPENCV", 8},
              {"OPENCV_FISHEYE", 8},
              {"FULL_OPENCV", 12},
              {"FOV", 5},
              {"SIMPLE_RADIAL_FISHEYE", 4},
              {"RADIAL_FISHEYE", 5},
              {"THIN_PRISM_FISHEYE", 12},
              {"RAD_TAN_THIN_PRISM_FISHEYE", 16},
              {"SIMPLE_DIVISION", 4},
              {"DIVISION", 5},
              {"SIMPLE_FISHEYE", 3},
              {"FISHEYE", 4},
              {"EUCM", 6},
              {"EQUIRECTANGULAR", 2}};
enum { MODELS = VL_LENGTH(models) };

typedef struct {
  const unsigned char *at, *end;
  bool cut; /* the file ends in the middle of a record */
} Bytes;

static uint64_t whole(Bytes *bytes, uint32_t count) {
  if ((size_t)(bytes->end - bytes->at) < count) {
    bytes->cut = true;
    return 0;
  }
  bytes->at += count;
  return vl_little(bytes->at - count, count);
}

static double real(Bytes *bytes) {
  uint64_t bits = whole(bytes, 8);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static vlResult put_cameras(const vlCameraFile *file, const char *path, Bytes *bytes,
                            vlCameraText *text) {
  uint64_t count = whole(bytes, 8);
  for (uint64_t i = 0; i < count && !bytes->cut && !text->failed; i++) {
    uint32_t id = (uint32_t)whole(bytes, 4), model = (uint32_t)whole(bytes, 4);
    unsigned long long width = whole(bytes, 8), height = whole(bytes, 8);
    if (!bytes->cut && model >= MODELS)
      return vl_fail_at(file->error, VL_ERROR_SCENE, path, 0, 0,
                        "colmap: camera %u has model %u, which is none of velo", id, model);
    if (bytes->cut)
      break;
    vl_camera_put(text, "%u %s %llu %llu", id, models[model].name, width, height);
    for (uint32_t k = 0; k < models[model].parameters; k++)
      vl_camera_put(text, " %.17g", real(bytes));
    vl_camera_put(text, "\n");
  }
  return VL_OK;
}

static vlResult put_images(Bytes *bytes, vlCameraText *text) {
  uint64_t count = whole(bytes, 8);
  for (uint64_t i = 0; i < count && !bytes->cut && !text->failed; i++) {
    vl_camera_put(text, "%u", (uint32_t)whole(bytes, 4));
    for (int k = 0; k < 7; k++)
      vl_camera_put(text, " %.17g", real(bytes));
    vl_camera_put(text, " %u ", (uint32_t)whole(bytes, 4));
    const unsigned char *name = bytes->at, *stop = memchr(name, 0, (size_t)(bytes->end - name));
    if (!stop || bytes->cut) {
      bytes->cut = true;
      break;
    }
    for (; name < stop; name++)
      vl_camera_put(text, "%c", *name == '\n' || *name == '\r' ? ' ' : *name);
    bytes->at = stop + 1;
    vl_camera_put(text, "\n\n"); /* the empty line is the image's line of points */
    uint64_t points = whole(bytes, 8);
    if (points > (uint64_t)(bytes->end - bytes->at) / 24)
      bytes->cut = true;
    else
      bytes->at += 24 * points;
  }
  return VL_OK;
}

vlResult vl_colmap_load(const vlCameraFile *file, const char *path, char **text, size_t *size) {
  char *data;
  size_t length;
  vlResult result = vl_file_read_given(file->context, path, false, &data, &length, file->error);
  if (result != VL_OK || !vl_ends_with(path, ".bin")) {
    *text = result == VL_OK ? data : NULL;
    *size = result == VL_OK ? length : 0;
    return result;
  }
  Bytes bytes = {.at = (const unsigned char *)data,
                 .end = (const unsigned char *)data + length};
  vlCameraText lines = {.context = file->context};
  vl_camera_put(&lines, "# from %s\n", "the binary form");
  result = vl_ends_with(path, "images.bin") ? put_images(&bytes, &lines)
                                            : put_cameras(file, path, &bytes, &lines);
  vl_free(file->context, data);
  if (result == VL_OK && lines.failed)
    result = vl_fail_memory(file->error);
  if (result == VL_OK && (bytes.cut || bytes.at != bytes.end))
    result = vl_fail_at(file->error, VL_ERROR_SCENE, path, 0, 0,
                        bytes.cut ? "colmap: the file is cut off, or no binary model"
                                  : "colmap: the file goes on after its last record");
  if (result != VL_OK) {
    VL_ARRAY_FREE(file->context, &lines.text);
    *text = NULL;
    *size = 0;
    return result;
  }
  *text = lines.text.items;
  *size = lines.text.count;
  return VL_OK;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void put_whole(vlCameraText *text, uint64_t value, uint32_t count) {
  char bytes[8];
  for (uint32_t i = 0; i < count; i++)
    bytes[i] = (char)(value >> (8 * i) & 255);
  vl_camera_put_bytes(text, bytes, count);
}

static void put_real(vlCameraText *text, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  put_whole(text, bits, 8);
}

void vl_colmap_put_bin(vlCameraText *cameras, vlCameraText *images,
                       const vlColmapRecord *record) {
  uint32_t model = 0;
  while (model < MODELS && !vl_text_is(models[model].name, record->model))
    model++;
  put_whole(cameras, 1, 8);
  put_whole(cameras, 1, 4);
  put_whole(cameras, model, 4);
  put_whole(cameras, record->width, 8);
  put_whole(cameras, record->height, 8);
  for (uint32_t i = 0; i < record->count; i++)
    put_real(cameras, record->parameters[i] + 0.0);
  put_whole(images, 1, 8);
  put_whole(images, 1, 4);
  for (int i = 0; i < 4; i++)
    put_real(images, record->quaternion[i] + 0.0);
  for (int i = 0; i < 3; i++)
    put_real(images, record->translation[i] + 0.0);
  put_whole(images, 1, 4);
  vl_camera_put_bytes(images, record->name, strlen(record->name) + 1);
  put_whole(images, 0, 8);
}
