/* test/fuzz/fuzz_image.c: images: every codec, chosen by content: the header with its
 * attributes, the last channel alone, the whole image. */
#include "fuzz.h"

static void read_channel(vlContext *context, const char *path, const vlImage *header) {
  const uint32_t attributes = vl_image_attribute_count(header),
                 channels = vl_image_channels(header);
  vlAttribute attribute, found;
  for (uint32_t i = 0; i < attributes; i++)
    if (vl_image_attribute(header, i, &attribute) != VL_OK ||
        vl_image_find_attribute(header, attribute.name, &found) != VL_OK)
      abort();
  const char *name = channels ? vl_image_channel_name(header, channels - 1) : NULL;
  vlImage *image = NULL;
  if (name && vl_image_read_channels(context, path, &name, 1, &image, NULL) == VL_OK)
    vl_image_destroy(image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlImage *image = NULL;
  vlError error;
  const char *path = fuzz_file("input", data, size);
  if (vl_image_read_header(context, path, &image, &error) == VL_OK) {
    read_channel(context, path, image);
    vl_image_destroy(image);
  }
  if (vl_image_read(context, path, &image, &error) == VL_OK)
    vl_image_destroy(image);
  fuzz_end(context);
  return 0;
}
