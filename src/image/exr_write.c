/* image/exr_write.c: writes OpenEXR through OpenEXRCore: one part of scanlines, ZIP or
 * uncompressed. A fixed compression level and no time stamp give the same bytes for the same
 * image, whatever the number of threads. Halves are written for half images or, on request, for
 * the colours (R G B A Y, also of layers: "diffuse.R"); 8 and 16-bit images are written as
 * linear light. Several images of one size become one file with all their channels. */

#include "base/free.h"
#include "base/text.h"
#include "image/exr.h"
#include "image/pixel.h"

/* A chunk being written: its rows in the type of the file, then compressed. */
typedef struct Slot {
  exr_encode_pipeline_t pipeline;
  bool started;
  char *lines; /* rows of the chunk, channel by channel */
  float *row;  /* one row of one channel, as floats */
  exr_result_t code;
} Slot;

enum { MAX_SLOTS = 64 };
/* OpenEXRCore writes a header in about 200 small pieces. Consecutive ones are gathered and
 * written at once. */
enum { GATHERED = 1 << 16 };
/* Images up to this many bytes are not compressed: deflate would take longer than rendering
 * them and save at most a few disk blocks. */
enum { SMALL = 1 << 16 };

/* A channel of the file: the image that it comes from and its index there. */
typedef struct Channel {
  const vlImage *image;
  uint32_t index;
  exr_pixel_type_t type;
} Channel;

typedef struct Writer {
  vlExr base;
  const vlImage *image; /* the first image, which gives the context and the attributes */
  exr_context_t exr;
  Channel *channels;
  uint32_t count;
  int32_t lines_per_chunk, first_y;
  uint32_t first_chunk;
  uint32_t slot_count;
  Slot *slots;
  bool alone;     /* single-threaded */
  char *gathered; /* GATHERED bytes, of which `taken` are used */
  size_t taken;
  uint64_t offset; /* position of gathered[0] in the file */
} Writer;

static void flush(Writer *w) {
  if (w->taken)
    vl_file_write_at(w->base.writer, w->gathered, w->taken, w->offset);
  w->taken = 0;
}

static int64_t on_write(VL_UNUSED exr_const_context_t exr, void *user, const void *buffer,
                        uint64_t size, uint64_t offset,
                        VL_UNUSED exr_stream_error_func_ptr_t fail) {
  Writer *w = user; /* the vlExr is the first member of Writer */
  if (offset != w->offset + w->taken || size > GATHERED - w->taken)
    flush(w);
  if (size > GATHERED) {
    vl_file_write_at(w->base.writer, buffer, size, offset);
  } else {
    if (!w->taken)
      w->offset = offset;
    memcpy(w->gathered + w->taken, buffer, size);
    w->taken += size;
  }
  return w->base.writer->failed_errno ? -1 : (int64_t)size;
}

static vlResult fail(Writer *w, exr_result_t code, vlError *error) {
  if (code == EXR_ERR_OUT_OF_MEMORY)
    return vl_fail_memory(error);
  return vl_fail(error, w->base.writer->failed_errno ? VL_ERROR_IO : VL_ERROR_ARGUMENT,
                 "cannot write %s: %s", w->base.writer->path,
                 exr_get_default_error_message(code));
}

static bool is_color(const char *name) {
  const char *last = vl_last_part(name);
  return last[0] && strchr("RGBAY", last[0]) && !last[1];
}

/* A finite value too large for a half stays finite. */
static uint16_t to_half(float v) {
  if (v > 65504.0f && v <= 3.4028235e38f)
    v = 65504.0f;
  if (v < -65504.0f && v >= -3.4028235e38f)
    v = -65504.0f;
  return vl_float_to_half(v);
}

static const char *channel_name(const Channel *c) {
  return c->image->names[c->index];
}

static const Channel *find_channel(const Writer *w, const char *name) {
  for (uint32_t i = 0; i < w->count; i++)
    if (vl_text_is(channel_name(&w->channels[i]), name))
      return &w->channels[i];
  return NULL;
}

static vlResult header(Writer *w, const vlWriteDef *def, vlError *error) {
  const vlImage *image = w->image;
  if (image->width > INT32_MAX / 4 || image->height > INT32_MAX / 2)
    return vl_fail_argument(error, "cannot write %s: too large for OpenEXR",
                            w->base.writer->path);
  int part;
  bool packed =
      def->compression && (uint64_t)image->width * image->height * w->count * 4 > SMALL;
  exr_result_t code = exr_add_part(w->exr, NULL, EXR_STORAGE_SCANLINE, &part);
  if (code == EXR_ERR_SUCCESS)
    code = exr_initialize_required_attr_simple(
        w->exr, 0, (int32_t)image->width, (int32_t)image->height,
        packed ? EXR_COMPRESSION_ZIP : EXR_COMPRESSION_NONE);
  bool long_names = false;
  for (uint32_t i = 0; i < w->count; i++)
    long_names |= strlen(channel_name(&w->channels[i])) > 31;
  for (size_t i = 0; i < image->attributes.count; i++)
    long_names |= strlen(image->attributes.items[i].name) > 31;
  if (code == EXR_ERR_SUCCESS && long_names)
    code = exr_set_longname_support(w->exr, 1);
  for (uint32_t i = 0; i < w->count && code == EXR_ERR_SUCCESS; i++) {
    Channel *c = &w->channels[i];
    const char *name = channel_name(c);
    vlPixelType type = c->image->type;
    bool half = type == VL_PIXEL_F16 ||
                (def->half && c->image == image && type != VL_PIXEL_U32 && is_color(name));
    c->type = type == VL_PIXEL_U32 ? EXR_PIXEL_UINT : half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    code = exr_add_channel(w->exr, 0, name, c->type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  }
  if (code != EXR_ERR_SUCCESS)
    return fail(w, code, error);
  VL_TRY(vl_exr_attributes_out(w->exr, image, error));
  code = exr_write_header(w->exr);
  if (code == EXR_ERR_SUCCESS)
    code = exr_get_scanlines_per_chunk(w->exr, 0, &w->lines_per_chunk);
  return code == EXR_ERR_SUCCESS ? VL_OK : fail(w, code, error);
}

/* Converts one row of a channel to the type of the file. */
static void fill_row(const Channel *c, Slot *slot, uint32_t y, char *to) {
  const vlImage *image = c->image;
  uint32_t n = image->width, step = image->channels, channel = c->index;
  if (image->type == VL_PIXEL_U32) {
    const uint32_t *from = (const uint32_t *)vl_image_const_row(image, y) + channel;
    uint32_t *out = (uint32_t *)(void *)to;
    for (uint32_t x = 0; x < n; x++)
      out[x] = from[(size_t)x * step];
  } else if (image->type == VL_PIXEL_F16) {
    const uint16_t *from = (const uint16_t *)vl_image_const_row(image, y) + channel;
    uint16_t *out = (uint16_t *)(void *)to;
    for (uint32_t x = 0; x < n; x++)
      out[x] = from[(size_t)x * step];
  } else if (c->type == EXR_PIXEL_HALF) {
    uint16_t *out = (uint16_t *)(void *)to;
    vl_image_row_to_float(image, y, &channel, 1, slot->row);
    for (uint32_t x = 0; x < n; x++)
      out[x] = to_half(slot->row[x]);
  } else {
    vl_image_row_to_float(image, y, &channel, 1, (float *)(void *)to);
  }
}

/* Replaces OpenEXRCore's write step, so that the compressed bytes stay in the pipeline. */
static exr_result_t keep(VL_UNUSED exr_encode_pipeline_t *pipeline) {
  return EXR_ERR_SUCCESS;
}

static exr_result_t pack_chunk(const Writer *w, Slot *slot, uint32_t first) {
  exr_chunk_info_t chunk;
  exr_encode_pipeline_t *p = &slot->pipeline;
  exr_result_t code =
      exr_write_scanline_chunk_info(w->exr, 0, w->first_y + (int32_t)first, &chunk);
  if (code != EXR_ERR_SUCCESS)
    return code;
  code = slot->started ? exr_encoding_update(w->exr, 0, &chunk, p)
                       : exr_encoding_initialize(w->exr, 0, &chunk, p);
  if (code != EXR_ERR_SUCCESS)
    return code;
  size_t line = (size_t)w->image->width * 4;
  for (int i = 0; i < p->channel_count; i++) {
    exr_coding_channel_info_t *c = &p->channels[i];
    const Channel *channel = find_channel(w, c->channel_name);
    if (!channel)
      return EXR_ERR_INVALID_ARGUMENT;
    char *at = slot->lines + (size_t)i * (size_t)w->lines_per_chunk * line;
    for (int32_t k = 0; k < chunk.height; k++)
      fill_row(channel, slot, first + (uint32_t)k, at + (size_t)k * line);
    c->encode_from_ptr = (const uint8_t *)at;
    c->user_pixel_stride = c->bytes_per_element;
    c->user_line_stride = (int32_t)line;
    c->user_bytes_per_element = c->bytes_per_element;
    c->user_data_type = c->data_type;
  }
  if (!slot->started) {
    slot->started = true;
    code = exr_encoding_choose_default_routines(w->exr, 0, p);
    if (code != EXR_ERR_SUCCESS)
      return code;
    p->yield_until_ready_fn = keep;
    p->write_fn = keep;
  }
  return exr_encoding_run(w->exr, 0, p);
}

static void pack_body(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  Writer *w = user;
  w->slots[index].code =
      pack_chunk(w, &w->slots[index], (w->first_chunk + index) * (uint32_t)w->lines_per_chunk);
}

static vlResult write_chunks(Writer *w, vlError *error) {
  uint32_t lines = (uint32_t)w->lines_per_chunk,
           chunks = (w->image->height + lines - 1) / lines;
  for (w->first_chunk = 0; w->first_chunk < chunks; w->first_chunk += w->slot_count) {
    uint32_t count =
        chunks - w->first_chunk < w->slot_count ? chunks - w->first_chunk : w->slot_count;
    if (w->alone)
      for (uint32_t i = 0; i < count; i++)
        pack_body(w, i, 0);
    else
      vl_parallel_for(w->image->context, count, pack_body, w);
    for (uint32_t i = 0; i < count; i++) {
      const exr_encode_pipeline_t *p = &w->slots[i].pipeline;
      exr_result_t code = w->slots[i].code;
      /* of as many bytes as before, readers take them for uncompressed ones */
      bool packed =
          p->compressed_buffer && p->compressed_bytes && p->compressed_bytes < p->packed_bytes;
      int y = w->first_y + (int)((w->first_chunk + i) * lines);
      if (code == EXR_ERR_SUCCESS)
        code = exr_write_scanline_chunk(w->exr, 0, y,
                                        packed ? p->compressed_buffer : p->packed_buffer,
                                        packed ? p->compressed_bytes : p->packed_bytes);
      if (code != EXR_ERR_SUCCESS)
        return fail(w, code, error);
    }
  }
  return VL_OK;
}

static vlResult write_all(Writer *w, const vlWriteDef *def, vlError *error) {
  VL_TRY(header(w, def, error));
  const vlImage *image = w->image;
  exr_attr_box2i_t window;
  exr_result_t code = exr_get_data_window(w->exr, 0, &window);
  if (code != EXR_ERR_SUCCESS)
    return fail(w, code, error);
  w->first_y = window.min.y;
  uint32_t chunks = (image->height - 1) / (uint32_t)w->lines_per_chunk + 1,
           wish = def->alone ? 1 : 2 * vl_context_threads(image->context);
  w->slot_count = wish < chunks ? wish : chunks;
  if (w->slot_count > MAX_SLOTS)
    w->slot_count = MAX_SLOTS;
  w->slots = vl_alloc_zero(image->context, w->slot_count, sizeof *w->slots);
  if (!w->slots)
    return vl_fail_memory(error);
  for (uint32_t i = 0; i < w->slot_count; i++) {
    Slot *slot = &w->slots[i];
    slot->lines = vl_alloc_array(image->context, (size_t)w->lines_per_chunk * w->count,
                                 (size_t)image->width * 4);
    slot->row = vl_alloc_array(image->context, image->width, sizeof *slot->row);
    if (!slot->lines || !slot->row)
      return vl_fail_memory(error);
  }
  return write_chunks(w, error);
}

static void free_slots(Writer *w) {
  for (uint32_t i = 0; w->slots && i < w->slot_count; i++) {
    if (w->slots[i].started)
      exr_encoding_destroy(w->exr, &w->slots[i].pipeline);
    VL_FREE(w->image->context, w->slots[i].lines, w->slots[i].row);
  }
  vl_free(w->image->context, w->slots);
}

vlResult vl_exr_write(const vlImage *image, const vlWriteDef *def, vlFileWriter *writer,
                      vlError *error) {
  return vl_exr_write_layers(&image, 1, def, writer, error);
}

/* Ignores an error. OpenEXR calls this handler while it holds the lock of its context, so
 * vl_exr_on_error cannot be used: reading the user data would take the lock again. */
static void ignore_error(VL_UNUSED exr_const_context_t context, VL_UNUSED exr_result_t code,
                         VL_UNUSED const char *message) {}

vlResult vl_exr_write_layers(const vlImage *const *images, uint32_t count,
                             const vlWriteDef *def, vlFileWriter *writer, vlError *error) {
  const vlImage *image = images[0];
  Writer w;
  memset(&w, 0, sizeof w);
  w.base.writer = writer;
  w.image = image;
  w.alone = def->alone;
  for (uint32_t k = 0; k < count; k++)
    w.count += images[k]->channels;
  w.channels = vl_alloc_array(image->context, w.count, sizeof *w.channels);
  w.gathered = vl_alloc(image->context, GATHERED);
  if (!w.channels || !w.gathered) {
    VL_FREE(image->context, w.channels, w.gathered);
    return vl_fail_memory(error);
  }
  for (uint32_t k = 0, at = 0; k < count; k++)
    for (uint32_t i = 0; i < images[k]->channels; i++)
      w.channels[at++] = (Channel){images[k], i, EXR_PIXEL_FLOAT};
  exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
  start.error_handler_fn = ignore_error;
  start.user_data = &w.base;
  start.write_fn = on_write;
  start.zip_level = 4;
  exr_result_t code = exr_start_write(&w.exr, writer->path, EXR_WRITE_FILE_DIRECTLY, &start);
  vlResult result = code == EXR_ERR_SUCCESS ? write_all(&w, def, error) : fail(&w, code, error);
  free_slots(&w);
  if (w.exr) {
    code = exr_finish(&w.exr); /* writes the chunk table */
    if (result == VL_OK && code != EXR_ERR_SUCCESS)
      result = fail(&w, code, error);
  }
  if (result == VL_OK)
    flush(&w); /* the writer reports a failure when it is closed */
  VL_FREE(image->context, w.gathered, w.channels);
  return result;
}
