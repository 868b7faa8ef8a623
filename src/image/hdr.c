/* image/hdr.c: Radiance's RGBE images (Ward, "Real Pixels", Graphics Gems II). Reads
 * uncompressed rows, old and new run-length encoding; writes the new one. A pixel is three
 * mantissas and one exponent: value = m 2^(e - 136). The EXPOSURE line is not applied, as in
 * other renderers. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/free.h"
#include "image/codec.h"

bool vl_hdr_probe(const uint8_t *data, size_t size) {
  return (size >= 10 && memcmp(data, "#?RADIANCE", 10) == 0) ||
         (size >= 6 && memcmp(data, "#?RGBE", 6) == 0);
}

typedef struct Header {
  uint32_t width, height;
  bool upward; /* rows are stored from the bottom upwards */
  size_t pixels;
  bool xyze, other_order;
} Header;

/* Reads the next line without its newline. Returns false at the end of the file or when the
 * line does not fit. */
static bool next_line(const vlImageFile *file, size_t *at, char *line, size_t size) {
  size_t n = 0;
  while (*at < file->size) {
    char c = (char)file->data[(*at)++];
    if (c == '\n') {
      if (n && line[n - 1] == '\r')
        n--;
      line[n] = 0;
      return true;
    }
    if (n + 1 < size)
      line[n++] = c;
  }
  return false;
}

/* Reads " 123", at most nine digits. Returns the position after it, or null. */
static const char *parse_number(const char *p, uint32_t *value) {
  const char *digits = p + (*p == ' ');
  *value = 0;
  for (p = digits; *p >= '0' && *p <= '9' && p - digits < 9; p++)
    *value = *value * 10 + (uint32_t)(*p - '0');
  return p > digits ? p : NULL;
}

/* Reads the size, "-Y 480 +X 640". */
static bool parse_resolution(const char *line, Header *h) {
  if ((line[0] != '-' && line[0] != '+') || (line[1] != 'Y' && line[1] != 'X'))
    return false;
  const char *p = parse_number(line + 2, &h->height);
  if (!p || p[0] != ' ' || (p[1] != '-' && p[1] != '+') || (p[2] != 'Y' && p[2] != 'X'))
    return false;
  h->other_order = line[1] != 'Y' || p[2] != 'X' || p[1] != '+';
  h->upward = line[0] == '+';
  p = parse_number(p + 3, &h->width);
  while (p && *p == ' ')
    p++;
  return p && !*p;
}

static bool parse_header(const vlImageFile *file, Header *h) {
  char line[256];
  size_t at = 0;
  memset(h, 0, sizeof *h);
  for (bool blank = false; !blank;) {
    if (!next_line(file, &at, line, sizeof line))
      return false;
    blank = !line[0];
    if (strncmp(line, "FORMAT=32-bit_rle_xyze", 22) == 0)
      h->xyze = true;
  }
  if (!next_line(file, &at, line, sizeof line) || !parse_resolution(line, h))
    return false;
  h->pixels = at;
  return true;
}

/* Reads a row of the new encoding: four run-length encoded planes. Returns the bytes read, 0
 * when broken. */
static size_t read_planes(const uint8_t *p, size_t size, uint32_t width, uint8_t *row) {
  size_t at = 4;
  for (uint32_t c = 0; c < 4; c++)
    for (uint32_t x = 0; x < width;) {
      if (at >= size)
        return 0;
      uint32_t n = p[at++];
      bool run = n > 128;
      if (run)
        n -= 128;
      if (n == 0 || n > width - x || (run ? 1 : n) > size - at)
        return 0;
      for (uint32_t i = 0; i < n; i++)
        row[4 * (x + i) + c] = p[at + (run ? 0 : i)];
      at += run ? 1 : n;
      x += n;
    }
  return at;
}

/* Reads a row of pixels without planes. In the old encoding 1 1 1 n repeats the last pixel n
 * times; consecutive repeats multiply n by 256. */
static size_t read_pixels(const uint8_t *p, size_t size, uint32_t width, uint8_t *row) {
  size_t at = 0;
  uint32_t shift = 0;
  for (uint32_t x = 0; x < width; at += 4) {
    if (size - at < 4)
      return 0;
    const uint8_t *q = p + at;
    if (q[0] == 1 && q[1] == 1 && q[2] == 1) {
      if (x == 0 || shift > 16)
        return 0;
      uint32_t n = (uint32_t)q[3] << shift;
      if (n > width - x)
        return 0;
      for (uint32_t i = 0; i < n; i++)
        memcpy(row + 4 * (x + i), row + 4 * (x - 1), 4);
      x += n;
      shift += 8;
    } else {
      memcpy(row + 4 * x++, q, 4);
      shift = 0;
    }
  }
  return at;
}

vlResult vl_hdr_read(const vlImageFile *file, vlImage **image) {
  Header h;
  if (!parse_header(file, &h))
    return vl_codec_broken(file, "its header is not understood");
  if (h.xyze)
    return vl_codec_unsupported(file, "XYZ colours");
  if (h.other_order)
    return vl_codec_unsupported(file, "columns before rows, or rows from the right");
  /* The new encoding holds 127 pixels in 8 bytes, the old one 255 in 4 (more only by
   * consecutive repeats). */
  VL_TRY(vl_codec_promise(file, h.width, h.height, (double)h.width * h.height, 512.0));
  uint8_t *row = vl_alloc_array(file->context, h.width, 4);
  vlResult result =
      row ? vl_codec_create(file, h.width, h.height, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR, image)
          : vl_fail_memory(file->error);
  size_t at = h.pixels;
  for (uint32_t y = 0; result == VL_OK && y < h.height; y++) {
    if ((result = vl_codec_step(file)) != VL_OK)
      break;
    const uint8_t *p = file->data + at;
    size_t left = file->size - at;
    bool planes =
        left >= 4 && p[0] == 2 && p[1] == 2 && p[2] < 128 && h.width >= 8 && h.width < 32768;
    size_t used = 0;
    if (planes)
      used = ((uint32_t)p[2] << 8 | p[3]) == h.width ? read_planes(p, left, h.width, row) : 0;
    else
      used = read_pixels(p, left, h.width, row);
    if (!used) {
      result = vl_codec_broken(file, "its pixels end too early or do not fit");
      break;
    }
    at += used;
    float *out = vl_image_row(*image, h.upward ? h.height - 1 - y : y);
    for (uint32_t x = 0; x < h.width; x++) {
      float scale = row[4 * x + 3] ? ldexpf(1.0f, row[4 * x + 3] - 136) : 0.0f;
      for (uint32_t c = 0; c < 3; c++)
        out[3 * x + c] = row[4 * x + c] * scale;
    }
  }
  vl_free(file->context, row);
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void to_rgbe(const float rgb[3], uint8_t out[4]) {
  float v[3], peak = 0.0f;
  for (int c = 0; c < 3; c++) {
    /* NaN and negative values become 0 */
    v[c] = rgb[c] > 0.0f ? fminf(rgb[c], 1.0e38f) : 0.0f;
    if (v[c] > peak)
      peak = v[c];
  }
  memset(out, 0, 4);
  if (peak < 1.0e-38f)
    return;
  int e;
  frexpf(peak, &e);
  if (peak >= ldexpf(255.5f, e - 8))
    e++; /* the mantissa would round up to 256 */
  for (int c = 0; c < 3; c++)
    out[c] = (uint8_t)(ldexpf(v[c], 8 - e) + 0.5f);
  out[3] = (uint8_t)(e + 128);
}

/* Encodes one plane of a row. Runs of at least 4 bytes save space. */
static size_t write_plane(const uint8_t *rgbe, uint32_t width, uint32_t c, uint8_t *out) {
  size_t at = 0;
  for (uint32_t x = 0; x < width;) {
    uint32_t run = 1;
    while (run < 127 && x + run < width && rgbe[4 * (x + run) + c] == rgbe[4 * x + c])
      run++;
    if (run >= 4) {
      out[at++] = (uint8_t)(128 + run);
      out[at++] = rgbe[4 * x + c];
      x += run;
      continue;
    }
    uint32_t n = 0;
    size_t count_at = at++;
    while (n < 128 && x < width) {
      uint32_t same = 1;
      while (same < 4 && x + same < width && rgbe[4 * (x + same) + c] == rgbe[4 * x + c])
        same++;
      if (same == 4)
        break;
      out[at++] = rgbe[4 * x++ + c];
      n++;
    }
    out[count_at] = (uint8_t)n;
  }
  return at;
}

vlResult vl_hdr_write(const vlImage *image, VL_UNUSED const vlWriteDef *def,
                      vlFileWriter *writer, vlError *error) {
  uint32_t channel[4], count = vl_image_shown(image, channel);
  vlResult result = VL_OK;
  uint32_t colors = count >= 3 ? 3 : 1, width = image->width;
  float *row = vl_alloc_array(image->context, width, colors * sizeof(float));
  uint8_t *rgbe = vl_alloc_array(image->context, width, 4),
          *packed = vl_alloc_array(image->context, (size_t)width + 16, 5);
  if (row && rgbe && packed) {
    char head[128];
    int n = snprintf(head, sizeof head, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n",
                     image->height, width);
    vl_file_write(writer, head, (size_t)n);
    for (uint32_t y = 0; y < image->height && !writer->failed_errno; y++) {
      vl_image_row_to_float(image, y, channel, colors, row);
      for (uint32_t x = 0; x < width; x++) {
        const float *v = row + (size_t)x * colors;
        const float rgb[3] = {v[0], colors == 3 ? v[1] : v[0], colors == 3 ? v[2] : v[0]};
        to_rgbe(rgb, rgbe + 4 * (size_t)x);
      }
      if (width < 8 || width > 32767) {
        vl_file_write(writer, rgbe, (size_t)width * 4);
        continue;
      }
      const uint8_t start[4] = {2, 2, (uint8_t)(width >> 8), (uint8_t)width};
      memcpy(packed, start, 4);
      size_t size = 4;
      for (uint32_t c = 0; c < 4; c++)
        size += write_plane(rgbe, width, c, packed + size);
      vl_file_write(writer, packed, size);
    }
  } else {
    result = vl_fail_memory(error);
  }
  VL_FREE(image->context, row, rgbe, packed);
  return result;
}
