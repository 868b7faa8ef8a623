/* image/bmp.c: Windows bitmaps: palettes of 1, 4 and 8 bits; 16, 24 and 32-bit colour; bit
 * fields; rows from the bottom or the top. Run-length encoding is not supported. */
#include <string.h>

#include "base/bytes.h"
#include "image/codec.h"

typedef struct Bmp {
  uint32_t width, height, depth;
  bool from_top;
  size_t pixels_at, palette_at;
  uint32_t palette_count, palette_bytes;
  uint32_t mask[4];
} Bmp;

bool vl_bmp_probe(const uint8_t *data, size_t size) {
  if (size < 26 || data[0] != 'B' || data[1] != 'M')
    return false;
  uint32_t head = vl_little32(data + 14);
  return head == 12 || (head >= 40 && head <= 124);
}

static vlResult parse(const vlImageFile *file, Bmp *b) {
  const uint8_t *d = file->data;
  uint32_t head = vl_little32(d + 14), coding = 0;
  memset(b, 0, sizeof *b);
  if ((size_t)14 + head > file->size)
    return vl_codec_broken(file, "ends in its header");
  b->pixels_at = vl_little32(d + 10);
  b->palette_at = (size_t)14 + head;
  if (head == 12) {
    b->width = vl_little16(d + 18);
    b->height = vl_little16(d + 20);
    b->depth = vl_little16(d + 24);
    b->palette_bytes = 3;
  } else {
    int32_t width = (int32_t)vl_little32(d + 18), height = (int32_t)vl_little32(d + 22);
    if (width <= 0 || height == 0 || height == INT32_MIN)
      return vl_codec_broken(file, "its image is empty");
    b->width = (uint32_t)width;
    b->from_top = height < 0;
    b->height = (uint32_t)(height < 0 ? -height : height);
    b->depth = vl_little16(d + 28);
    coding = vl_little32(d + 30);
    b->palette_bytes = 4;
    b->palette_count = vl_little32(d + 46);
  }
  if (coding == 1 || coding == 2)
    return vl_codec_unsupported(file, "run lengths");
  if (coding != 0 && coding != 3 && coding != 6)
    return vl_codec_unsupported(file, "this compression");
  if (b->depth <= 8) {
    if (b->depth != 1 && b->depth != 4 && b->depth != 8)
      return vl_codec_broken(file, "this number of bits");
    if (b->palette_count == 0 || b->palette_count > 1u << b->depth)
      b->palette_count = 1u << b->depth;
    if (b->palette_at + (size_t)b->palette_count * b->palette_bytes > file->size)
      return vl_codec_broken(file, "ends in its palette");
    return VL_OK;
  }
  if (b->depth != 16 && b->depth != 24 && b->depth != 32)
    return vl_codec_broken(file, "this number of bits");
  if (coding && b->depth != 24) { /* masks follow a 40-byte header; longer headers contain them
                                     at the same offset */
    if (file->size < 70)
      return vl_codec_broken(file, "ends in its header");
    for (int i = 0; i < 4; i++)
      b->mask[i] = i < 3 || head >= 56 ? vl_little32(d + 54 + 4 * i) : 0;
  } else if (b->depth == 16) {
    b->mask[0] = 0x7c00;
    b->mask[1] = 0x03e0;
    b->mask[2] = 0x001f;
  } else {
    b->mask[0] = 0xff0000;
    b->mask[1] = 0x00ff00;
    b->mask[2] = 0x0000ff;
  }
  return VL_OK;
}

static uint8_t field(uint32_t v, uint32_t mask) {
  if (!mask)
    return 0;
  uint32_t shift = (uint32_t)__builtin_ctz(mask);
  uint64_t top = mask >> shift, x = (v & mask) >> shift;
  return (uint8_t)((x * 255u + top / 2) / top);
}

vlResult vl_bmp_read(const vlImageFile *file, vlImage **image) {
  Bmp b;
  VL_TRY(parse(file, &b));
  size_t row = ((size_t)b.width * b.depth + 31) / 32 * 4;
  vlResult result = vl_codec_promise(file, b.width, b.height,
                                     (double)row * b.height + (double)b.pixels_at, 1.0);
  uint32_t channels = b.mask[3] ? 4 : 3;
  if (result == VL_OK)
    result = vl_codec_create(file, b.width, b.height, channels, VL_PIXEL_U8, VL_ENCODING_SRGB,
                             image);
  if (result != VL_OK)
    return result;
  for (uint32_t y = 0; y < b.height; y++) {
    const uint8_t *p = file->data + b.pixels_at + row * y;
    uint8_t *out = vl_image_row(*image, b.from_top ? y : b.height - 1 - y);
    for (uint32_t x = 0; x < b.width; x++, out += channels) {
      if (b.depth <= 8) {
        uint32_t at = x * b.depth,
                 index = p[at / 8] >> (8 - b.depth - at % 8) & ((1u << b.depth) - 1);
        if (index >= b.palette_count)
          return vl_codec_broken(file, "a colour outside its palette");
        const uint8_t *c = file->data + b.palette_at + (size_t)index * b.palette_bytes;
        out[0] = c[2];
        out[1] = c[1];
        out[2] = c[0];
      } else {
        uint32_t v = b.depth == 16   ? vl_little16(p + 2 * (size_t)x)
                     : b.depth == 32 ? vl_little32(p + 4 * (size_t)x)
                                     : vl_little16(p + 3 * (size_t)x) |
                                           (uint32_t)p[3 * (size_t)x + 2] << 16;
        for (uint32_t c = 0; c < channels; c++)
          out[c] = field(v, b.mask[c]);
      }
    }
  }
  return VL_OK;
}
