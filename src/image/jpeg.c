/* image/jpeg.c: JPEG through libjpeg-turbo: grey and colour; CMYK is converted to RGB when
 * read. libjpeg reports errors by longjmp. Damage for which libjpeg only gives a warning is an
 * error, too, since the rest of the image would be grey. */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

/* after stdio */
#include <jerror.h>
#include <jpeglib.h>

#include "base/free.h"
#include "image/codec.h"

typedef struct Jpeg {
  struct jpeg_error_mgr errors; /* first member: libjpeg passes a pointer to it */
  struct jpeg_progress_mgr progress;
  struct jpeg_source_mgr source;
  struct jpeg_destination_mgr destination;
  jmp_buf jump;
  vlFileWriter *writer;
  vlImage *image;
  uint8_t *line;
  float *scratch;
  const vlImageFile *file; /* that is read */
  int code;
  bool stopped; /* by vl_codec_step */
  char message[JMSG_LENGTH_MAX];
  uint8_t buffer[16384];
} Jpeg;

enum {
  MAX_COMMENT = 65533, /* bytes of a marker's text */
  MAX_SCANS = 200      /* of a progressive file; each is a pass over the whole image */
};

bool vl_jpeg_probe(const uint8_t *data, size_t size) {
  return size >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

static void on_exit_error(j_common_ptr info) {
  Jpeg *j = (Jpeg *)(void *)info->err;
  j->code = info->err->msg_code;
  info->err->format_message(info, j->message);
  longjmp(j->jump, 1);
}
static void on_message(j_common_ptr info, int level) {
  if (level >= 0)
    return; /* trace messages */
  int code = info->err->msg_code;
  if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE ||
      code == JWRN_BOGUS_PROGRESSION)
    on_exit_error(info);
}
static void on_output(VL_UNUSED j_common_ptr info) {}
static void on_progress(j_common_ptr info) {
  Jpeg *j = (Jpeg *)(void *)info->err;
  if (j->file && vl_codec_step(j->file) != VL_OK) {
    j->stopped = true;
    longjmp(j->jump, 1);
  }
  if (info->is_decompressor && ((j_decompress_ptr)info)->input_scan_number > MAX_SCANS) {
    info->err->msg_code = JERR_BAD_PROGRESSION;
    snprintf(j->message, sizeof j->message, "too many scans");
    longjmp(j->jump, 1);
  }
}

static void start_errors(Jpeg *j) {
  jpeg_std_error(&j->errors);
  j->errors.error_exit = on_exit_error;
  j->errors.emit_message = on_message;
  j->errors.output_message = on_output;
  j->progress.progress_monitor = on_progress;
}

static void source_none(VL_UNUSED j_decompress_ptr d) {}
static boolean source_fill(j_decompress_ptr d) {
  ERREXIT(d, JERR_INPUT_EOF); /* no more data will come: the whole file is in memory */
  return FALSE;
}
static void source_skip(j_decompress_ptr d, long count) {
  if (count <= 0)
    return;
  if ((size_t)count > d->src->bytes_in_buffer)
    ERREXIT(d, JERR_INPUT_EOF);
  d->src->next_input_byte += count;
  d->src->bytes_in_buffer -= (size_t)count;
}

/* Converts one row of CMYK to RGB. Adobe's programs write inverted CMYK; CMYK of other programs
 * is inverted first. */
static void cmyk_row(const uint8_t *line, uint32_t width, bool inverted, uint8_t *out) {
  for (uint32_t x = 0; x < width; x++) {
    unsigned k = inverted ? line[4 * x + 3] : 255u - line[4 * x + 3];
    for (uint32_t c = 0; c < 3; c++) {
      unsigned ink = inverted ? line[4 * x + c] : 255u - line[4 * x + c];
      out[3 * x + c] = (uint8_t)((ink * k + 127u) / 255u);
    }
  }
}

static vlResult decode(Jpeg *j, struct jpeg_decompress_struct *d, const vlImageFile *file) {
  if (setjmp(j->jump))
    return j->stopped                      ? VL_CANCELLED
           : j->code == JERR_OUT_OF_MEMORY ? vl_fail_memory(file->error)
                                           : vl_codec_broken(file, j->message);
  jpeg_create_decompress(d);
  d->progress = &j->progress;
  j->source = (struct jpeg_source_mgr){.next_input_byte = file->data,
                                       .bytes_in_buffer = file->size,
                                       .init_source = source_none,
                                       .fill_input_buffer = source_fill,
                                       .skip_input_data = source_skip,
                                       .resync_to_restart = jpeg_resync_to_restart,
                                       .term_source = source_none};
  d->src = &j->source;
  jpeg_read_header(d, TRUE);
  if (d->num_components != 1 && d->num_components != 3 && d->num_components != 4)
    return vl_codec_unsupported(file, "this number of components");
  if (d->arith_code)
    return vl_codec_unsupported(file, "arithmetic coding");
  bool cmyk = d->num_components == 4;
  d->out_color_space = cmyk ? JCS_CMYK : d->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  d->dct_method = JDCT_ISLOW;
  uint32_t channels = d->num_components == 1 ? 1 : 3;
  /* Each 8x8 block takes at least one bit, and an MCU of 10 blocks covers at most 32x32 pixels
   * of 3 components. */
  double need = (double)d->image_width * d->image_height * channels;
  VL_TRY(vl_codec_promise(file, d->image_width, d->image_height, need, 2500.0));
  if (file->header) /* jpeg_start_decompress may read all of a progressive file */
    return vl_codec_create(file, d->image_width, d->image_height, channels, VL_PIXEL_U8,
                           VL_ENCODING_SRGB, &j->image);
  jpeg_start_decompress(d);
  VL_TRY(vl_codec_create(file, d->output_width, d->output_height, channels, VL_PIXEL_U8,
                         VL_ENCODING_SRGB, &j->image));
  if (cmyk && !(j->line = vl_alloc_array(file->context, d->output_width, 4)))
    return vl_fail_memory(file->error);
  while (d->output_scanline < d->output_height) {
    uint32_t y = d->output_scanline;
    JSAMPROW row = cmyk ? j->line : vl_image_row(j->image, y);
    jpeg_read_scanlines(d, &row, 1);
    if (cmyk)
      cmyk_row(j->line, d->output_width, d->saw_Adobe_marker, vl_image_row(j->image, y));
  }
  return VL_OK; /* data after the last row is ignored */
}

vlResult vl_jpeg_read(const vlImageFile *file, vlImage **image) {
  Jpeg *j = vl_alloc_zero(file->context, 1, sizeof *j);
  if (!j)
    return vl_fail_memory(file->error);
  struct jpeg_decompress_struct d;
  memset(&d, 0, sizeof d);
  start_errors(j);
  j->file = file;
  d.err = &j->errors;
  vlResult result = decode(j, &d, file);
  jpeg_destroy_decompress(&d);
  vl_free(file->context, j->line);
  if (result == VL_OK)
    *image = j->image;
  else
    vl_image_destroy(j->image);
  vl_free(file->context, j);
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void destination_start(j_compress_ptr c) {
  Jpeg *j = (Jpeg *)(void *)c->err;
  c->dest->next_output_byte = j->buffer;
  c->dest->free_in_buffer = sizeof j->buffer;
}
static boolean destination_empty(j_compress_ptr c) {
  Jpeg *j = (Jpeg *)(void *)c->err;
  vl_file_write(j->writer, j->buffer, sizeof j->buffer);
  destination_start(c);
  return TRUE;
}
static void destination_end(j_compress_ptr c) {
  Jpeg *j = (Jpeg *)(void *)c->err;
  vl_file_write(j->writer, j->buffer, sizeof j->buffer - c->dest->free_in_buffer);
}

static vlResult encode(Jpeg *j, struct jpeg_compress_struct *c, const vlImage *image,
                       const vlWriteDef *def, vlError *error) {
  uint32_t channel[4], count = vl_image_shown(image, channel);
  count = count >= 3 ? 3 : 1; /* JPEG has no alpha */
  if (image->width > JPEG_MAX_DIMENSION || image->height > JPEG_MAX_DIMENSION)
    return vl_fail_argument(error, "cannot write %s: JPEG holds at most %ldx%ld pixels",
                            j->writer->path, (long)JPEG_MAX_DIMENSION,
                            (long)JPEG_MAX_DIMENSION);
  j->line = vl_alloc_array(image->context, image->width, count);
  j->scratch = vl_alloc_array(image->context, image->width, count * sizeof(float));
  if (!j->line || !j->scratch)
    return vl_fail_memory(error);
  if (setjmp(j->jump)) {
    if (j->code == JERR_OUT_OF_MEMORY)
      return vl_fail_memory(error);
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", j->writer->path, j->message);
  }
  jpeg_create_compress(c);
  j->destination = (struct jpeg_destination_mgr){.init_destination = destination_start,
                                                 .empty_output_buffer = destination_empty,
                                                 .term_destination = destination_end};
  c->dest = &j->destination;
  c->image_width = image->width;
  c->image_height = image->height;
  c->input_components = (int)count;
  c->in_color_space = count == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(c);
  jpeg_set_quality(c, def->quality, TRUE);
  c->dct_method = JDCT_ISLOW;
  if (def->quality >= 90 && count == 3) /* no chroma subsampling at high quality */
    c->comp_info[0].h_samp_factor = c->comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(c, TRUE);
  const char *comment = vl_codec_comment(image);
  size_t length = comment ? strlen(comment) : 0;
  if (length)
    jpeg_write_marker(c, JPEG_COM, (const JOCTET *)comment,
                      (unsigned)(length < MAX_COMMENT ? length : MAX_COMMENT));
  while (c->next_scanline < c->image_height) {
    vl_codec_row_8bit(image, c->next_scanline, channel, count, j->scratch, j->line);
    JSAMPROW row = j->line;
    jpeg_write_scanlines(c, &row, 1);
  }
  jpeg_finish_compress(c);
  return VL_OK;
}

vlResult vl_jpeg_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer,
                       vlError *error) {
  Jpeg *j = vl_alloc_zero(image->context, 1, sizeof *j);
  if (!j)
    return vl_fail_memory(error);
  struct jpeg_compress_struct c;
  memset(&c, 0, sizeof c);
  start_errors(j);
  c.err = &j->errors;
  j->writer = writer;
  vlResult result = encode(j, &c, image, def, error);
  jpeg_destroy_compress(&c);
  VL_FREE(image->context, j->line, j->scratch, j);
  return result;
}
