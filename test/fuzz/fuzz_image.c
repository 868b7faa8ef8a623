/* Images: every codec, chosen by content. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlImage *image = NULL;
  vlError error;
  if (vl_image_read(context, fuzz_file("input", data, size), &image, &error) == VL_OK) vl_image_destroy(image);
  fuzz_end(context);
  return 0;
}
