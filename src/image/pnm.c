/* image/pnm.c: netpbm's P1 to P6: bitmaps, grey and colour, as text and binary, up to 16 bits.
 * Values are taken as sRGB. */

#include "image/codec.h"

typedef struct Pnm {
  const vlImageFile *file;
  size_t at;
} Pnm;

bool vl_pnm_probe(const uint8_t *data, size_t size) {
  return size >= 3 && data[0] == 'P' && data[1] >= '1' && data[1] <= '6' &&
         (data[2] <= ' ' || data[2] == '#');
}

/* Reads the next number after white space and comments; it must be at most `limit`. */
static bool number(Pnm *p, uint32_t limit, uint32_t *value) {
  const uint8_t *d = p->file->data;
  size_t size = p->file->size;
  while (p->at < size && (d[p->at] <= ' ' || d[p->at] == '#')) {
    if (d[p->at] == '#')
      while (p->at < size && d[p->at] != '\n')
        p->at++;
    else
      p->at++;
  }
  if (p->at >= size || d[p->at] < '0' || d[p->at] > '9')
    return false;
  uint64_t v = 0;
  while (p->at < size && d[p->at] >= '0' && d[p->at] <= '9') {
    v = v * 10 + (d[p->at++] - '0');
    if (v > limit)
      return false;
  }
  *value = (uint32_t)v;
  return true;
}

/* Reads one digit 0 or 1. P1 needs no white space between digits. */
static bool bit(Pnm *p, uint32_t *value) {
  const uint8_t *d = p->file->data;
  while (p->at < p->file->size && d[p->at] <= ' ')
    p->at++;
  if (p->at >= p->file->size || (d[p->at] != '0' && d[p->at] != '1'))
    return false;
  *value = d[p->at++] - '0';
  return true;
}

static void store(vlImage *image, size_t index, uint32_t value, uint32_t limit) {
  if (image->type == VL_PIXEL_U16)
    ((uint16_t *)image->pixels)[index] =
        (uint16_t)(((uint64_t)value * 65535u + limit / 2) / limit);
  else
    ((uint8_t *)image->pixels)[index] = (uint8_t)((value * 255u + limit / 2) / limit);
}

vlResult vl_pnm_read(const vlImageFile *file, vlImage **image) {
  Pnm p = {file, 2};
  uint32_t kind = file->data[1] - '0', width, height, limit = 1;
  bool text = kind <= 3, bits = kind == 1 || kind == 4;
  uint32_t channels = kind == 3 || kind == 6 ? 3 : 1;
  if (!number(&p, 0x7fffffffu, &width) || !number(&p, 0x7fffffffu, &height) ||
      (!bits && !number(&p, 65535, &limit)) || limit == 0)
    return vl_codec_broken(file, "its header is not understood");
  if (!text)
    p.at++; /* the white-space byte before the pixels */
  double values = (double)width * height * channels;
  double need = bits && !text ? (double)((width + 7) / 8) * height
                : text        ? values
                              : values * (limit > 255 ? 2 : 1);
  VL_TRY(vl_codec_promise(file, width, height, need + (double)p.at, 1.0));
  VL_TRY(vl_codec_create(file, width, height, channels,
                         limit > 255 ? VL_PIXEL_U16 : VL_PIXEL_U8, VL_ENCODING_SRGB, image));
  size_t count = (size_t)width * height * channels, row = ((size_t)width + 7) / 8;
  for (size_t i = 0; i < count; i++) {
    uint32_t v = 0;
    bool ok = true;
    if (kind == 1)
      ok = bit(&p, &v);
    else if (text)
      ok = number(&p, limit, &v);
    else if (bits)
      v = file->data[p.at + i / width * row + i % width / 8] >> (7 - i % width % 8) & 1u;
    else if (limit > 255)
      v = (uint32_t)file->data[p.at + 2 * i] << 8 | file->data[p.at + 2 * i + 1];
    else
      v = file->data[p.at + i];
    if (!ok || v > limit)
      return vl_codec_broken(file, ok ? "a value above its limit" : "ends too early");
    store(*image, i, bits ? 1 - v : v, limit); /* 1 is black in bitmaps */
  }
  return VL_OK;
}
