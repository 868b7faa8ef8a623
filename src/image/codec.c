/* image/codec.c: the table of image formats. Readers are chosen by content, writers by file
 * name suffix. */
#include "image/codec.h"

#include "base/cookie.h"
#include "base/text.h"
#include "image/pixel.h"

/* In probing order. TGA has no signature and comes last. */
static const vlCodec codecs[] = {
    {"OpenEXR", {".exr"}, vl_exr_probe, vl_exr_read, vl_exr_write},
    {"PNG", {".png"}, vl_png_probe, vl_png_read, vl_png_write},
    {"JPEG", {".jpg", ".jpeg"}, vl_jpeg_probe, vl_jpeg_read, vl_jpeg_write},
    {"HDR", {".hdr"}, vl_hdr_probe, vl_hdr_read, vl_hdr_write},
    {"PFM", {".pfm"}, vl_pfm_probe, vl_pfm_read, vl_pfm_write},
    {"PNM", {NULL}, vl_pnm_probe, vl_pnm_read, NULL},
    {"BMP", {NULL}, vl_bmp_probe, vl_bmp_read, NULL},
    {"GIF", {NULL}, vl_gif_probe, vl_gif_read, NULL},
    {"QOI", {NULL}, vl_qoi_probe, vl_qoi_read, NULL},
    {"WebP", {NULL}, vl_webp_probe, vl_webp_read, NULL},
    {"TGA", {".tga"}, vl_tga_probe, vl_tga_read, vl_tga_write},
};

vlResult vl_codec_broken(const vlImageFile *file, const char *what) {
  return vl_fail(file->error, VL_ERROR_SCENE, "%s: broken %s file: %s", file->name,
                 file->format, what);
}

vlResult vl_codec_unsupported(const vlImageFile *file, const char *what) {
  return vl_fail(file->error, VL_ERROR_UNSUPPORTED, "%s: %s file with %s is not supported",
                 file->name, file->format, what);
}

vlResult vl_codec_step(const vlImageFile *file) {
  return vl_task_stopped(file->task, NULL, 0) ? vl_fail(file->error, VL_CANCELLED, "stopped")
                                              : VL_OK;
}

vlResult vl_codec_promise(const vlImageFile *file, uint64_t width, uint64_t height, double need,
                          double ratio) {
  if (width == 0 || height == 0)
    return vl_codec_broken(file, "its image is empty");
  if (need <= ratio * (double)file->size)
    return VL_OK;
  return vl_fail(
      file->error, VL_ERROR_SCENE,
      "%s: broken %s file: promises %llux%llu pixels, more than its %zu bytes can hold",
      file->name, file->format, (unsigned long long)width, (unsigned long long)height,
      file->size);
}

vlResult vl_codec_create(const vlImageFile *file, uint32_t width, uint32_t height,
                         uint32_t channels, vlPixelType type, vlEncoding encoding,
                         vlImage **image) {
  vlImageDef def = vl_default_image_def(width, height, channels);
  def.type = type;
  def.encoding = encoding;
  vlResult result = vl_codec_make(file, &def, image);
  if (result != VL_OK || !file->header)
    return result;
  *file->header = *image;
  *image = NULL;
  return VL_CANCELLED;
}

vlResult vl_codec_make(const vlImageFile *file, const vlImageDef *def, vlImage **image) {
  if (file->max_pixels && (uint64_t)def->width * def->height > file->max_pixels)
    return vl_fail(file->error, VL_ERROR_SCENE,
                   "%s: %ux%u pixels, more than the %llu that a texture may have", file->name,
                   def->width, def->height, (unsigned long long)file->max_pixels);
  vlResult result = vl_image_create_parts(file->context, def, !file->header, image);
  if (result == VL_ERROR_MEMORY)
    return vl_fail(file->error, result, "out of memory: %s has %ux%u pixels of %zu bytes",
                   file->name, def->width, def->height,
                   def->channels * vl_pixel_size(def->type));
  if (result != VL_OK)
    return vl_fail(file->error, result,
                   "%s: an image of %ux%u pixels with these channels is not possible",
                   file->name, def->width, def->height);
  return VL_OK;
}

const char *vl_codec_comment(const vlImage *image) {
  vlAttribute comment;
  if (vl_image_find_attribute(image, "comments", &comment) != VL_OK ||
      comment.type != VL_ATTRIBUTE_STRING)
    return NULL;
  return comment.string;
}

static void row_8bit_from_16(const vlImage *image, uint32_t y, const uint32_t *channel,
                             uint32_t count, uint8_t *result) {
  const uint16_t *row = vl_image_const_row(image, y);
  for (uint32_t x = 0; x < image->width; x++)
    for (uint32_t c = 0; c < count; c++)
      result[(size_t)x * count + c] =
          (uint8_t)((row[(size_t)x * image->channels + channel[c]] * 255u + 32767u) / 65535u);
}

void vl_codec_row_8bit(const vlImage *image, uint32_t y, const uint32_t *channel,
                       uint32_t count, float *scratch, uint8_t *result) {
  if (image->type == VL_PIXEL_U8) {
    const uint8_t *row = vl_image_const_row(image, y);
    for (uint32_t x = 0; x < image->width; x++)
      for (uint32_t c = 0; c < count; c++)
        result[(size_t)x * count + c] = row[(size_t)x * image->channels + channel[c]];
    return;
  }
  if (image->type == VL_PIXEL_U16) {
    row_8bit_from_16(image, y, channel, count, result);
    return;
  }
  vl_image_row_to_float(image, y, channel, count, scratch);
  uint32_t alpha = count == 2 || count == 4 ? count - 1 : count;
  for (uint32_t x = 0; x < image->width; x++)
    for (uint32_t c = 0; c < count; c++) {
      float v = scratch[(size_t)x * count + c];
      result[(size_t)x * count + c] =
          c == alpha ? vl_linear_to_unorm8(v) : vl_linear_to_srgb8(v);
    }
}

/* ---- reading ----------------------------------------------------------------------------- */

static vlResult read_memory(const vlImageFile *f, vlImage **image) {
  *image = NULL;
  vlImageFile file = *f;
  const char *name = file.name;
  size_t size = file.size;
  vlError *error = file.error;
  for (uint32_t i = 0; i < VL_LENGTH(codecs); i++) {
    if (!codecs[i].probe(file.data, size))
      continue;
    file.format = codecs[i].name;
    vlResult result = codecs[i].read(&file, image);
    if (file.header && *file.header) {
      *image = *file.header;
      return VL_OK;
    }
    if (result != VL_OK) {
      vl_image_destroy(*image);
      *image = NULL;
    }
    return result;
  }
  if (size == 0)
    return vl_fail(error, VL_ERROR_SCENE, "%s: empty file, not an image", name);
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: not an image (known are OpenEXR, PNG, JPEG, HDR, PFM, TGA, BMP, GIF, "
                 "PNM, QOI and WebP)",
                 name);
}

vlResult vl_image_decode(vlContext *context, vlTask *task, const char *name, const void *data,
                         size_t size, vlImage **image, vlError *error) {
  vlImageFile file = {.context = context,
                      .name = name,
                      .data = data,
                      .size = size,
                      .error = error,
                      .task = task,
                      .max_pixels = vl_context_max_texture_pixels(context)};
  return read_memory(&file, image);
}

vlResult vl_image_read_memory(vlContext *context, const char *name, const void *data,
                              size_t size, vlImage **image, vlError *error) {
  return vl_image_decode(context, NULL, name, data, size, image, error);
}

vlResult vl_image_read_named(vlContext *context, vlTask *task, const char *path,
                             vlImage **image, vlError *error) {
  vl_error_clear(error);
  *image = NULL;
  char *data;
  size_t size;
  VL_TRY(vl_file_read(context, path, false, &data, &size, error));
  vlResult result = vl_image_decode(context, task, path, data, size, image, error);
  vl_free(context, data);
  return result;
}

static vlResult check_read(vlContext *context, const char *path, vlImage **image,
                           vlError *error) {
  vl_error_clear(error);
  if (image)
    *image = NULL;
  return context && path && image
             ? VL_OK
             : vl_fail_argument(error, "image: context, path or image is null");
}

vlResult vl_image_read_header(vlContext *context, const char *path, vlImage **image,
                              vlError *error) {
  VL_TRY(check_read(context, path, image, error));
  const char *mapped;
  char *data = NULL;
  size_t size;
  vlResult result = vl_file_map(context, path, &mapped, &size, error);
  if (result == VL_OK && !mapped)
    result = vl_file_read_given(context, path, false, &data, &size, error);
  if (result != VL_OK)
    return result;
  vlImage *header = NULL;
  vlImageFile file = {.context = context,
                      .name = path,
                      .data = (const uint8_t *)(mapped ? mapped : data),
                      .size = size,
                      .error = error,
                      .header = &header};
  result = read_memory(&file, image);
  vl_file_unmap(mapped, size);
  vl_free(context, data);
  return result;
}

static vlResult read_file(vlContext *context, const char *path, const char *const *wanted,
                          uint32_t count, vlImage **image, vlError *error) {
  char *data;
  size_t size;
  VL_TRY(vl_file_read_given(context, path, false, &data, &size, error));
  vlImageFile file = {.context = context,
                      .name = path,
                      .data = (const uint8_t *)data,
                      .size = size,
                      .error = error,
                      .wanted = wanted,
                      .wanted_count = count};
  vlResult result = read_memory(&file, image);
  vl_free(context, data);
  return result;
}

vlResult vl_image_read(vlContext *context, const char *path, vlImage **image, vlError *error) {
  VL_TRY(check_read(context, path, image, error));
  return read_file(context, path, NULL, 0, image, error);
}

vlResult vl_image_read_channels(vlContext *context, const char *path, const char *const *names,
                                uint32_t count, vlImage **image, vlError *error) {
  VL_TRY(check_read(context, path, image, error));
  if (!names || !count)
    return vl_fail_argument(error, "image: names is null, or count is 0");
  vlResult result = read_file(context, path, names, count, image, error);
  for (uint32_t i = 0; result == VL_OK && i < count; i++) {
    char only[260]; /* the layer's only channel */
    snprintf(only, sizeof only, "%s.Y", names[i] ? names[i] : "");
    if (names[i] && (vl_image_find_channel(*image, names[i]) >= 0 ||
                     vl_image_find_channel(*image, only) >= 0))
      continue;
    result = vl_fail(error, VL_ERROR_SCENE, "%s: has no channel \"%s\"", path,
                     names[i] ? names[i] : "");
    vl_image_destroy(*image);
    *image = NULL;
  }
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

vlWriteDef vl_default_write_def(void) {
  return (vlWriteDef){
      .cookie = VL_COOKIE_WRITE, .half = false, .compression = 1, .quality = 95};
}

static const vlCodec *codec_of_suffix(const char *path) {
  for (uint32_t i = 0; i < VL_LENGTH(codecs); i++)
    for (uint32_t s = 0; s < 4 && codecs[i].suffixes[s] && codecs[i].write; s++)
      if (vl_ends_with(path, codecs[i].suffixes[s]))
        return &codecs[i];
  return NULL;
}

static vlResult check_write(const vlImage *image, const char *path, const vlWriteDef *def,
                            vlError *error) {
  if (!image || !path)
    return vl_fail_argument(error, "image: image or path is null");
  if (def->cookie != VL_COOKIE_WRITE)
    return vl_fail_argument(error, "image: " VL_BAD_COOKIE);
  if (def->compression < 0 || def->compression > 1 || def->quality < 1 || def->quality > 100)
    return vl_fail_argument(error, "image: compression is 0 or 1, quality 1 to 100");
  vl_error_clear(error);
  return VL_OK;
}

static vlResult finish_write(vlFileWriter *writer, vlResult result, vlError *error) {
  if (result == VL_OK || writer->failed_errno)
    return vl_file_commit(writer, error); /* commit reports the failed write */
  vl_file_abandon(writer);
  return result;
}

/* The codec that writes files of this name; null, with the error set, if there is none. */
static const vlCodec *find_codec(const char *path, vlError *error) {
  const vlCodec *codec = codec_of_suffix(path);
  if (codec)
    return codec;
  const char *names[] = {".exr", ".png", ".jpg", ".jpeg", ".hdr", ".pfm", ".tga"};
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  const char *near = dot && (!slash || dot > slash) ? vl_nearest_name(dot, names, 7) : NULL;
  if (near)
    vl_fail_argument(error, "cannot write %s: unknown suffix (did you mean %s?)", path, near);
  else
    vl_fail_argument(
        error, "cannot write %s: the suffix must be .exr .png .jpg .jpeg .hdr .pfm or .tga",
        path);
  return NULL;
}

vlResult vl_image_write(const vlImage *image, const char *path, const vlWriteDef *write,
                        vlError *error) {
  vlWriteDef def = write ? *write : vl_default_write_def();
  VL_TRY(check_write(image, path, &def, error));
  const vlCodec *codec = find_codec(def.format ? def.format : path, error);
  if (!codec)
    return VL_ERROR_ARGUMENT;
  vlFileWriter writer;
  VL_TRY(vl_file_open_write(&writer, image->context, path, VL_OUTPUT_PLAIN, error));
  return finish_write(&writer, codec->write(image, &def, &writer, error), error);
}

vlResult vl_image_write_memory(const vlImage *image, const char *suffix,
                               const vlWriteDef *write, void **data, size_t *size,
                               vlError *error) {
  if (!data || !size)
    return vl_fail_argument(error, "image: data or size is null");
  *data = NULL;
  *size = 0;
  vlWriteDef def = write ? *write : vl_default_write_def();
  VL_TRY(check_write(image, suffix, &def, error));
  const vlCodec *codec = find_codec(suffix, error);
  if (!codec)
    return VL_ERROR_ARGUMENT;
  vlFileWriter writer;
  vl_file_open_memory(&writer, image->context, suffix);
  vlResult result = codec->write(image, &def, &writer, error);
  if (writer.failed_errno)
    result = vl_fail_memory(error);
  if (result != VL_OK) {
    vl_free(image->context, writer.memory);
    return result;
  }
  *data = writer.memory;
  *size = writer.memory_size;
  return VL_OK;
}

static vlResult check_layers(const vlImage *const *images, uint32_t count, vlError *error) {
  for (uint32_t k = 0; k < count; k++) {
    if (!images[k])
      return vl_fail_argument(error, "image: one of images is null");
    if (images[k]->width != images[0]->width || images[k]->height != images[0]->height)
      return vl_fail_argument(
          error, "cannot write layers of %ux%u and %ux%u pixels into one file",
          images[0]->width, images[0]->height, images[k]->width, images[k]->height);
    for (uint32_t j = 0; j < k; j++)
      for (uint32_t c = 0; c < images[k]->channels; c++)
        if (vl_image_find_channel(images[j], images[k]->names[c]) >= 0)
          return vl_fail_argument(error,
                                  "cannot write two layers with a channel \"%s\" into one file",
                                  images[k]->names[c]);
  }
  return VL_OK;
}

vlResult vl_image_write_layers(const vlImage *const *images, uint32_t count, const char *path,
                               const vlWriteDef *write, vlError *error) {
  vlWriteDef def = write ? *write : vl_default_write_def();
  if (!images || count == 0 || count > 64)
    return vl_fail_argument(error, "image: needs 1 to 64 images");
  VL_TRY(check_write(images[0], path, &def, error));
  VL_TRY(check_layers(images, count, error));
  const vlCodec *codec = codec_of_suffix(def.format ? def.format : path);
  if (!codec || codec->write != vl_exr_write)
    return vl_fail_argument(error, "cannot write layers to %s: only .exr holds them", path);
  vlFileWriter writer;
  VL_TRY(vl_file_open_write(&writer, images[0]->context, path, VL_OUTPUT_PLAIN, error));
  return finish_write(&writer, vl_exr_write_layers(images, count, &def, &writer, error), error);
}
