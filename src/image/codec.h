/* image/codec.h: the table of image file formats. A reader converts bytes in memory to an
 * image. A writer converts an image to bytes of a vlFileWriter. Messages start with the file's
 * name. */
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
  const char *format;  /* of the codec that reads it, for messages */
  const uint8_t *data; /* the file's bytes, followed by a zero byte */
  size_t size;
  vlError *error;
  /* names of the channels to read; null: all. Used by OpenEXR only */
  const char *const *wanted;
  uint32_t wanted_count;
  uint64_t max_pixels; /* limit of the image's size; 0: none */
  vlTask *task;        /* of the load or the build that reads the file; null: none */
  vlImage **header; /* not null: only the header is read; vl_codec_create stores an image here
                       and stops the reader */
} vlImageFile;

/* Whether the bytes are a file of the format. */
typedef bool vlCodecProbe(const uint8_t *data, size_t size);
/* Reads the file into *image, which the caller destroys. Errors: SCENE for broken files,
 * UNSUPPORTED, MEMORY, CANCELLED. */
typedef vlResult vlCodecRead(const vlImageFile *file, vlImage **image);
/* Appends the image as a file of the format; vl_file_commit is the caller's. */
typedef vlResult vlCodecWrite(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer,
                              vlError *error);

typedef struct vlCodec {
  const char *name; /* for messages: "PNG" */
  /* file name suffixes with the dot, for writing; the list ends with null */
  const char *suffixes[4];
  vlCodecProbe *probe;
  vlCodecRead *read;
  vlCodecWrite *write; /* null: the format is read only */
} vlCodec;

/* Reports a SCENE error: "name: broken PNG file: <what>". */
vlResult vl_codec_broken(const vlImageFile *file, const char *what);
/* Reports an UNSUPPORTED error: "name: PNG file with <what> is not supported". */
vlResult vl_codec_unsupported(const vlImageFile *file, const char *what);
/* CANCELLED, reported, if the load or the build must stop; decoders call it for each row or
 * chunk. */
vlResult vl_codec_step(const vlImageFile *file);
/* Checks the image's size before memory is allocated. need: bytes of the pixels. ratio: the
 * largest number of these bytes that one byte of the file can encode. The result is a SCENE
 * error when the file is too small ("promises WxH pixels, more than its N bytes can hold") or
 * the image is empty. */
vlResult vl_codec_promise(const vlImageFile *file, uint64_t width, uint64_t height, double need,
                          double ratio);
/* Makes an image with default channel names and reports errors. Returns CANCELLED when only the
 * header is read; the decoder then stops. */
vlResult vl_codec_create(const vlImageFile *file, uint32_t width, uint32_t height,
                         uint32_t channels, vlPixelType type, vlEncoding encoding,
                         vlImage **image);

/* Like vl_codec_create, for any image def. */
vlResult vl_codec_make(const vlImageFile *file, const vlImageDef *def, vlImage **image);

/* Converts row y of the displayed channels (vl_image_shown) to 8 bits. 8-bit values are copied,
 * 16-bit values rounded, and other values sRGB-encoded, except alpha, which stays linear.
 * scratch has room for width*count floats. */
void vl_codec_row_8bit(const vlImage *image, uint32_t y, const uint32_t *channel,
                       uint32_t count, float *scratch, uint8_t *result);

/* The text that PNG, JPEG and TGA hold: the attribute "comments", OpenEXR's name. Null: there
 * is none. */
const char *vl_codec_comment(const vlImage *image);

vlCodecProbe vl_exr_probe, vl_png_probe, vl_jpeg_probe, vl_hdr_probe, vl_pfm_probe,
    vl_tga_probe, vl_bmp_probe, vl_gif_probe, vl_pnm_probe, vl_qoi_probe, vl_webp_probe;
vlCodecRead vl_exr_read, vl_png_read, vl_jpeg_read, vl_hdr_read, vl_pfm_read, vl_tga_read,
    vl_bmp_read, vl_gif_read, vl_pnm_read, vl_qoi_read, vl_webp_read;
vlCodecWrite vl_exr_write, vl_png_write, vl_jpeg_write, vl_hdr_write, vl_pfm_write,
    vl_tga_write;
/* Writes `count` images of one size as the parts of one OpenEXR file. */
vlResult vl_exr_write_layers(const vlImage *const *images, uint32_t count,
                             const vlWriteDef *def, vlFileWriter *writer, vlError *error);

#endif
