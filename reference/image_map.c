/* image_map.c: looks up pixels. program/images.c reads them. */
#include "world.h"

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
  value[3] = 1;
  uint32_t colors = map->channels < 3 ? 1 : 3; /* then the coverage, if there is one */
  for (uint32_t c = 0; c < 4; c++) {
    uint32_t i = c == 3 ? colors : c % colors;
    if (i < map->channels) value[c] = (double)vl_image_get(map->image, (uint32_t)x, (uint32_t)y, map->channel[i]);
  }
}

void pixels_around(const image_map *map, double s, double t, vlWrap wrap_s, vlWrap wrap_t, double value[4]) {
  double x = s * map->width - 0.5, y = t * map->height - 0.5; /* from the middle of the first pixel */
  double left = floor(x), top = floor(y);
  double dx = x - left, dy = y - top;
  double weight[4] = {(1 - dx) * (1 - dy), dx * (1 - dy), (1 - dx) * dy, dx * dy};
  for (int c = 0; c < 4; c++) value[c] = 0;
  for (int k = 0; k < 4; k++) {
    double near[4];
    pixel_of(map, (long)left + (k & 1), (long)top + (k >> 1), wrap_s, wrap_t, near);
    for (int c = 0; c < 4; c++) value[c] += weight[k] * near[c];
  }
}
