/* image/codec.h: the table of image file formats. A reader converts bytes in memory to an image. A writer converts an
 * image to bytes of a vlFileWriter. Messages start with the file's name. */
#ifndef IMAGE_CODEC_H
#define IMAGE_CODEC_H

#include "base/cancel.h"
#include "base/error.h"
#include "base/file.h"
#include "image/image.h"

/* A file being read. */
typedef struct vlImageFile {
  vlContext *context;
  const char *name;
  const uint8_t *data; /* the file's bytes, followed by a zero byte */
  size_t size;
  vlError *error;
  const char *const *wanted; /* names of the channels to read; null: all. Used by OpenEXR only */
  uint32_t wanted_count;
  uint64_t most_pixels; /* limit of the image's size; 0: none */
  vlTask *task;         /* of the load or the build that reads the file; null: none */
  vlImage **header; /* not null: only the header is read; vl_codec_create stores an image here and stops the reader */
} vlImageFile;

typedef struct vlCodec {
  const char *name;        /* for messages: "PNG" */
  const char *suffixes[4]; /* file name suffixes with the dot, for writing; the list ends with null */
  bool (*probe)(const uint8_t *data, size_t size);
  vlResult (*read)(const vlImageFile *file, vlImage **image);
  vlResult (*write)(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer,
                    vlError *error); /* null: the format is read only */
} vlCodec;

extern const vlCodec vl_codecs[];
extern const uint32_t vl_codec_count;

/* Reports a SCENE error: "name: broken PNG file: <what>". */
vlResult vl_codec_broken(const vlImageFile *file, const char *format, const char *what);
/* Reports an UNSUPPORTED error: "name: PNG file with <what> is not supported". */
vlResult vl_codec_unsupported(const vlImageFile *file, const char *format, const char *what);
/* CANCELLED, reported, if the load or the build must stop; decoders call it for each row or chunk. */
vlResult vl_codec_step(const vlImageFile *file);
/* Checks the image's size before memory is allocated. need: bytes of the pixels. ratio: the largest number of these
 * bytes that one byte of the file can encode. The result is a SCENE error when the file is too small ("promises WxH
 * pixels, more than its N bytes can hold") or the image is empty. */
vlResult vl_codec_promise(const vlImageFile *file, const char *format, uint64_t width, uint64_t height, double need,
                          double ratio);
/* Makes an image with default channel names and reports errors. Returns CANCELLED when only the header is read; the
 * decoder then stops. */
vlResult vl_codec_create(const vlImageFile *file, uint32_t width, uint32_t height, uint32_t channels, vlPixelType type,
                         vlEncoding encoding, vlImage **image);

/* Like vl_codec_create, for any image def. */
vlResult vl_codec_make(const vlImageFile *file, const vlImageDef *def, vlImage **image);

/* Converts row y of the displayed channels (vl_image_shown) to 8 bits. 8-bit values are copied, 16-bit values rounded,
 * and other values sRGB-encoded, except alpha, which stays linear. scratch has room for width*count floats. */
void vl_codec_row_8bit(const vlImage *image, uint32_t y, const uint32_t *channel, uint32_t count, float *scratch,
                       uint8_t *result);

vlResult vl_exr_read(const vlImageFile *file, vlImage **image);
vlResult vl_exr_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
vlResult vl_exr_write_layers(const vlImage *const *images, uint32_t count, const vlWriteDef *def, vlFileWriter *writer,
                             vlError *error);
bool vl_exr_probe(const uint8_t *data, size_t size);
vlResult vl_png_read(const vlImageFile *file, vlImage **image);
vlResult vl_png_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
bool vl_png_probe(const uint8_t *data, size_t size);
vlResult vl_jpeg_read(const vlImageFile *file, vlImage **image);
vlResult vl_jpeg_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
bool vl_jpeg_probe(const uint8_t *data, size_t size);
vlResult vl_hdr_read(const vlImageFile *file, vlImage **image);
vlResult vl_hdr_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
bool vl_hdr_probe(const uint8_t *data, size_t size);
vlResult vl_pfm_read(const vlImageFile *file, vlImage **image);
vlResult vl_pfm_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
bool vl_pfm_probe(const uint8_t *data, size_t size);
vlResult vl_tga_read(const vlImageFile *file, vlImage **image);
vlResult vl_tga_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer, vlError *error);
bool vl_tga_probe(const uint8_t *data, size_t size);
vlResult vl_bmp_read(const vlImageFile *file, vlImage **image);
bool vl_bmp_probe(const uint8_t *data, size_t size);
vlResult vl_gif_read(const vlImageFile *file, vlImage **image);
bool vl_gif_probe(const uint8_t *data, size_t size);
vlResult vl_pnm_read(const vlImageFile *file, vlImage **image);
bool vl_pnm_probe(const uint8_t *data, size_t size);
vlResult vl_qoi_read(const vlImageFile *file, vlImage **image);
bool vl_qoi_probe(const uint8_t *data, size_t size);
vlResult vl_webp_read(const vlImageFile *file, vlImage **image);
bool vl_webp_probe(const uint8_t *data, size_t size);

#endif
