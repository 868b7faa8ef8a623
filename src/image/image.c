/* image/image.c: creation of images, their attributes, and access to their values. */
#include "image/image.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/cookie.h"
#include "base/free.h"
#include "base/text.h"
#include "color/color.h"
#include "image/pixel.h"

/* Limits of OpenEXR: the length of long names, and the corners of windows, pixels. */
enum { NAME_MAX_LENGTH = 255, MAX_WINDOW = INT32_MAX / 2 - 1 };

size_t vl_pixel_size(vlPixelType type) {
  return type == VL_PIXEL_U8 ? 1 : type == VL_PIXEL_U16 || type == VL_PIXEL_F16 ? 2 : 4;
}

vlImageDef vl_default_image_def(uint32_t width, uint32_t height, uint32_t channels) {
  return (vlImageDef){.cookie = VL_COOKIE_IMAGE,
                      .width = width,
                      .height = height,
                      .channels = channels,
                      .type = VL_PIXEL_F32,
                      .encoding = VL_ENCODING_LINEAR,
                      .gamma = 1.0f};
}

static const char *const DEFAULT_NAMES[4][4] = {
    {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};

static bool name_ok(const char *name) {
  return name && name[0] && strlen(name) <= NAME_MAX_LENGTH;
}

static int compare_names(const void *a, const void *b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Copies the names into one block (pointers first) and rejects duplicates. */
static vlResult copy_names(vlContext *context, const char *const *names, uint32_t count,
                           char ***result) {
  size_t text = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (!name_ok(names[i]))
      return VL_ERROR_ARGUMENT;
    text += strlen(names[i]) + 1;
  }
  char **copy = vl_alloc(context, count * sizeof *copy + text);
  if (!copy)
    return VL_ERROR_MEMORY;
  char *at = (char *)(copy + count);
  if (count > 1) {
    memcpy(copy, names, count * sizeof *copy);
    qsort(copy, count, sizeof *copy, compare_names);
    for (uint32_t i = 1; i < count; i++) {
      if (vl_text_is(copy[i - 1], copy[i])) {
        vl_free(context, copy);
        return VL_ERROR_ARGUMENT;
      }
    }
  }
  for (uint32_t i = 0; i < count; i++) {
    size_t size = strlen(names[i]) + 1;
    memcpy(at, names[i], size);
    copy[i] = at;
    at += size;
  }
  *result = copy;
  return VL_OK;
}

vlResult vl_image_create(vlContext *context, const vlImageDef *def, vlImage **image) {
  return vl_image_create_parts(context, def, true, image);
}

vlResult vl_image_create_parts(vlContext *context, const vlImageDef *def, bool pixels,
                               vlImage **image) {
  if (!image)
    return VL_ERROR_ARGUMENT;
  *image = NULL;
  if (!context || !def || def->cookie != VL_COOKIE_IMAGE || def->width == 0 || def->height == 0)
    return VL_ERROR_ARGUMENT;
  if (def->channels == 0 || def->channels > 1024 || (!def->names && def->channels > 4))
    return VL_ERROR_ARGUMENT;
  if ((unsigned)def->type > VL_PIXEL_U32 || (unsigned)def->encoding > VL_ENCODING_GAMMA)
    return VL_ERROR_ARGUMENT;
  if (def->encoding == VL_ENCODING_GAMMA && !(def->gamma > 0.0f && def->gamma < 100.0f))
    return VL_ERROR_ARGUMENT;
  /* at most 2^32 * 2^10 * 2^2 */
  size_t row = (size_t)def->width * def->channels * vl_pixel_size(def->type);
  if (row > SIZE_MAX / 4 / def->height)
    return VL_ERROR_MEMORY;

  vlImage *made = vl_alloc_zero(context, 1, sizeof *made);
  if (!made)
    return VL_ERROR_MEMORY;
  made->context = context;
  made->number = vl_context_number(context);
  made->width = def->width;
  made->height = def->height;
  made->channels = def->channels;
  made->type = def->type;
  bool integer = def->type == VL_PIXEL_U8 || def->type == VL_PIXEL_U16;
  made->encoding = integer ? def->encoding : VL_ENCODING_LINEAR;
  made->gamma = made->encoding == VL_ENCODING_GAMMA ? def->gamma : 1.0f;
  const char *const *names = def->names ? def->names : DEFAULT_NAMES[def->channels - 1];
  vlResult result = copy_names(context, names, def->channels, &made->names);
  if (result == VL_OK && pixels) {
    made->pixels = def->unset ? vl_alloc_array(context, row, def->height)
                              : vl_alloc_zero(context, row, def->height);
    if (!made->pixels)
      result = VL_ERROR_MEMORY;
  }
  if (result != VL_OK) {
    vl_image_destroy(made);
    return result;
  }
  *image = made;
  return VL_OK;
}

void vl_image_destroy(vlImage *image) {
  if (!image)
    return;
  vlContext *context = image->context;
  for (size_t i = 0; i < image->attributes.count; i++) {
    VL_FREE(context, image->attributes.items[i].name, image->attributes.items[i].string);
  }
  VL_ARRAY_FREE(context, &image->attributes);
  VL_FREE(context, image->names, image->pixels, image->stored, image);
}

uint32_t vl_image_width(const vlImage *image) {
  return image->width;
}
uint32_t vl_image_height(const vlImage *image) {
  return image->height;
}
uint32_t vl_image_channels(const vlImage *image) {
  return image->channels;
}
vlPixelType vl_image_type(const vlImage *image) {
  return image->type;
}
vlPixelType vl_image_stored_type(const vlImage *image, uint32_t channel) {
  return image->stored && channel < image->channels ? (vlPixelType)image->stored[channel]
                                                    : image->type;
}
vlEncoding vl_image_encoding(const vlImage *image) {
  return image->encoding;
}
const char *vl_image_channel_name(const vlImage *image, uint32_t channel) {
  return channel < image->channels ? image->names[channel] : NULL;
}
void *vl_image_pixels(vlImage *image) {
  return image->pixels;
}
const void *vl_image_const_pixels(const vlImage *image) {
  return image->pixels;
}

int vl_image_find_channel(const vlImage *image, const char *name) {
  for (uint32_t i = 0; name && i < image->channels; i++)
    if (vl_text_is(image->names[i], name))
      return (int)i;
  return -1;
}

/* The first layer that has R, G and B ("diffuse.R"). */
static bool find_layer(const vlImage *image, uint32_t channel[4]) {
  for (uint32_t i = 0; i < image->channels; i++) {
    const char *name = image->names[i], *dot = strrchr(name, '.');
    if (!vl_text_is(dot, ".R"))
      continue;
    bool all = true;
    for (int c = 0; c < 3; c++) {
      char full[NAME_MAX_LENGTH + 1];
      snprintf(full, sizeof full, "%.*s.%c", (int)(dot - name), name, "RGB"[c]);
      int found = vl_image_find_channel(image, full);
      all = all && found >= 0;
      channel[c] = found >= 0 ? (uint32_t)found : 0;
    }
    if (all)
      return true;
  }
  return false;
}

uint32_t vl_image_shown(const vlImage *image, uint32_t channel[4]) {
  uint32_t count = vl_image_color(image, channel);
  if (count)
    return count;
  if (find_layer(image, channel))
    return 3;
  channel[0] = 0;
  return 1;
}

uint32_t vl_image_color(const vlImage *image, uint32_t channel[4]) {
  int r = vl_image_find_channel(image, "R"), g = vl_image_find_channel(image, "G"),
      b = vl_image_find_channel(image, "B");
  int a = vl_image_find_channel(image, "A"), y = vl_image_find_channel(image, "Y");
  uint32_t count = 0;
  if (r >= 0 && g >= 0 && b >= 0) {
    channel[0] = (uint32_t)r;
    channel[1] = (uint32_t)g;
    channel[2] = (uint32_t)b;
    count = 3;
  } else if (y >= 0 || image->channels == 1) {
    channel[0] = y >= 0 ? (uint32_t)y : 0;
    count = 1;
    if (image->channels == 1)
      return count;
  }
  if (count && a >= 0)
    channel[count++] = (uint32_t)a;
  return count;
}

/* ---- values as light --------------------------------------------------------------------- */

size_t vl_image_row_size(const vlImage *image) {
  return (size_t)image->width * image->channels * vl_pixel_size(image->type);
}
void *vl_image_row(vlImage *image, uint32_t y) {
  return (char *)image->pixels + vl_image_row_size(image) * y;
}
const void *vl_image_const_row(const vlImage *image, uint32_t y) {
  return (const char *)image->pixels + vl_image_row_size(image) * y;
}

bool vl_is_alpha(const char *name) {
  size_t n = strlen(name);
  return name[n - 1] == 'A' && (n == 1 || name[n - 2] == '.');
}

static vlEncoding channel_encoding(const vlImage *image, uint32_t channel) {
  return image->encoding != VL_ENCODING_LINEAR && vl_is_alpha(image->names[channel])
             ? VL_ENCODING_LINEAR
             : image->encoding;
}

static float value_at(const vlImage *image, size_t index, vlEncoding encoding) {
  switch (image->type) {
    case VL_PIXEL_U8: {
      uint8_t v = ((const uint8_t *)image->pixels)[index];
      return encoding == VL_ENCODING_SRGB ? vl_srgb8_to_linear[v]
                                          : (float)vl_decode(encoding, image->gamma, v / 255.0);
    }
    case VL_PIXEL_U16:
      return (float)vl_decode(encoding, image->gamma,
                              ((const uint16_t *)image->pixels)[index] / 65535.0);
    case VL_PIXEL_F16:
      return vl_half_to_float(((const uint16_t *)image->pixels)[index]);
    case VL_PIXEL_U32:
      return (float)((const uint32_t *)image->pixels)[index];
    case VL_PIXEL_F32:
      break;
  }
  return ((const float *)image->pixels)[index];
}

vlResult vl_image_rename_channel(vlImage *image, uint32_t channel, const char *name) {
  if (!image || channel >= image->channels || !name_ok(name))
    return VL_ERROR_ARGUMENT;
  int found = vl_image_find_channel(image, name);
  if (found >= 0)
    return (uint32_t)found == channel ? VL_OK : VL_ERROR_ARGUMENT;
  char **names, *before = image->names[channel];
  /* the string is owned by the image like the other names */
  image->names[channel] = (char *)name;
  vlResult result =
      copy_names(image->context, (const char *const *)image->names, image->channels, &names);
  if (result == VL_OK) {
    vl_free(image->context, image->names);
    image->names = names;
  } else {
    image->names[channel] = before;
  }
  return result;
}

float vl_image_get(const vlImage *image, uint32_t x, uint32_t y, uint32_t channel) {
  if (x >= image->width || y >= image->height || channel >= image->channels)
    return 0.0f;
  return value_at(image, ((size_t)y * image->width + x) * image->channels + channel,
                  channel_encoding(image, channel));
}

static void row_8bit(const vlImage *image, uint32_t y, const uint32_t *channel, uint32_t count,
                     float *result) {
  const uint8_t *row = vl_image_const_row(image, y);
  float table[256];
  for (uint32_t c = 0; c < count; c++) {
    vl_decode_table(channel_encoding(image, channel[c]), image->gamma, table);
    const uint8_t *from = row + channel[c];
    for (uint32_t x = 0; x < image->width; x++)
      result[(size_t)x * count + c] = table[from[(size_t)x * image->channels]];
  }
}

void vl_image_row_to_float(const vlImage *image, uint32_t y, const uint32_t *channel,
                           uint32_t count, float *result) {
  if (image->type == VL_PIXEL_U8 && image->encoding != VL_ENCODING_GAMMA) {
    row_8bit(image, y, channel, count, result);
    return;
  }
  size_t at = (size_t)y * image->width * image->channels;
  for (uint32_t c = 0; c < count; c++) {
    vlEncoding encoding = channel_encoding(image, channel[c]);
    for (uint32_t x = 0; x < image->width; x++)
      result[(size_t)x * count + c] =
          value_at(image, at + (size_t)x * image->channels + channel[c], encoding);
  }
}

vlResult vl_image_to_float(const vlImage *image, const uint32_t *channel, uint32_t count,
                           float **result) {
  size_t row = (size_t)image->width * count;
  *result = vl_alloc_array(image->context, row * image->height, sizeof **result);
  if (!*result)
    return VL_ERROR_MEMORY;
  for (uint32_t y = 0; y < image->height; y++)
    vl_image_row_to_float(image, y, channel, count, *result + row * y);
  return VL_OK;
}

/* ---- attributes -------------------------------------------------------------------------- */

static vlImageAttribute *find_attribute(const vlImage *image, const char *name) {
  for (size_t i = 0; i < image->attributes.count; i++)
    if (vl_text_is(image->attributes.items[i].name, name))
      return &image->attributes.items[i];
  return NULL;
}

static bool are_within(const double *numbers, int count, double low, double high) {
  for (int i = 0; i < count; i++)
    if (!(numbers[i] >= low && numbers[i] <= high))
      return false;
  return true;
}

/* Whether a header of OpenEXR can hold the attribute: integers of 32 bits, and the types and
 * ranges of the attributes that each header has. */
static bool suits_header(const vlAttribute *a) {
  static const struct {
    const char *name;
    vlAttributeType type;
    int count; /* of the numbers that have a range */
    double low, high;
  } required[] = {{"pixelAspectRatio", VL_ATTRIBUTE_FLOAT, 1, 1e-6, 1e6},
                  {"screenWindowWidth", VL_ATTRIBUTE_FLOAT, 1, 0, FLT_MAX},
                  {"screenWindowCenter", VL_ATTRIBUTE_V2F, 0, 0, 0},
                  {"displayWindow", VL_ATTRIBUTE_BOX2I, 4, -MAX_WINDOW, MAX_WINDOW},
                  {"dataWindow", VL_ATTRIBUTE_BOX2I, 4, -MAX_WINDOW, MAX_WINDOW}};
  for (size_t i = 0; i < VL_LENGTH(required); i++) {
    if (!vl_text_is(a->name, required[i].name))
      continue;
    const bool is_window = required[i].type == VL_ATTRIBUTE_BOX2I;
    return a->type == required[i].type &&
           are_within(a->numbers, required[i].count, required[i].low, required[i].high) &&
           !(is_window && (a->numbers[0] > a->numbers[2] || a->numbers[1] > a->numbers[3]));
  }
  const int integers = a->type == VL_ATTRIBUTE_INT ? 1 : a->type == VL_ATTRIBUTE_BOX2I ? 4 : 0;
  return are_within(a->numbers, integers, INT32_MIN, INT32_MAX);
}

vlResult vl_image_set_attribute(vlImage *image, const vlAttribute *attribute) {
  if (!image || !attribute || !name_ok(attribute->name))
    return VL_ERROR_ARGUMENT;
  if ((unsigned)attribute->type > VL_ATTRIBUTE_STRINGS || !suits_header(attribute))
    return VL_ERROR_ARGUMENT;
  bool text = attribute->type == VL_ATTRIBUTE_STRING || attribute->type == VL_ATTRIBUTE_STRINGS;
  if (text && !attribute->string)
    return VL_ERROR_ARGUMENT;
  char *string = NULL;
  if (text && !(string = vl_strdup(image->context, attribute->string)))
    return VL_ERROR_MEMORY;
  vlImageAttribute *kept = find_attribute(image, attribute->name);
  if (!kept) {
    char *name = vl_strdup(image->context, attribute->name);
    kept = name ? VL_PUSH(image->context, &image->attributes) : NULL;
    if (!kept) {
      VL_FREE(image->context, name, string);
      return VL_ERROR_MEMORY;
    }
    kept->name = name;
  }
  vl_free(image->context, kept->string);
  kept->string = string;
  kept->type = attribute->type;
  memcpy(kept->numbers, attribute->numbers, sizeof kept->numbers);
  return VL_OK;
}

uint32_t vl_image_attribute_count(const vlImage *image) {
  return (uint32_t)image->attributes.count;
}

static void attribute_out(const vlImageAttribute *kept, vlAttribute *attribute) {
  attribute->name = kept->name;
  attribute->type = kept->type;
  memcpy(attribute->numbers, kept->numbers, sizeof attribute->numbers);
  attribute->string = kept->string;
}

vlResult vl_image_attribute(const vlImage *image, uint32_t index, vlAttribute *attribute) {
  if (!image || !attribute || index >= image->attributes.count)
    return VL_ERROR_ARGUMENT;
  attribute_out(&image->attributes.items[index], attribute);
  return VL_OK;
}

vlResult vl_image_add_attributes(vlImage *image, const vlImage *from) {
  vlResult result = image && from ? VL_OK : VL_ERROR_ARGUMENT;
  for (uint32_t i = 0; from && i < vl_image_attribute_count(from) && result == VL_OK; i++) {
    vlAttribute attribute;
    result = vl_image_attribute(from, i, &attribute);
    if (result == VL_OK)
      result = vl_image_set_attribute(image, &attribute);
  }
  return result;
}

vlResult vl_image_find_attribute(const vlImage *image, const char *name,
                                 vlAttribute *attribute) {
  if (!image || !name || !attribute)
    return VL_ERROR_ARGUMENT;
  const vlImageAttribute *kept = find_attribute(image, name);
  if (!kept)
    return VL_ERROR_MISSING;
  attribute_out(kept, attribute);
  return VL_OK;
}

void vl_map_add_at(const float *pixels, uint32_t width, uint32_t height, uint32_t channels,
                   double u, double v, double sum[3]) {
  const double fu = floor(u), fv = floor(v);
  const int64_t w = width, h = height;
  for (int c = 0; c < 4; c++) {
    int64_t i = (int64_t)fu + (c & 1), j = (int64_t)fv + (c >> 1);
    i = i < 0 ? i + w : i >= w ? i - w : i;
    j = j < 0 ? 0 : j >= h ? h - 1 : j;
    const double weight = (c & 1 ? u - fu : 1 - (u - fu)) * (c >> 1 ? v - fv : 1 - (v - fv));
    const float *p = pixels + (size_t)(j * w + i) * channels;
    for (uint32_t n = 0; n < 3; n++)
      sum[n] += weight * p[channels < 3 ? 0 : n];
  }
}

/* ---- colour spaces ----------------------------------------------------------------------- */

vlResult vl_image_set_space(vlImage *image, vlColorSpace space) {
  vlAttribute a = {.name = "chromaticities", .type = VL_ATTRIBUTE_CHROMATICITIES};
  float xy[8];
  vl_space_chromaticities(space, xy);
  for (int i = 0; i < 8; i++)
    a.numbers[i] = (double)xy[i];
  return vl_image_set_attribute(image, &a);
}

bool vl_image_space(const vlImage *image, vlColorSpace *space) {
  vlAttribute a;
  if (vl_image_find_attribute(image, "chromaticities", &a) != VL_OK ||
      a.type != VL_ATTRIBUTE_CHROMATICITIES)
    return false;
  for (int k = 0; k < 4; k++) {
    float xy[8];
    bool same = true;
    vl_space_chromaticities((vlColorSpace)k, xy);
    for (int i = 0; i < 8; i++)
      same = same && a.numbers[i] - (double)xy[i] < 1e-3 && (double)xy[i] - a.numbers[i] < 1e-3;
    if (same) {
      *space = (vlColorSpace)k;
      return true;
    }
  }
  return false;
}
