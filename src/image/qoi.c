/* image/qoi.c: reads the Quite OK Image format (Szablewski, qoiformat.org). */
#include <string.h>

#include "base/bytes.h"
#include "image/codec.h"

bool vl_qoi_probe(const uint8_t *data, size_t size) {
  return size >= 14 && memcmp(data, "qoif", 4) == 0;
}

vlResult vl_qoi_read(const vlImageFile *file, vlImage **image) {
  const uint8_t *d = file->data;
  const uint32_t width = (uint32_t)vl_big(d + 4, 4), height = (uint32_t)vl_big(d + 8, 4),
                 channels = d[12];
  if (channels != 3 && channels != 4)
    return vl_codec_broken(file, "neither 3 nor 4 channels");
  /* one byte encodes a run of up to 62 pixels */
  vlResult result = vl_codec_promise(file, width, height, (double)width * height, 62.0);
  vlEncoding encoding = d[13] == 1 ? VL_ENCODING_LINEAR : VL_ENCODING_SRGB;
  if (result == VL_OK)
    result = vl_codec_create(file, width, height, channels, VL_PIXEL_U8, encoding, image);
  if (result != VL_OK)
    return result;
  uint8_t seen[64][4], pixel[4] = {0, 0, 0, 255}, *out = (*image)->pixels;
  memset(seen, 0, sizeof seen);
  size_t at = 14, count = (size_t)width * height;
  uint32_t run = 0;
  for (size_t i = 0; i < count; i++, out += channels) {
    if (run) {
      run--;
    } else {
      if (at >= file->size)
        return vl_codec_broken(file, "ends too early");
      uint8_t b = d[at++];
      uint32_t more = b == 0xfe ? 3 : b == 0xff ? 4 : b >> 6 == 2 ? 1 : 0;
      if (more > file->size - at)
        return vl_codec_broken(file, "ends too early");
      if (b >= 0xfe) {
        memcpy(pixel, d + at, more);
      } else if (b >> 6 == 0) {
        memcpy(pixel, seen[b], 4);
      } else if (b >> 6 == 1) {
        pixel[0] = (uint8_t)(pixel[0] + (b >> 4 & 3) - 2);
        pixel[1] = (uint8_t)(pixel[1] + (b >> 2 & 3) - 2);
        pixel[2] = (uint8_t)(pixel[2] + (b & 3) - 2);
      } else if (b >> 6 == 2) {
        int green = (b & 63) - 32;
        pixel[0] = (uint8_t)(pixel[0] + green + (d[at] >> 4) - 8);
        pixel[1] = (uint8_t)(pixel[1] + green);
        pixel[2] = (uint8_t)(pixel[2] + green + (d[at] & 15) - 8);
      } else {
        run = b & 63;
      }
      at += more;
      memcpy(seen[(pixel[0] * 3 + pixel[1] * 5 + pixel[2] * 7 + pixel[3] * 11) % 64], pixel, 4);
    }
    memcpy(out, pixel, channels);
  }
  return VL_OK;
}
