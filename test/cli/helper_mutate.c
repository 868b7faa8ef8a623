/* test/cli/helper_mutate.c: changes one channel of an OpenEXR file slightly and leaves all
 * others and the header unchanged: `velo image check` must notice it. Usage: helper_mutate IN
 * OUT CHANNEL FACTOR. Floats are multiplied by FACTOR, integers increased by 1. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "velo/image.h"

enum { MAX_CHANNELS = 256 };

static int fail(const char *what) {
  fprintf(stderr, "helper_mutate: %s\n", what);
  return 2;
}

/* Whole numbers get 1 more. */
static void change(vlImage *image, int channel, float factor) {
  const char *name = vl_image_channel_name(image, (uint32_t)channel);
  bool whole = strncmp(name, "id.", 3) == 0 || strncmp(name, "samples", 7) == 0 ||
               strstr(name, ".hidden");
  size_t pixels = (size_t)vl_image_width(image) * vl_image_height(image),
         step = vl_image_channels(image);
  for (size_t i = 0; i < pixels; i++) {
    if (vl_image_type(image) == VL_PIXEL_U32)
      ((uint32_t *)vl_image_pixels(image))[i * step + (size_t)channel]++;
    else if (whole)
      ((float *)vl_image_pixels(image))[i * step + (size_t)channel] += 1.0f;
    else
      ((float *)vl_image_pixels(image))[i * step + (size_t)channel] *= factor;
  }
}

int main(int argc, char **argv) {
  if (argc != 5)
    return fail("IN OUT CHANNEL FACTOR");
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlImage *all, *parts[2] = {NULL, NULL};
  if (vl_context_create(&def, &context) != VL_OK)
    return fail("no context");
  if (vl_image_read(context, argv[1], &all, NULL) != VL_OK)
    return fail("cannot read");
  const vlPixelType types[2] = {VL_PIXEL_F32, VL_PIXEL_U32};
  bool found = false;
  for (int k = 0; k < 2; k++) {
    const char *names[MAX_CHANNELS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < vl_image_channels(all) && count < MAX_CHANNELS; i++)
      if (vl_image_stored_type(all, i) == types[k])
        names[count++] = vl_image_channel_name(all, i);
    if (count == 0)
      continue;
    if (vl_image_read_channels(context, argv[1], names, count, &parts[k], NULL) != VL_OK)
      return fail("cannot read");
    int channel = vl_image_find_channel(parts[k], argv[3]);
    if (channel >= 0)
      change(parts[k], channel, strtof(argv[4], NULL));
    found = found || channel >= 0;
  }
  if (!found)
    return fail("no such channel");
  if (!parts[0])
    return fail("no floats");
  const vlImage *const layers[2] = {parts[0], parts[1]};
  if (vl_image_write_layers(layers, parts[1] ? 2 : 1, argv[2], NULL, NULL) != VL_OK)
    return fail("cannot write");
  vl_image_destroy(all);
  for (int k = 0; k < 2; k++)
    vl_image_destroy(parts[k]);
  vl_context_destroy(context);
  return 0;
}
