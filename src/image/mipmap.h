/* image/mipmap.h: MIP maps of textures. The width and height of each level are half of those of
 * the level before, rounded down and at least 1. Every texel is the exactly weighted mean of
 * the linear values in its area, even if a size is odd. Levels of 8-bit images hold one byte
 * per value; their means are computed in floats and rounded once. Levels of other images hold
 * floats. */
#ifndef IMAGE_MIPMAP_H
#define IMAGE_MIPMAP_H

#include "image/image.h"
#include "velo/spectrum.h"

enum { VL_MIP_LEVELS = 32 };

typedef struct vlMipLevel {
  uint32_t width, height;
  const uint8_t *bytes; /* width*height*channels values, rows from the top; one of bytes and
                           floats is null */
  const float *floats;
} vlMipLevel;

typedef struct vlMipmap {
  vlContext *context;
  uint32_t channels; /* 1 to 4 */
  uint32_t level_count;
  bool is_bytes;
  bool space_given; /* the image has chromaticities, and they are those of a known colour space
                     */
  vlColorSpace space;   /* sRGB unless space_given */
  float decode[4][256]; /* per channel: byte -> linear */
  vlMipLevel levels[VL_MIP_LEVELS];
} vlMipmap;

/* The colour space that the image names, or else the other. map may be null. */
static inline vlColorSpace vl_mipmap_space(const vlMipmap *map, vlColorSpace otherwise) {
  return map && map->space_given ? map->space : otherwise;
}

typedef struct vlMipmapDef {
  uint32_t channel[4]; /* indices of the image's channels */
  uint32_t count;      /* 1 to 4 */
  bool only_finest;    /* make level 0 only */
  bool own_encoding; /* 8 and 16-bit images: use encoding and gamma below instead of the image's
                      * own
                      */
  vlEncoding encoding;
  float gamma;
  vlTask *task; /* of the build that makes it, which stops with CANCELLED; null: none */
} vlMipmapDef;

/* Makes a mipmap. The image may be destroyed afterwards. */
vlResult vl_mipmap_create(const vlImage *image, const vlMipmapDef *def, vlMipmap **mipmap);
void vl_mipmap_destroy(vlMipmap *mipmap); /* null is allowed */
size_t vl_mipmap_bytes(const vlMipmap *mipmap);

static inline float vl_mip_texel(const vlMipmap *m, uint32_t level, uint32_t x, uint32_t y,
                                 uint32_t channel) {
  const vlMipLevel *l = &m->levels[level];
  size_t at = ((size_t)y * l->width + x) * m->channels + channel;
  return m->is_bytes ? m->decode[channel][l->bytes[at]] : l->floats[at];
}

#endif
