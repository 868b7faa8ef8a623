/* test/fuzz/fuzz_camera_file.c: camera files of every dialect, chosen by content, and COLMAP's
 * lists, binary cameras and binary images. A camera that is read is made, written in some
 * dialect and read again; then all cameras of the file are read as a trajectory. */
#include "fuzz.h"
#include "velo/trajectory.h"

static void read_all(vlContext *context, const char *path, const vlCameraFileDef *def) {
  vlTrajectory *trajectory = NULL;
  vlError error;
  if (vl_trajectory_load(context, path, def, &trajectory, &error) == VL_OK)
    vl_trajectory_destroy(trajectory);
}

/* The input as the poses of a COLMAP model with one camera, number 1. */
static void read_poses(vlContext *context, bool binary, const uint8_t *data, size_t size) {
  static const char text[] = "1 PINHOLE 64 48 50 50 32 20\n";
  static const char bytes[] =
      "\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\100\0\0\0\0\0\0\0\60\0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\111\100\0\0\0\0\0\0\111\100\0\0\0\0\0\0\100\100\0\0\0\0\0\0\64\100";
  const vlCameraFileDef def = vl_default_camera_file_def();
  if (binary)
    fuzz_file("cameras.bin", (const uint8_t *)bytes, sizeof bytes - 1);
  else
    fuzz_file("cameras.txt", (const uint8_t *)text, sizeof text - 1);
  const char *path = fuzz_file(binary ? "images.bin" : "images.txt", data, size);
  read_all(context, path, &def);
  unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlCameraRecord record;
  vlCamera camera;
  vlError error;
  bool list = size > 0 && (data[0] == '1' || data[0] == '#') && !(size > 1 && data[1] == 'u');
  bool binary = size > 8 && data[0] && !data[1] && !data[7]; /* a small count in 8 bytes */
  const char *name = binary ? "cameras.bin"
                     : list ? "cameras.txt"
                            : "input",
             *path = fuzz_file(name, data, size);
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = 64;
  def.height = 48; /* for files without an image size; all other sizes are the file's */
  if (vl_camera_read(context, path, &def, &record, &error) == VL_OK &&
      vl_camera_make(&record.camera, &camera, NULL, &error) == VL_OK) {
    def.dialect = (vlCameraDialect)(1 + size % (VL_CAMERA_DIALECT_COUNT - 1));
    const char *copy = fuzz_file("written", data, 0);
    if (vl_camera_write(context, copy, &def, &record, &error) == VL_OK &&
        def.dialect != VL_CAMERA_DIALECT_PBRT && def.dialect != VL_CAMERA_DIALECT_COLMAP &&
        vl_camera_read(context, copy, &def, &record, &error) == VL_OK)
      vl_camera_make(&record.camera, &camera, NULL, &error);
  }
  def.dialect = VL_CAMERA_DIALECT_AUTO;
  read_all(context, fuzz_file(name, data, size), &def);
  if (binary || list)
    read_poses(context, binary, data, size);
  fuzz_end(context);
  return 0;
}
