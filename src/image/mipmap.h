/* image/mipmap.h: an image with all its coarser copies, for textures. Each level halves the one before (rounded down,
 * at least 1); every texel is the mean of the light its area covers, exactly weighted where a size is odd. Images of
 * 8 bits stay so on all levels (one byte a value; the means are taken in floats and rounded once), others become
 * floats. */
#ifndef IMAGE_MIPMAP_H
#define IMAGE_MIPMAP_H

#include "image/image.h"
#include "velo/scene.h"

enum { VL_MIP_LEVELS = 32 };

typedef struct vlMipLevel {
  uint32_t width, height;
  const uint8_t *bytes; /* one of the two is null; width*height*channels, rows from the top */
  const float *floats;
} vlMipLevel;

typedef struct vlMipmap {
  vlContext *context;
  uint32_t channels; /* 1 to 4 */
  uint32_t level_count;
  bool is_bytes;
  bool space_told;      /* the image says what its colours are, and this is one of the known spaces: */
  vlColorSpace space;   /* sRGB else */
  float decode[4][256]; /* per channel: byte -> linear */
  vlMipLevel levels[VL_MIP_LEVELS];
} vlMipmap;

typedef struct vlMipmapDef {
  uint32_t channel[4]; /* which of the image's channels */
  uint32_t count;      /* 1 to 4 */
  bool only_finest;    /* one level */
  bool own_encoding;   /* 8 and 16-bit images: encoding and gamma below instead of the image's */
  vlEncoding encoding;
  float gamma;
} vlMipmapDef;

/* The image may be destroyed afterwards. */
vlResult vl_mipmap_create(const vlImage *image, const vlMipmapDef *def, vlMipmap **mipmap);
void vl_mipmap_destroy(vlMipmap *mipmap); /* null is allowed */
size_t vl_mipmap_bytes(const vlMipmap *mipmap);

static inline float vl_mip_texel(const vlMipmap *m, uint32_t level, uint32_t x, uint32_t y, uint32_t channel) {
  const vlMipLevel *l = &m->levels[level];
  size_t at = ((size_t)y * l->width + x) * m->channels + channel;
  return m->is_bytes ? m->decode[channel][l->bytes[at]] : l->floats[at];
}

#endif
