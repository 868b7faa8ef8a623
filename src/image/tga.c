/* image/tga.c: Truevision TGA: grey, palette and true colour of 8, 15, 16, 24 and 32 bits,
 * uncompressed and run-length encoded, all four origins. Written uncompressed, from the top.
 * The format has no signature: the probe checks the header for plausibility. */
#include <string.h>

#include "base/bytes.h"
#include "base/free.h"
#include "image/codec.h"

enum {
  HEAD = 18,
  MAX_COMMENT = 255, /* bytes */
  PALETTE = 1,
  COLOR = 2,
  GREY = 3,
  RLE = 8,
  FROM_RIGHT = 0x10,
  FROM_TOP = 0x20
};

typedef struct Tga {
  uint32_t width, height, kind, depth, flags;
  bool rle;
  uint32_t palette_first, palette_count, palette_depth;
  size_t palette_at, pixels_at;
} Tga;

static bool depth_ok(uint32_t depth) {
  return depth == 15 || depth == 16 || depth == 24 || depth == 32;
}

static bool parse(const uint8_t *d, size_t size, Tga *t) {
  if (size < HEAD)
    return false;
  uint32_t has_palette = d[1];
  t->kind = d[2] & ~(uint32_t)RLE;
  t->rle = (d[2] & RLE) != 0;
  t->palette_first = vl_little16(d + 3);
  t->palette_count = has_palette ? vl_little16(d + 5) : 0;
  t->palette_depth = d[7];
  t->width = vl_little16(d + 12);
  t->height = vl_little16(d + 14);
  t->depth = d[16];
  t->flags = d[17];
  if (has_palette > 1 || t->kind < PALETTE || t->kind > GREY || (t->flags & 0xc0))
    return false;
  if (t->width == 0 || t->height == 0)
    return false;
  if (t->kind == PALETTE && !(has_palette && t->depth == 8 && depth_ok(t->palette_depth)))
    return false;
  if (t->kind == COLOR && !depth_ok(t->depth))
    return false;
  if (t->kind == GREY && t->depth != 8 && t->depth != 16)
    return false;
  t->palette_at = (size_t)HEAD + d[0];
  t->pixels_at = t->palette_at + (size_t)t->palette_count * ((t->palette_depth + 7) / 8);
  return true;
}

bool vl_tga_probe(const uint8_t *data, size_t size) {
  Tga t;
  return parse(data, size, &t);
}

/* Converts a stored colour of 2, 3 or 4 bytes (blue first) to R G B (A). The alpha bit of
 * 16-bit colours is ignored, since it is unreliable. */
static void color_out(const uint8_t *p, uint32_t depth, uint8_t *out) {
  if (depth <= 16) {
    uint32_t v = vl_little16(p);
    out[0] = (uint8_t)((v >> 10 & 31) * 255 / 31);
    out[1] = (uint8_t)((v >> 5 & 31) * 255 / 31);
    out[2] = (uint8_t)((v & 31) * 255 / 31);
    return;
  }
  out[0] = p[2];
  out[1] = p[1];
  out[2] = p[0];
  if (depth == 32)
    out[3] = p[3];
}

static bool pixel_out(const vlImageFile *file, const Tga *t, const uint8_t *p, uint8_t *out) {
  if (t->kind == COLOR) {
    color_out(p, t->depth, out);
  } else if (t->kind == GREY) {
    memcpy(out, p, t->depth / 8);
  } else {
    uint32_t index = (uint32_t)p[0] - t->palette_first;
    if (p[0] < t->palette_first || index >= t->palette_count)
      return false;
    color_out(file->data + t->palette_at + (size_t)index * ((t->palette_depth + 7) / 8),
              t->palette_depth, out);
  }
  return true;
}

static vlResult read_pixels(const vlImageFile *file, const Tga *t, vlImage *image) {
  uint32_t bytes = (t->depth + 7) / 8, run = 0;
  size_t at = t->pixels_at, channels = image->channels;
  bool repeat = false;
  uint8_t value[4] = {0};
  for (uint32_t y = 0; y < t->height; y++) {
    uint8_t *row = vl_image_row(image, t->flags & FROM_TOP ? y : t->height - 1 - y);
    for (uint32_t x = 0; x < t->width; x++) {
      bool fresh = true;
      if (t->rle) {
        if (run == 0) {
          if (at >= file->size)
            return vl_codec_broken(file, "ends too early");
          repeat = file->data[at] & 0x80;
          run = (file->data[at++] & 0x7fu) + 1;
        } else {
          fresh = !repeat;
        }
        run--;
      }
      if (fresh) {
        if (bytes > file->size || at > file->size - bytes)
          return vl_codec_broken(file, "ends too early");
        if (!pixel_out(file, t, file->data + at, value))
          return vl_codec_broken(file, "a colour outside its palette");
        at += bytes;
      }
      memcpy(row + (t->flags & FROM_RIGHT ? t->width - 1 - x : x) * channels, value, channels);
    }
  }
  return VL_OK;
}

/* Many writers leave the fourth byte 0 and declare no alpha bits: such images have no alpha. */
static bool alpha_is_empty(const Tga *t, const vlImage *image) {
  if (t->flags & 15)
    return false;
  const uint8_t *p = image->pixels;
  for (size_t i = 0, n = (size_t)t->width * t->height; i < n; i++)
    if (p[4 * i + 3])
      return false;
  return true;
}

vlResult vl_tga_read(const vlImageFile *file, vlImage **image) {
  Tga t;
  if (!parse(file->data, file->size, &t))
    return vl_codec_broken(file, "its header is not understood");
  if (t.pixels_at > file->size)
    return vl_codec_broken(file, "ends in its palette");
  uint32_t depth = t.kind == PALETTE ? t.palette_depth : t.depth;
  uint32_t channels = t.kind == GREY ? depth / 8 : depth == 32 ? 4 : 3;
  /* a run: 128 pixels from a count byte and one pixel */
  double stored = (double)t.width * t.height * ((t.depth + 7) / 8);
  vlResult result = vl_codec_promise(file, t.width, t.height, stored, t.rle ? 128.0 : 1.0);
  if (result == VL_OK)
    result = vl_codec_create(file, t.width, t.height, channels, VL_PIXEL_U8, VL_ENCODING_SRGB,
                             image);
  if (result == VL_OK)
    result = read_pixels(file, &t, *image);
  if (result != VL_OK || channels != 4 || !alpha_is_empty(&t, *image))
    return result;
  vlImage *opaque;
  VL_TRY(vl_codec_create(file, t.width, t.height, 3, VL_PIXEL_U8, VL_ENCODING_SRGB, &opaque));
  const uint8_t *from = (*image)->pixels;
  uint8_t *to = opaque->pixels;
  for (size_t i = 0, n = (size_t)t.width * t.height; i < n; i++)
    memcpy(to + 3 * i, from + 4 * i, 3);
  vl_image_destroy(*image);
  *image = opaque;
  return VL_OK;
}

vlResult vl_tga_write(const vlImage *image, VL_UNUSED const vlWriteDef *def,
                      vlFileWriter *writer, vlError *error) {
  uint32_t channel[4], count = vl_image_shown(image, channel);
  vlResult result = VL_OK;
  if (image->width > 65535 || image->height > 65535)
    return vl_fail_argument(error, "cannot write %s: TGA holds at most 65535x65535 pixels",
                            writer->path);
  if (count == 2)
    count = 1; /* few programs read grey with alpha */
  uint8_t *row = vl_alloc_array(image->context, image->width, count);
  float *scratch = vl_alloc_array(image->context, image->width, count * sizeof(float));
  if (row && scratch) {
    const char *comment = vl_codec_comment(image); /* the format's image ID */
    size_t length = comment ? strlen(comment) : 0;
    length = length < MAX_COMMENT ? length : MAX_COMMENT;
    const uint8_t head[HEAD] = {
        [0] = (uint8_t)length,         [2] = count == 1 ? GREY : COLOR,
        [12] = (uint8_t)image->width,  [13] = (uint8_t)(image->width >> 8),
        [14] = (uint8_t)image->height, [15] = (uint8_t)(image->height >> 8),
        [16] = (uint8_t)(count * 8),   [17] = FROM_TOP | (count == 4 ? 8 : 0)};
    vl_file_write(writer, head, HEAD);
    vl_file_write(writer, comment, length);
    for (uint32_t y = 0; y < image->height && !writer->failed_errno; y++) {
      vl_codec_row_8bit(image, y, channel, count, scratch, row);
      for (uint32_t x = 0; count >= 3 && x < image->width; x++) {
        uint8_t *p = row + (size_t)x * count, red = p[0];
        p[0] = p[2];
        p[2] = red;
      }
      vl_file_write(writer, row, (size_t)image->width * count);
    }
  } else {
    result = vl_fail_memory(error);
  }
  VL_FREE(image->context, row, scratch);
  return result;
}
