/* image_map.h: an image whose pixels are looked up: a texture, or the light of the sky. Values are linear. */
#pragma once
#include <velo/velo.h>

typedef struct image_map {
  const vlImage *image;
  uint32_t width, height;
  uint32_t channels;   /* 1: grey, 2: grey and coverage, 3: colour, 4: colour and coverage */
  uint32_t channel[4]; /* which of the image's channels they are */
} image_map;

image_map make_image_map(const vlImage *image);
/* Reads the image of a texture. False, with an error. */
bool read_image_map(vlContext *context, const vlTextureDef *def, image_map *map, vlError *error);

/* The pixel at (x, y), which may lie outside: `wrap` says what is there. All four values are set: grey fills the
 * colours, a missing coverage is 1. */
void pixel_of(const image_map *map, long x, long y, vlWrap wrap_s, vlWrap wrap_t, double value[4]);
/* Linear between the four pixels around (s, t), measured from the top left corner, 0 to 1 over the image. */
void pixels_around(const image_map *map, double s, double t, vlWrap wrap_s, vlWrap wrap_t, double value[4]);
