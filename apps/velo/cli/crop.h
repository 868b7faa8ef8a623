/* cli/crop.h: windows of an image: x0, y0, x1, y1, in pixels; the last two are exclusive. */
#ifndef APP_CLI_CROP_H
#define APP_CLI_CROP_H

#include <stdbool.h>
#include <stdint.h>

static inline uint32_t crop_width(const uint32_t crop[4]) {
  return crop[2] - crop[0];
}

static inline uint32_t crop_height(const uint32_t crop[4]) {
  return crop[3] - crop[1];
}

static inline uint64_t crop_pixels(const uint32_t crop[4]) {
  return (uint64_t)crop_width(crop) * crop_height(crop);
}

static inline void crop_set(uint32_t crop[4], uint32_t x0, uint32_t y0, uint32_t x1,
                            uint32_t y1) {
  crop[0] = x0;
  crop[1] = y0;
  crop[2] = x1;
  crop[3] = y1;
}

static inline bool crop_is_whole(const uint32_t crop[4], uint32_t width, uint32_t height) {
  return !crop[0] && !crop[1] && crop[2] == width && crop[3] == height;
}

/* The one pixel. */
static inline void crop_set_pixel(uint32_t crop[4], uint32_t x, uint32_t y) {
  crop_set(crop, x, y, x + 1, y + 1);
}

#endif
