/* image/pfm.c: portable float maps ("PF" colour, "Pf" grey; Debevec): 32-bit floats, rows from
 * the bottom. A negative scale means little-endian; its magnitude is not applied, as in other
 * renderers. Written little-endian. */
#include <stdio.h>
#include <string.h>

#include "image/codec.h"

bool vl_pfm_probe(const uint8_t *data, size_t size) {
  return size >= 3 && data[0] == 'P' && (data[1] == 'F' || data[1] == 'f') && (data[2] <= ' ');
}

/* Reads the next word and exactly one white-space byte after it. */
static bool next_word(const vlImageFile *file, size_t *at, char *word, size_t size) {
  while (*at < file->size && file->data[*at] <= ' ')
    ++*at;
  size_t n = 0;
  while (*at < file->size && file->data[*at] > ' ') {
    if (n + 1 >= size)
      return false;
    word[n++] = (char)file->data[(*at)++];
  }
  word[n] = 0;
  if (*at >= file->size)
    return false;
  ++*at;
  return n > 0;
}

static bool parse_size(const char *word, uint32_t *value) {
  *value = 0;
  for (const char *p = word; *p; p++) {
    if (*p < '0' || *p > '9' || *value > 200000000u)
      return false;
    *value = *value * 10 + (uint32_t)(*p - '0');
  }
  return true;
}

/* Only the sign of the scale counts; it must be a number other than 0. (strtod would depend on
 * the locale.) */
static bool parse_scale(const char *word, bool *little_endian) {
  *little_endian = word[0] == '-';
  const char *p = word + (word[0] == '-' || word[0] == '+');
  bool some = false;
  for (; (*p >= '0' && *p <= '9') || *p == '.'; p++)
    some |= *p >= '1' && *p <= '9';
  if (some && (*p == 'e' || *p == 'E')) {
    p += p[1] == '-' || p[1] == '+' ? 2 : 1;
    while (*p >= '0' && *p <= '9')
      p++;
  }
  return some && !*p;
}

vlResult vl_pfm_read(const vlImageFile *file, vlImage **image) {
  char word[64];
  bool little_endian;
  size_t at = 2;
  uint32_t width, height, channels = file->data[1] == 'F' ? 3 : 1;
  if (!next_word(file, &at, word, sizeof word) || !parse_size(word, &width) ||
      !next_word(file, &at, word, sizeof word) || !parse_size(word, &height) ||
      !next_word(file, &at, word, sizeof word))
    return vl_codec_broken(file, "its header is not understood");
  if (!parse_scale(word, &little_endian))
    return vl_codec_broken(file, "its scale is not a number other than 0");
  double need = 4.0 * channels * width * (double)height;
  VL_TRY(vl_codec_promise(file, width, height, need + (double)at, 1.0));
  VL_TRY(
      vl_codec_create(file, width, height, channels, VL_PIXEL_F32, VL_ENCODING_LINEAR, image));
  size_t row = vl_image_row_size(*image);
  for (uint32_t y = 0; y < height; y++) {
    uint32_t *out = vl_image_row(*image, height - 1 - y);
    memcpy(out, file->data + at + row * y, row);
    if (!little_endian)
      for (size_t i = 0; i < row / 4; i++)
        out[i] = __builtin_bswap32(out[i]);
  }
  return VL_OK;
}

vlResult vl_pfm_write(const vlImage *image, VL_UNUSED const vlWriteDef *def,
                      vlFileWriter *writer, vlError *error) {
  uint32_t channel[4], count = vl_image_shown(image, channel);
  count = count >= 3 ? 3 : 1;
  float *row = vl_alloc_array(image->context, image->width, count * sizeof *row);
  if (!row)
    return vl_fail_memory(error);
  char head[64];
  int n = snprintf(head, sizeof head, "%s\n%u %u\n-1.0\n", count == 3 ? "PF" : "Pf",
                   image->width, image->height);
  vl_file_write(writer, head, (size_t)n);
  for (uint32_t y = image->height; y-- > 0 && !writer->failed_errno;) {
    vl_image_row_to_float(image, y, channel, count, row);
    vl_file_write(writer, row, (size_t)image->width * count * sizeof *row);
  }
  vl_free(image->context, row);
  return VL_OK;
}
