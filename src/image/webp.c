/* image/webp.c: reads WebP through libwebp: lossy and lossless, with and without alpha; no
 * animations. */
#include <string.h>

/* after string */
#include <webp/decode.h>

#include "image/codec.h"

/* Images up to this size are accepted from files of any size, since an image of one colour
 * takes almost no bytes. */
enum { BELIEVED = 1 << 24 };

bool vl_webp_probe(const uint8_t *data, size_t size) {
  return size >= 16 && memcmp(data, "RIFF", 4) == 0 && memcmp(data + 8, "WEBP", 4) == 0;
}

vlResult vl_webp_read(const vlImageFile *file, vlImage **image) {
  WebPBitstreamFeatures f;
  VP8StatusCode code = WebPGetFeatures(file->data, file->size, &f);
  if (code == VP8_STATUS_OUT_OF_MEMORY)
    return vl_fail_memory(file->error);
  if (code != VP8_STATUS_OK)
    return vl_codec_broken(
        file, code == VP8_STATUS_NOT_ENOUGH_DATA ? "ends too early" : "its header");
  if (f.has_animation)
    return vl_codec_unsupported(file, "animation");
  if (f.width <= 0 || f.height <= 0)
    return vl_codec_broken(file, "its size");
  uint32_t width = (uint32_t)f.width, height = (uint32_t)f.height,
           channels = f.has_alpha ? 4 : 3;
  double need = (double)width * height * channels;
  VL_TRY(vl_codec_promise(file, width, height, need > BELIEVED ? need : 0.0, 20000.0));
  VL_TRY(vl_codec_create(file, width, height, channels, VL_PIXEL_U8, VL_ENCODING_SRGB, image));
  size_t bytes = (size_t)width * height * channels;
  uint8_t *pixels = vl_image_pixels(*image);
  int stride = (int)(width * channels);
  const uint8_t *done = channels == 4
                            ? WebPDecodeRGBAInto(file->data, file->size, pixels, bytes, stride)
                            : WebPDecodeRGBInto(file->data, file->size, pixels, bytes, stride);
  return done ? VL_OK : vl_codec_broken(file, "its pixels do not decode, or it ends too early");
}
