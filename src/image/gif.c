/* image/gif.c: the first image of a GIF (87a, 89a), interlaced or not. A transparent colour or
 * an uncovered part of the screen gives alpha. The LZW codes have 3 to 12 bits and stand for
 * strings; each string is an earlier string and one more byte. */
#include <string.h>

#include "base/bytes.h"
#include "image/codec.h"

enum { CODES = 4096 };

typedef struct Gif {
  const vlImageFile *file;
  size_t at;
  uint32_t left, top, width, height; /* of the frame on the screen */
  const uint8_t *palette;
  uint32_t colors;
  int transparent;
  bool interlaced;
  /* reads bits from the sub-blocks */
  uint32_t bits, bit_count, block_left;
} Gif;

typedef struct Lzw {
  uint16_t before[CODES];
  uint8_t last[CODES], first[CODES];
  uint8_t text[CODES + 1];
} Lzw;

bool vl_gif_probe(const uint8_t *data, size_t size) {
  return size >= 13 && (memcmp(data, "GIF87a", 6) == 0 || memcmp(data, "GIF89a", 6) == 0);
}

static bool next_code(Gif *g, uint32_t size, uint32_t *code) {
  while (g->bit_count < size) {
    if (g->block_left == 0) {
      if (g->at >= g->file->size || (g->block_left = g->file->data[g->at++]) == 0)
        return false;
    }
    if (g->at >= g->file->size)
      return false;
    g->bits |= (uint32_t)g->file->data[g->at++] << g->bit_count;
    g->bit_count += 8;
    g->block_left--;
  }
  *code = g->bits & ((1u << size) - 1);
  g->bits >>= size;
  g->bit_count -= size;
  return true;
}

/* Order of interlaced rows: 0,8,.. 4,12,.. 2,6,.. 1,3,.. */
static uint32_t row_of(const Gif *g, uint32_t n) {
  if (!g->interlaced)
    return n;
  static const uint32_t START[4] = {0, 4, 2, 1}, STEP[4] = {8, 8, 4, 2};
  for (int pass = 0; pass < 4; pass++) {
    uint32_t rows =
        g->height > START[pass] ? (g->height - START[pass] + STEP[pass] - 1) / STEP[pass] : 0;
    if (n < rows)
      return START[pass] + n * STEP[pass];
    n -= rows;
  }
  return 0;
}

static bool put(const Gif *g, vlImage *image, size_t index, uint32_t color) {
  if (color >= g->colors)
    return false;
  uint32_t x = g->left + (uint32_t)(index % g->width),
           y = g->top + row_of(g, (uint32_t)(index / g->width));
  if (x >= image->width || y >= image->height)
    return true; /* outside the screen */
  uint8_t *p = (uint8_t *)vl_image_row(image, y) + (size_t)x * image->channels;
  memcpy(p, g->palette + 3 * color, 3);
  if (image->channels == 4)
    p[3] = (int)color == g->transparent ? 0 : 255;
  return true;
}

static vlResult unpack(Gif *g, Lzw *z, vlImage *image) {
  uint32_t min = g->file->data[g->at++];
  if (min < 1 || min > 8)
    return vl_codec_broken(g->file, "its code size is not possible");
  uint32_t clear = 1u << min, end = clear + 1, next = end + 1, size = min + 1, old = CODES,
           code;
  for (uint32_t i = 0; i < clear; i++)
    z->first[i] = z->last[i] = (uint8_t)i;
  size_t done = 0, count = (size_t)g->width * g->height;
  while (done < count) {
    if (!next_code(g, size, &code))
      return vl_codec_broken(g->file, "ends too early");
    if (code == clear) {
      next = end + 1;
      size = min + 1;
      old = CODES;
      continue;
    }
    if (code == end)
      return vl_codec_broken(g->file, "ends too early");
    /* the code `next` stands for the string that is being defined */
    if (code > next || (code == next && (old == CODES || next == CODES)))
      return vl_codec_broken(g->file, "a code that is not defined");
    if (old != CODES && next < CODES) {
      z->before[next] = (uint16_t)old;
      z->first[next] = z->first[old];
      z->last[next] = z->first[code == next ? old : code];
      if (++next == 1u << size && size < 12)
        size++;
    }
    uint32_t n = 0;
    for (uint32_t c = code;; c = z->before[c]) { /* the string is produced in reverse */
      z->text[n++] = z->last[c];
      if (c < clear || n > CODES - 1)
        break;
    }
    while (n && done < count)
      if (!put(g, image, done++, z->text[--n]))
        return vl_codec_broken(g->file, "a colour outside its palette");
    old = code;
  }
  return VL_OK;
}

/* Skips to the first image; false when there is none. */
static bool find_frame(Gif *g) {
  const uint8_t *d = g->file->data;
  size_t size = g->file->size;
  g->at = 13;
  if (d[10] & 0x80) {
    g->colors = 2u << (d[10] & 7);
    g->palette = d + g->at;
    g->at += 3u * g->colors;
  }
  while (g->at < size) {
    uint8_t kind = d[g->at++];
    if (kind == ',') {
      if (g->at > size || size - g->at < 10)
        return false;
      const uint8_t *p = d + g->at;
      g->left = vl_little16(p);
      g->top = vl_little16(p + 2);
      g->width = vl_little16(p + 4);
      g->height = vl_little16(p + 6);
      g->interlaced = p[8] & 0x40;
      g->at += 9;
      if (p[8] & 0x80) {
        g->colors = 2u << (p[8] & 7);
        g->palette = d + g->at;
        g->at += 3u * g->colors;
      }
      return g->palette && g->at < size && g->width && g->height;
    }
    if (kind != '!' || g->at >= size)
      return false;
    uint8_t label = d[g->at++];
    if (label == 0xf9 && size - g->at >= 6 && (d[g->at + 1] & 1))
      g->transparent = d[g->at + 4];
    for (;;) { /* the extension's sub-blocks */
      if (g->at >= size)
        return false;
      uint8_t n = d[g->at++];
      if (n == 0)
        break;
      g->at += n;
    }
  }
  return false;
}

vlResult vl_gif_read(const vlImageFile *file, vlImage **image) {
  Gif g = {.file = file, .transparent = -1};
  if (!find_frame(&g))
    return vl_codec_broken(file, "no image in it");
  uint32_t width = vl_little16(file->data + 6), height = vl_little16(file->data + 8);
  if (width == 0 || height == 0) { /* some writers leave the screen's size 0 */
    width = g.left + g.width;
    height = g.top + g.height;
  }
  /* A code of 12 bits stands for at most 4094 bytes. */
  VL_TRY(vl_codec_promise(file, g.width, g.height, (double)g.width * g.height, 2730.0));
  VL_TRY(vl_codec_promise(file, width, height, (double)width * height, 2730.0));
  bool covers = g.left == 0 && g.top == 0 && g.width >= width && g.height >= height;
  uint32_t channels = g.transparent >= 0 || !covers ? 4 : 3;
  Lzw *z = vl_alloc_zero(file->context, 1, sizeof *z);
  vlResult result =
      z ? vl_codec_create(file, width, height, channels, VL_PIXEL_U8, VL_ENCODING_SRGB, image)
        : vl_fail_memory(file->error);
  if (result == VL_OK)
    result = unpack(&g, z, *image);
  vl_free(file->context, z);
  return result;
}
