/* render/channels_form.c: ids and counts in a form that other programs display
 * (docs/ground-truth.md, "In other programs"): the channel's name ends in one letter, and
 * values are 32-bit floats, which are exact below 2^24. */
#include <stdio.h>

#include "cli/report.h"
#include "render/channels.h"

enum { MOST_CHANNELS = 16, MOST_EXACT = 1 << 24 };

/* A new image with the same channel names and floats instead of integers. */
static vlResult as_floats(vlContext *context, const vlImage *ids, vlImage **floats) {
  const char *names[MOST_CHANNELS];
  uint32_t count = vl_image_channels(ids);
  if (count > MOST_CHANNELS)
    return VL_ERROR_ARGUMENT;
  for (uint32_t i = 0; i < count; i++)
    names[i] = vl_image_channel_name(ids, i);
  vlImageDef def = vl_default_image_def(vl_image_width(ids), vl_image_height(ids), count);
  def.names = names;
  def.type = VL_PIXEL_F32;
  vlResult result = vl_image_create(context, &def, floats);
  size_t values = (size_t)def.width * def.height * count;
  const uint32_t *from = vl_image_const_pixels(ids);
  float *to = result == VL_OK ? vl_image_pixels(*floats) : NULL;
  for (size_t i = 0; to && i < values; i++)
    to[i] = (float)from[i];
  for (uint32_t i = 0; i < vl_image_attribute_count(ids) && result == VL_OK; i++) {
    vlAttribute attribute;
    result = vl_image_attribute(ids, i, &attribute);
    if (result == VL_OK)
      result = vl_image_set_attribute(*floats, &attribute);
  }
  return result;
}

static vlResult name_channels(vlImage *ids) {
  vlResult result = VL_OK;
  for (uint32_t i = 0; i < vl_image_channels(ids) && result == VL_OK; i++) {
    char name[64];
    snprintf(name, sizeof name, "%s.Y", vl_image_channel_name(ids, i));
    result = vl_image_rename_channel(ids, i, name);
  }
  return result;
}

vlResult channels_make_visible(vlContext *context, vlImage **ids) {
  if (!*ids)
    return VL_OK;
  vlResult result = name_channels(*ids);
  size_t values =
      (size_t)vl_image_width(*ids) * vl_image_height(*ids) * vl_image_channels(*ids);
  const uint32_t *value = vl_image_const_pixels(*ids);
  for (size_t i = 0; i < values; i++)
    if (value[i] >= MOST_EXACT) {
      report_note(
          "ids of 2^24 and more are written as integers, which not every program shows");
      return result;
    }
  vlImage *floats = NULL;
  if (result == VL_OK)
    result = as_floats(context, *ids, &floats);
  if (result != VL_OK) {
    vl_image_destroy(floats);
    return result;
  }
  vl_image_destroy(*ids);
  *ids = floats;
  return VL_OK;
}
