/* image_map.c: looks up pixels. */
#include "image_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The sRGB curve (IEC 61966-2-1), from the stored value to the linear one. */
static double srgb_to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double decode(double v, vlEncoding encoding, double gamma) {
  switch (encoding) {
    case VL_ENCODING_LINEAR: return v;
    case VL_ENCODING_SRGB: return srgb_to_linear(v);
    case VL_ENCODING_GAMMA: return pow(v, gamma);
  }
  return v;
}

/* A linear value of the image; integers are decoded here if the scene names another encoding than the file. Coverage is
 * always linear. */
static double value_of(const vlImage *image, uint32_t x, uint32_t y, uint32_t channel, const vlEncoding *encoding,
                       double gamma, bool coverage) {
  size_t index = ((size_t)y * vl_image_width(image) + x) * vl_image_channels(image) + channel;
  vlPixelType type = vl_image_type(image);
  if (!encoding || (type != VL_PIXEL_U8 && type != VL_PIXEL_U16)) return (double)vl_image_get(image, x, y, channel);
  double stored = type == VL_PIXEL_U8 ? ((const uint8_t *)vl_image_const_pixels(image))[index] / 255.0
                                      : ((const uint16_t *)vl_image_const_pixels(image))[index] / 65535.0;
  return coverage ? stored : decode(stored, *encoding, gamma);
}

/* The channels by name, since files store them in any order: R G B, else Y, else the first; and A. */
static uint32_t find_channels(const vlImage *image, int channel[4]) {
  int red = vl_image_find_channel(image, "R");
  int green = vl_image_find_channel(image, "G");
  int blue = vl_image_find_channel(image, "B");
  int alpha = vl_image_find_channel(image, "A");
  if (red >= 0 && green >= 0 && blue >= 0) {
    channel[0] = red;
    channel[1] = green;
    channel[2] = blue;
    channel[3] = alpha;
    return alpha >= 0 ? 4 : 3;
  }
  int luminance = vl_image_find_channel(image, "Y");
  channel[0] = luminance >= 0 ? luminance : 0;
  channel[1] = alpha;
  return alpha >= 0 ? 2 : 1;
}

bool make_image_map(const vlImage *image, const vlEncoding *encoding, double gamma, image_map *map) {
  int channel[4];
  memset(map, 0, sizeof *map);
  map->width = vl_image_width(image);
  map->height = vl_image_height(image);
  map->channels = find_channels(image, channel);
  map->values = malloc((size_t)map->width * map->height * map->channels * sizeof *map->values);
  if (!map->values) return false;
  float *out = map->values;
  for (uint32_t y = 0; y < map->height; y++) {
    for (uint32_t x = 0; x < map->width; x++) {
      for (uint32_t c = 0; c < map->channels; c++) {
        bool coverage = c == 3 || (map->channels == 2 && c == 1);
        *out++ = (float)value_of(image, x, y, (uint32_t)channel[c], encoding, gamma, coverage);
      }
    }
  }
  return true;
}

void free_image_map(image_map *map) {
  free(map->values);
  map->values = NULL;
}

/* The column or row inside the image that stands for one outside; -1: black. */
static long wrapped(long i, long size, vlWrap wrap) {
  if (i >= 0 && i < size) return i;
  switch (wrap) {
    case VL_WRAP_BLACK: return -1;
    case VL_WRAP_CLAMP: return i < 0 ? 0 : size - 1;
    case VL_WRAP_OCTAHEDRAL: /* pixel_of has folded the indices already */
    case VL_WRAP_REPEAT: return ((i % size) + size) % size;
    case VL_WRAP_MIRROR: {
      long twice = ((i % (2 * size)) + 2 * size) % (2 * size);
      return twice < size ? twice : 2 * size - 1 - twice;
    }
  }
  return -1;
}

/* Beyond an edge of an octahedral map lies the same edge, mirrored about its middle (pbrt book 3.8.3). */
static void fold_octahedral(long width, long height, long *x, long *y) {
  if (*x < 0 || *x >= width) {
    *x = *x < 0 ? -*x - 1 : 2 * width - 1 - *x;
    *y = height - 1 - *y;
  }
  if (*y < 0 || *y >= height) {
    *x = width - 1 - *x;
    *y = *y < 0 ? -*y - 1 : 2 * height - 1 - *y;
  }
}

void pixel_of(const image_map *map, long x, long y, vlWrap wrap_s, vlWrap wrap_t, double value[4]) {
  if (wrap_s == VL_WRAP_OCTAHEDRAL) fold_octahedral((long)map->width, (long)map->height, &x, &y);
  x = wrapped(x, (long)map->width, wrap_s);
  y = wrapped(y, (long)map->height, wrap_t);
  for (int c = 0; c < 4; c++) value[c] = 0;
  if (x < 0 || y < 0) return;
  const float *v = map->values + ((size_t)y * map->width + (size_t)x) * map->channels;
  bool grey = map->channels < 3;
  for (int c = 0; c < 3; c++) value[c] = (double)v[grey ? 0 : c];
  value[3] = map->channels == 4 ? (double)v[3] : map->channels == 2 ? (double)v[1] : 1;
}

void pixels_around(const image_map *map, double s, double t, vlWrap wrap_s, vlWrap wrap_t, double value[4]) {
  double x = s * map->width - 0.5;
  double y = t * map->height - 0.5;
  double left = floor(x), top = floor(y);
  double dx = x - left, dy = y - top;
  double weight[4] = {(1 - dx) * (1 - dy), dx * (1 - dy), (1 - dx) * dy, dx * dy};
  for (int c = 0; c < 4; c++) value[c] = 0;
  for (int k = 0; k < 4; k++) {
    double pixel[4];
    pixel_of(map, (long)left + (k & 1), (long)top + (k >> 1), wrap_s, wrap_t, pixel);
    for (int c = 0; c < 4; c++) value[c] += weight[k] * pixel[c];
  }
}
