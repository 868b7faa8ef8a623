/* test/fuzz/fuzz_raw.c: raw files: read, developed to every step, and written again where they
 * can be. */
#include "fuzz.h"

static void develop(const vlRaw *raw) {
  vlRawDevelopDef def = vl_default_raw_develop_def();
  for (int step = VL_RAW_STEP_BLACK; step <= VL_RAW_STEP_TONE; step++) {
    vlImage *image = NULL;
    def.stop_at = (vlRawStep)step;
    if (vl_raw_develop(raw, &def, &image, NULL) == VL_OK)
      vl_image_destroy(image);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlRaw *raw = NULL;
  vlError error;
  const char *path = fuzz_file("input.dng", data, size);
  if (vl_raw_read(context, path, &raw, &error) == VL_OK) {
    char output[200];
    vlRaw *back = NULL;
    snprintf(output, sizeof output, "%.180s.again.dng", path);
    develop(raw);
    /* what was read is a raw image: it can be written, and read again */
    if (vl_raw_write(raw, output, &error) != VL_OK ||
        vl_raw_read(context, output, &back, &error) != VL_OK)
      abort();
    vl_raw_destroy(back);
    unlink(output);
  }
  vl_raw_destroy(raw);
  fuzz_end(context);
  return 0;
}
