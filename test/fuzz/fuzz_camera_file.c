/* Camera files of every dialect, chosen by content, and COLMAP's lists and binary cameras. A camera that is read is
 * made, written in some dialect and read again. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlCameraRecord record;
  vlCamera camera;
  vlError error;
  bool list = size > 0 && (data[0] == '1' || data[0] == '#') && !(size > 1 && data[1] == 'u');
  bool binary = size > 8 && data[0] && !data[1] && !data[7]; /* a small count in 8 bytes */
  const char *path = fuzz_file(binary ? "cameras.bin" : list ? "cameras.txt" : "input", data, size);
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = 64, def.height = 48; /* for files without an image size; all other sizes are the file's */
  if (vl_camera_read(context, path, &def, &record, &error) == VL_OK &&
      vl_camera_make(&record.camera, &camera, NULL, &error) == VL_OK) {
    def.dialect = (vlCameraDialect)(1 + size % (VL_CAMERA_DIALECT_COUNT - 1));
    const char *copy = fuzz_file("written", data, 0);
    if (vl_camera_write(context, copy, &def, &record, &error) == VL_OK && def.dialect != VL_CAMERA_DIALECT_PBRT &&
        def.dialect != VL_CAMERA_DIALECT_COLMAP && vl_camera_read(context, copy, &def, &record, &error) == VL_OK)
      vl_camera_make(&record.camera, &camera, NULL, &error);
  }
  fuzz_end(context);
  return 0;
}
