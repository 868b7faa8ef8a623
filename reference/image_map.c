/* image_map.c: looks up pixels. The library reads the files, and gives their values as linear numbers. */
#include "image_map.h"

#include <math.h>

#include "more/more.h"

image_map make_image_map(const vlImage *image) {
  image_map map = {.image = image, .width = vl_image_width(image), .height = vl_image_height(image)};
  map.channels = vl_image_shown(image, map.channel);
  return map;
}

bool read_image_map(vlContext *context, const vlTextureDef *def, image_map *map, vlError *error) {
  vlImage *image = NULL;
  if (def->path && vl_image_read(context, def->path, &image, error) != VL_OK) return false;
  if (def->data && vl_image_read_memory(context, "image", def->data, def->data_size, &image, error) != VL_OK)
    return false;
  *map = make_image_map(image ? image : def->image);
  if (def->encoding_given) *map = decode_otherwise(context, map->image, def);
  return true;
}

/* The column or row inside the image that stands for one outside; -1: black. */
static long wrapped(long i, long size, vlWrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == VL_WRAP_BLACK) return -1;
  if (wrap == VL_WRAP_CLAMP) return i < 0 ? 0 : size - 1;
  if (wrap == VL_WRAP_REPEAT) return ((i % size) + size) % size;
  long twice = ((i % (2 * size)) + 2 * size) % (2 * size); /* mirrored */
  return twice < size ? twice : 2 * size - 1 - twice;
}

void pixel_of(const image_map *map, long x, long y, vlWrap wrap_s, vlWrap wrap_t, double value[4]) {
  x = wrapped(x, (long)map->width, wrap_s);
  y = wrapped(y, (long)map->height, wrap_t);
  for (uint32_t c = 0; c < 4; c++) value[c] = 0;
  if (x < 0 || y < 0) return;
  uint32_t colors = map->channels < 3 ? 1 : 3;
  value[3] = 1;
  for (uint32_t c = 0; c < 4; c++) {
    uint32_t own = c == 3 ? colors : c % colors;
    if (own < map->channels) value[c] = (double)vl_image_get(map->image, (uint32_t)x, (uint32_t)y, map->channel[own]);
  }
}

void pixels_around(const image_map *map, double s, double t, vlWrap wrap_s, vlWrap wrap_t, double value[4]) {
  double x = s * map->width - 0.5, y = t * map->height - 0.5;
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
