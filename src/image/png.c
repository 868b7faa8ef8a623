/* image/png.c: PNG through libpng: 8 and 16 bits. Palettes and grey of fewer bits are expanded;
 * transparency becomes alpha. libpng reports errors by longjmp, so values that are used
 * afterwards are in the Png struct, not in local variables. */
#include <png.h>
#include <setjmp.h>
#include <string.h>

#include "base/bytes.h"
#include "base/free.h"
#include "image/codec.h"

typedef struct Png {
  vlContext *context;
  const vlImageFile *file;
  size_t at;
  vlFileWriter *writer;
  png_structp png;
  png_infop info;
  png_bytep *rows;
  vlImage *image;
  uint8_t *line;
  float *scratch;
  bool memory;  /* an allocation failed */
  bool stopped; /* by vl_codec_step */
  char message[128];
} Png;

bool vl_png_probe(const uint8_t *data, size_t size) {
  return size >= 8 && memcmp(data, "\211PNG\r\n\032\n", 8) == 0;
}

static void on_error(png_structp png, png_const_charp message) {
  Png *p = png_get_error_ptr(png);
  strncpy(p->message, message, sizeof p->message - 1);
  png_longjmp(png, 1);
}
static void on_warning(VL_UNUSED png_structp png, VL_UNUSED png_const_charp message) {}
static png_voidp on_alloc(png_structp png, png_alloc_size_t size) {
  Png *p = png_get_mem_ptr(png);
  void *block = vl_alloc(p->context, size);
  if (!block)
    p->memory = true;
  return block;
}
static void on_free(png_structp png, png_voidp block) {
  vl_free(((Png *)png_get_mem_ptr(png))->context, block);
}
static void on_read(png_structp png, png_bytep bytes, size_t size) {
  Png *p = png_get_io_ptr(png);
  if (size > p->file->size - p->at)
    png_error(png, "ends too early");
  if (vl_codec_step(p->file) != VL_OK) {
    p->stopped = true;
    png_error(png, "stopped");
  }
  memcpy(bytes, p->file->data + p->at, size);
  p->at += size;
}
static void on_write(png_structp png, png_bytep bytes, size_t size) {
  Png *p = png_get_io_ptr(png);
  vl_file_write(p->writer, bytes, size);
  if (p->writer->failed_errno)
    png_error(png, "write failed");
}
static void on_flush(VL_UNUSED png_structp png) {}

/* A gamma of exactly 1 means linear. Anything else is taken as sRGB, as in other renderers. */
static bool says_linear(Png *p) {
  png_fixed_point gamma;
  return !png_get_valid(p->png, p->info, PNG_INFO_sRGB) &&
         !png_get_valid(p->png, p->info, PNG_INFO_iCCP) &&
         png_get_gAMA_fixed(p->png, p->info, &gamma) && gamma == 100000;
}

/* libpng allocates what a chunk promises before it reads it. This checks that the file holds
 * the chunks. The image data may be cut off: its header is still read. */
static const char *check_chunks(const vlImageFile *file) {
  for (size_t at = 8; at + 12 <= file->size;) {
    const uint8_t *c = file->data + at;
    const uint64_t length = vl_big(c, 4);
    if (memcmp(c + 4, "IDAT", 4) == 0 || memcmp(c + 4, "IEND", 4) == 0)
      return NULL;
    if (length > file->size - at - 12)
      return "a chunk is longer than the file";
    at += 12 + (size_t)length;
  }
  return NULL;
}

/* Texts, profiles and the like are skipped: only what tells the encoding of the values is
 * read. */
static void ignore_chunks(Png *p) {
  static const png_byte wanted[] = "gAMA\0sRGB\0iCCP";
  png_set_keep_unknown_chunks(p->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
  png_set_keep_unknown_chunks(p->png, PNG_HANDLE_CHUNK_AS_DEFAULT, wanted, 3);
}

static vlResult decode(Png *p) {
  const vlImageFile *file = p->file;
  const char *broken = check_chunks(file);
  if (broken)
    return vl_codec_broken(file, broken);
  if (setjmp(png_jmpbuf(p->png)))
    return p->stopped  ? VL_CANCELLED
           : p->memory ? vl_fail_memory(file->error)
                       : vl_codec_broken(file, p->message);
  png_set_read_fn(p->png, p, on_read);
  /* the size is checked below against the file's size */
  png_set_user_limits(p->png, 0x7fffffff, 0x7fffffff);
  png_set_chunk_malloc_max(p->png, 8u << 20);
  png_set_chunk_cache_max(p->png, 16);
  ignore_chunks(p);
  png_read_info(p->png, p->info);
  uint32_t width = png_get_image_width(p->png, p->info),
           height = png_get_image_height(p->png, p->info);
  int depth = png_get_bit_depth(p->png, p->info), kind = png_get_color_type(p->png, p->info);
  bool alpha = (kind & PNG_COLOR_MASK_ALPHA) || png_get_valid(p->png, p->info, PNG_INFO_tRNS);
  /* Deflate expands by at most 1032:1. */
  double stored = ((double)png_get_rowbytes(p->png, p->info) + 1.0) * height;
  VL_TRY(vl_codec_promise(file, width, height, stored, 1032.0));

  png_set_expand(p->png);
  if (depth == 16)
    png_set_swap(p->png); /* files are big-endian */
  int passes = png_set_interlace_handling(p->png);
  png_read_update_info(p->png, p->info);
  uint32_t channels = (kind & PNG_COLOR_MASK_COLOR ? 3u : 1u) + (alpha ? 1u : 0u);
  VL_TRY(vl_codec_create(file, width, height, channels,
                         depth == 16 ? VL_PIXEL_U16 : VL_PIXEL_U8,
                         says_linear(p) ? VL_ENCODING_LINEAR : VL_ENCODING_SRGB, &p->image));
  if (png_get_rowbytes(p->png, p->info) != vl_image_row_size(p->image))
    return vl_codec_broken(file, "odd rows");
  if (passes == 1) {
    for (uint32_t y = 0; y < height; y++)
      png_read_row(p->png, vl_image_row(p->image, y), NULL);
  } else {
    p->rows = vl_alloc_array(p->context, height, sizeof *p->rows);
    if (!p->rows)
      return vl_fail_memory(file->error);
    for (uint32_t y = 0; y < height; y++)
      p->rows[y] = vl_image_row(p->image, y);
    png_read_image(p->png, p->rows);
  }
  return VL_OK;
}

vlResult vl_png_read(const vlImageFile *file, vlImage **image) {
  Png p = {.context = file->context, .file = file};
  p.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &p, on_error, on_warning, &p,
                                   on_alloc, on_free);
  p.info = p.png ? png_create_info_struct(p.png) : NULL;
  vlResult result = p.info ? decode(&p) : vl_fail_memory(file->error);
  png_destroy_read_struct(&p.png, &p.info, NULL);
  vl_free(p.context, p.rows);
  if (result == VL_OK)
    *image = p.image;
  else
    vl_image_destroy(p.image);
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void swap_row(const uint16_t *from, const vlImage *image, const uint32_t *channel,
                     uint32_t count, uint8_t *line) {
  for (uint32_t x = 0; x < image->width; x++)
    for (uint32_t c = 0; c < count; c++) {
      uint16_t v = from[(size_t)x * image->channels + channel[c]];
      *line++ = (uint8_t)(v >> 8);
      *line++ = (uint8_t)v;
    }
}

/* A chunk tEXt, or iTXt if the text is more than ASCII. */
static void set_comment(Png *p, const vlImage *image) {
  const char *comment = vl_codec_comment(image);
  if (!comment)
    return;
  bool ascii = true;
  for (const char *c = comment; *c; c++)
    ascii = ascii && (unsigned char)*c < 0x80;
  char key[] = "Comment";
  png_text text = {.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
                   .key = key,
                   .text = (char *)(uintptr_t)comment}; /* is not changed */
  png_set_text(p->png, p->info, &text, 1);
}

static vlResult encode(Png *p, const vlImage *image, vlError *error) {
  static const int KINDS[5] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                               PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
  uint32_t channel[4], count = vl_image_shown(image, channel);
  if (setjmp(png_jmpbuf(p->png))) {
    if (p->memory)
      return vl_fail_memory(error);
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", p->writer->path, p->message);
  }
  bool deep = image->type == VL_PIXEL_U16;
  png_set_write_fn(p->png, p, on_write, on_flush);
  png_set_user_limits(p->png, 0x7fffffff, 0x7fffffff);
  png_set_compression_level(p->png, 6); /* fixed, so that the same image gives the same bytes */
  png_set_IHDR(p->png, p->info, image->width, image->height, deep ? 16 : 8, KINDS[count],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  bool integer = image->type == VL_PIXEL_U8 || deep;
  if (integer && image->encoding == VL_ENCODING_LINEAR)
    png_set_gAMA_fixed(p->png, p->info, 100000);
  else if (integer && image->encoding == VL_ENCODING_GAMMA)
    png_set_gAMA(p->png, p->info, 1.0 / image->gamma);
  else
    png_set_sRGB(p->png, p->info, PNG_sRGB_INTENT_PERCEPTUAL);
  set_comment(p, image);
  png_write_info(p->png, p->info);
  p->line = vl_alloc_array(p->context, image->width, count * (deep ? 2u : 1u));
  p->scratch = vl_alloc_array(p->context, image->width, count * sizeof(float));
  if (!p->line || !p->scratch)
    return vl_fail_memory(error);
  for (uint32_t y = 0; y < image->height; y++) {
    if (deep)
      swap_row(vl_image_const_row(image, y), image, channel, count, p->line);
    else
      vl_codec_row_8bit(image, y, channel, count, p->scratch, p->line);
    png_write_row(p->png, p->line);
  }
  png_write_end(p->png, NULL);
  return VL_OK;
}

vlResult vl_png_write(const vlImage *image, VL_UNUSED const vlWriteDef *def,
                      vlFileWriter *writer, vlError *error) {
  Png p = {.context = image->context, .writer = writer};
  p.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &p, on_error, on_warning, &p,
                                    on_alloc, on_free);
  p.info = p.png ? png_create_info_struct(p.png) : NULL;
  vlResult result = p.info ? encode(&p, image, error) : vl_fail_memory(error);
  png_destroy_write_struct(&p.png, &p.info);
  VL_FREE(p.context, p.line, p.scratch);
  return result;
}
