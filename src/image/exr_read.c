/* image/exr_read.c: reads OpenEXR through OpenEXRCore: the first part, scanlines or tiles
 * (finest level), all compressions. The image is the data window. When the display window
 * differs, both are kept as attributes.
 *
 * Channel order: R G B A (Y A) first, then the others in file order (alphabetical). All
 * channels get one type: half or integer when all channels of the file have it, otherwise
 * float. */

#include "base/bytes.h"
#include "base/error.h"
#include "base/free.h"
#include "base/text.h"
#include "image/exr.h"
#include "image/exr_dwa.h"
#include "image/pixel.h"

typedef struct Reader {
  vlExr base;
  exr_context_t exr;
  const exr_attr_chlist_t *list;
  exr_attr_box2i_t window;
  exr_compression_t compression;
  uint32_t width, height;
  uint32_t *target; /* for each channel of the file, its channel in the image or NOT_WANTED */
  uint32_t count;   /* number of the image's channels */
  int user_type, user_size;
  vlImage *image;
  exr_decode_pipeline_t pipeline;
  bool started;
  bool dwa; /* DWA, decoded by exr_dwa.c */
  vlDwaChannel *dwa_channels;
  uint16_t *dwa_curve;
  uint8_t *packed, *unpacked;
  size_t packed_size, unpacked_size;
  /* rows per chunk, or the size of a tile */
  bool tiled;
  int32_t lines, tile_width, tile_height;
} Reader;

#define NOT_WANTED UINT32_MAX

bool vl_exr_probe(const uint8_t *data, size_t size) {
  return size >= 4 && memcmp(data, "\x76\x2f\x31\x01", 4) == 0;
}

static int64_t on_read(VL_UNUSED exr_const_context_t exr, void *user, void *buffer,
                       uint64_t size, uint64_t offset,
                       VL_UNUSED exr_stream_error_func_ptr_t fail) {
  const vlImageFile *file = ((vlExr *)user)->file;
  if (offset >= file->size)
    return 0;
  uint64_t left = file->size - offset;
  if (size > left)
    size = left;
  memcpy(buffer, file->data + offset, size);
  return (int64_t)size;
}

static int64_t on_size(VL_UNUSED exr_const_context_t exr, void *user) {
  return (int64_t)((vlExr *)user)->file->size;
}

/* Offset of the byte after the zero-terminated text of 1 to 255 characters at `at`; 0 when
 * there is none. */
static size_t after_text(const vlImageFile *file, size_t at) {
  size_t end = at;
  while (end < file->size && end - at < 256 && file->data[end])
    end++;
  return end > at && end < file->size && !file->data[end] ? end + 1 : 0;
}

/* OpenEXRCore allocates whatever size an attribute claims before it checks the file. Therefore
 * this function first walks the headers (several in a multi-part file) and checks for each
 * attribute that its bytes lie in the file. An attribute is a name, a type, a size and that
 * many bytes. */
static bool headers_fit(const vlImageFile *file) {
  if (file->size < 9)
    return false;
  bool parts = vl_little32(file->data + 4) & 0x1000u;
  size_t at = 8;
  do {
    while (at < file->size && file->data[at]) {
      size_t type = after_text(file, at), size_at = type ? after_text(file, type) : 0;
      if (!size_at || file->size - size_at < 4)
        return false;
      uint32_t size = vl_little32(file->data + size_at);
      at = size_at + 4;
      if (size > file->size - at)
        return false;
      /* width, height, four bytes per pixel */
      if (vl_text_is((const char *)file->data + type, "preview")) {
        if (size < 8 ||
            (double)vl_little32(file->data + at) * vl_little32(file->data + at + 4) * 4.0 >
                size - 8.0)
          return false;
      }
      at += size;
    }
    if (at >= file->size)
      return false;
    at++;
  } while (parts && at < file->size && file->data[at]);
  return true;
}

static vlResult fail(Reader *r, exr_result_t code) {
  /* The PIZ decoder reports "out of memory" for damaged data, too; the message tells the two
   * apart. */
  bool damaged = strncmp(r->base.message, "Unable to decompress", 20) == 0;
  bool refused =
      vl_text_is(r->base.message,
                 exr_get_default_error_message(EXR_ERR_OUT_OF_MEMORY)); /* hidden by `code` */
  if ((code == EXR_ERR_OUT_OF_MEMORY && !damaged) || refused)
    return vl_fail_memory(r->base.file->error);
  return vl_codec_broken(
      r->base.file, r->base.message[0] ? r->base.message : exr_get_default_error_message(code));
}

/* Sort key of a channel: colours first. */
static uint32_t rank(const char *name) {
  static const char *const FRONT[] = {"R", "G", "B", "Y", "A"};
  for (uint32_t i = 0; i < 5; i++)
    if (vl_text_is(name, FRONT[i]))
      return i;
  return 5;
}

static bool is_only_channel(const char *layer, const char *name) {
  size_t n = strlen(layer);
  return strncmp(layer, name, n) == 0 && strcmp(name + n, ".Y") == 0;
}

/* "id.object" stands for the channel "id.object.Y", too: ids as other programs show them. */
static bool is_wanted(const vlImageFile *file, const char *name) {
  for (uint32_t i = 0; i < file->wanted_count; i++)
    if (vl_text_is(file->wanted[i], name) || is_only_channel(file->wanted[i], name))
      return true;
  return !file->wanted;
}

static double ratio(const Reader *r) {
  return r->dwa ? 16384.0 : 1032.0;
}

/* How the file is stored: scanlines or tiles, its compression, the list of channels. */
static vlResult read_storage(Reader *r) {
  const vlImageFile *file = r->base.file;
  exr_storage_t storage;
  exr_result_t code = exr_get_storage(r->exr, 0, &storage);
  if (code == EXR_ERR_SUCCESS)
    code = exr_get_data_window(r->exr, 0, &r->window);
  if (code == EXR_ERR_SUCCESS)
    code = exr_get_compression(r->exr, 0, &r->compression);
  if (code == EXR_ERR_SUCCESS)
    code = exr_get_channels(r->exr, 0, &r->list);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
    return vl_codec_unsupported(file, "deep pixels");
  r->tiled = storage == EXR_STORAGE_TILED;
  if ((unsigned)r->compression >= EXR_COMPRESSION_LAST_TYPE)
    return vl_codec_broken(file, "unknown compression");
  r->dwa = r->compression == EXR_COMPRESSION_DWAA || r->compression == EXR_COMPRESSION_DWAB;
  if (r->list->num_channels < 1)
    return vl_codec_broken(file, "no channels");
  if (r->list->num_channels > 1024)
    return vl_codec_unsupported(file, "more than 1024 channels");
  return VL_OK;
}

/* Counts the channels that are wanted and finds the type that holds them; bytes: of a pixel of
 * all channels. */
static vlResult read_channels(Reader *r, uint32_t *bytes) {
  const vlImageFile *file = r->base.file;
  *bytes = 0;
  uint32_t halves = 0, integers = 0, count = (uint32_t)r->list->num_channels;
  for (uint32_t i = 0; i < count; i++) {
    const exr_attr_chlist_entry_t *c = &r->list->entries[i];
    if (c->x_sampling != 1 || c->y_sampling != 1)
      return vl_codec_unsupported(file, "subsampled channels");
    if (!c->name.str || !c->name.str[0] || c->name.length > 255)
      return vl_codec_broken(file, "a channel without a name");
    if ((unsigned)c->pixel_type >= EXR_PIXEL_LAST_TYPE)
      return vl_codec_broken(file, "unknown pixel type");
    *bytes += c->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    if (!is_wanted(file, c->name.str))
      continue;
    r->count++;
    halves += c->pixel_type == EXR_PIXEL_HALF;
    integers += c->pixel_type == EXR_PIXEL_UINT;
  }
  if (r->count == 0)
    return vl_fail(file->error, VL_ERROR_SCENE, "%s: has no channel \"%s\"", file->name,
                   file->wanted[0] ? file->wanted[0] : "");
  r->user_type = halves == r->count     ? EXR_PIXEL_HALF
                 : integers == r->count ? EXR_PIXEL_UINT
                                        : EXR_PIXEL_FLOAT;
  r->user_size = halves == r->count ? 2 : 4;
  if (r->user_type == EXR_PIXEL_FLOAT && integers)
    vl_log(file->context, VL_LOG_INFO, NULL,
           "%s: integers beside floats are read as floats, exact up to 2^24", file->name);
  return VL_OK;
}

static vlResult read_chunks(Reader *r) {
  const vlImageFile *file = r->base.file;
  int32_t chunks;
  exr_result_t code = exr_get_chunk_count(r->exr, 0, &chunks);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  if (chunks < 1 || (uint64_t)chunks * 8 > file->size)
    return vl_codec_promise(file, r->width, r->height, 8.0 * chunks, 0.0);
  if (r->tiled)
    code = exr_get_tile_sizes(r->exr, 0, 0, 0, &r->tile_width, &r->tile_height);
  else
    code = exr_get_scanlines_per_chunk(r->exr, 0, &r->lines);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  if (r->tiled ? r->tile_width < 1 || r->tile_height < 1 : r->lines < 1)
    return vl_codec_broken(file, "empty chunks");
  return VL_OK;
}

static vlResult layout(Reader *r) {
  const vlImageFile *file = r->base.file;
  uint32_t bytes;
  VL_TRY(read_storage(r));
  VL_TRY(read_channels(r, &bytes));
  int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1,
          height = (int64_t)r->window.max.y - r->window.min.y + 1;
  if (width < 1 || height < 1)
    return vl_codec_broken(file, "its data window is empty");
  if (width > INT32_MAX / (r->user_size * (int64_t)r->list->num_channels) || height > INT32_MAX)
    return vl_codec_unsupported(file, "rows of more than 2^31 bytes");
  /* Best compression ratios: 1032:1 for deflate; for DWA one value per block of 64 and run
   * lengths. Each chunk is checked below, too. */
  VL_TRY(vl_codec_promise(file, (uint64_t)width, (uint64_t)height,
                          (double)width * (double)height * bytes, ratio(r)));
  r->width = (uint32_t)width;
  r->height = (uint32_t)height;
  return read_chunks(r);
}

/* Finds the chunk at column and row of the grid. Checks that it lies in the file and that its
 * compression ratio is possible. */
static vlResult find_chunk(Reader *r, uint32_t column, uint32_t row, exr_chunk_info_t *chunk) {
  exr_result_t code =
      r->tiled ? exr_read_tile_chunk_info(r->exr, 0, (int)column, (int)row, 0, 0, chunk)
               : exr_read_scanline_chunk_info(r->exr, 0, r->window.min.y + (int)row * r->lines,
                                              chunk);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  const vlImageFile *file = r->base.file;
  if (chunk->data_offset > file->size || chunk->packed_size > file->size - chunk->data_offset ||
      chunk->packed_size == 0)
    return vl_codec_broken(file, "a chunk lies outside the file");
  if ((double)chunk->unpacked_size > (double)chunk->packed_size * ratio(r) + 64.0)
    return vl_codec_broken(file, "a chunk is too small for its pixels");
  int64_t left = (int64_t)r->width - (r->tiled ? (int64_t)column * r->tile_width : 0);
  int64_t below = (int64_t)r->height - (int64_t)row * (r->tiled ? r->tile_height : r->lines);
  if (chunk->width < 1 || chunk->width > left || chunk->height < 1 || chunk->height > below)
    return vl_codec_broken(file, "a chunk of the wrong size");
  return VL_OK;
}

/* Grows a block to at least `size` bytes. */
static bool grow(Reader *r, uint8_t **block, size_t *have, size_t size) {
  if (*have >= size)
    return true;
  vl_free(r->base.file->context, *block);
  *block = vl_alloc(r->base.file->context, size);
  *have = *block ? size : 0;
  return *block != NULL;
}

static vlResult start_dwa(Reader *r) {
  vlContext *context = r->base.file->context;
  r->dwa_curve = vl_alloc_array(context, 65536, sizeof *r->dwa_curve);
  r->dwa_channels =
      vl_alloc_array(context, (size_t)r->list->num_channels, sizeof *r->dwa_channels);
  if (!r->dwa_curve || !r->dwa_channels)
    return vl_fail_memory(r->base.file->error);
  vl_dwa_make_curve(r->dwa_curve);
  for (int i = 0; i < r->list->num_channels; i++) {
    const exr_attr_chlist_entry_t *c = &r->list->entries[i];
    r->dwa_channels[i] = (vlDwaChannel){c->name.str, (int)c->pixel_type, c->p_linear != 0};
  }
  return VL_OK;
}

/* Converts a value of the file to one of the image. */
static void convert_value(int from, const uint8_t *p, int to, void *result) {
  if (from == to) {
    memcpy(result, p, from == EXR_PIXEL_HALF ? 2 : 4);
    return;
  }
  uint16_t half = 0; /* the types differ, so the image holds floats */
  uint32_t integer = 0;
  memcpy(&half, p, 2);
  if (from == EXR_PIXEL_UINT)
    memcpy(&integer, p, 4);
  float value = from == EXR_PIXEL_HALF ? vl_half_to_float(half) : (float)integer;
  memcpy(result, &value, 4);
}

static vlResult decode_dwa_chunk(Reader *r, const exr_chunk_info_t *chunk, char *origin) {
  const vlImageFile *file = r->base.file;
  if (!r->dwa_channels) {
    VL_TRY(start_dwa(r));
  }
  uint32_t count = (uint32_t)r->list->num_channels;
  size_t line = 0;
  for (uint32_t i = 0; i < count; i++)
    line += (size_t)chunk->width * (r->dwa_channels[i].type == EXR_PIXEL_HALF ? 2u : 4u);
  size_t size = line * (size_t)chunk->height;
  if (size != chunk->unpacked_size)
    return vl_codec_broken(file, "a chunk of the wrong size");
  if (!grow(r, &r->packed, &r->packed_size, (size_t)chunk->packed_size) ||
      !grow(r, &r->unpacked, &r->unpacked_size, size))
    return vl_fail_memory(file->error);
  exr_result_t code = exr_read_chunk(r->exr, 0, chunk, r->packed);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  vlResult result = VL_OK;
  if (chunk->packed_size == size) /* incompressible chunks are stored uncompressed */
    memcpy(r->unpacked, r->packed, size);
  else
    result = vl_dwa_unpack(file->context, r->dwa_channels, count, (uint32_t)chunk->width,
                           (uint32_t)chunk->height, r->dwa_curve, r->packed,
                           (size_t)chunk->packed_size, r->unpacked);
  if (result == VL_ERROR_MEMORY)
    return vl_fail_memory(file->error);
  if (result != VL_OK)
    return vl_codec_broken(file, "a DWA chunk is damaged");
  const uint8_t *from = r->unpacked;
  size_t pixel = (size_t)r->user_size * r->count;
  for (int32_t y = 0; y < chunk->height; y++)
    for (uint32_t i = 0; i < count; i++) {
      size_t step = r->dwa_channels[i].type == EXR_PIXEL_HALF ? 2 : 4;
      if (r->target[i] == NOT_WANTED) {
        from += step * (size_t)chunk->width;
        continue;
      }
      char *to = origin + (size_t)y * pixel * r->width + (size_t)r->user_size * r->target[i];
      for (int32_t x = 0; x < chunk->width; x++, from += step, to += pixel)
        convert_value(r->dwa_channels[i].type, from, r->user_type, to);
    }
  return VL_OK;
}

static vlResult decode_chunk(Reader *r, uint32_t column, uint32_t row) {
  exr_chunk_info_t chunk;
  VL_TRY(vl_codec_step(r->base.file));
  VL_TRY(find_chunk(r, column, row, &chunk));
  size_t pixel = (size_t)r->user_size * r->image->channels, line = pixel * r->width;
  char *origin =
      (char *)r->image->pixels +
      (r->tiled ? row * (size_t)r->tile_height * line + column * (size_t)r->tile_width * pixel
                : row * (size_t)r->lines * line);
  if (r->dwa)
    return decode_dwa_chunk(r, &chunk, origin);
  exr_decode_pipeline_t *p = &r->pipeline;
  exr_result_t code = r->started ? exr_decoding_update(r->exr, 0, &chunk, p)
                                 : exr_decoding_initialize(r->exr, 0, &chunk, p);
  if (code != EXR_ERR_SUCCESS)
    return fail(r, code);
  for (int i = 0; i < p->channel_count; i++) {
    exr_coding_channel_info_t *c = &p->channels[i];
    c->decode_to_ptr = NULL; /* not read */
    if (r->target[i] == NOT_WANTED)
      continue;
    c->decode_to_ptr = (uint8_t *)origin + (size_t)r->user_size * r->target[i];
    c->user_bytes_per_element = (int16_t)r->user_size;
    c->user_data_type = (uint16_t)r->user_type;
    c->user_pixel_stride = (int32_t)pixel;
    c->user_line_stride = (int32_t)line;
  }
  if (!r->started) {
    r->started = true;
    code = exr_decoding_choose_default_routines(r->exr, 0, p);
    if (code != EXR_ERR_SUCCESS)
      return fail(r, code);
  }
  code = exr_decoding_run(r->exr, 0, p);
  return code == EXR_ERR_SUCCESS ? VL_OK : fail(r, code);
}

static vlResult create(Reader *r) {
  vlContext *context = r->base.file->context;
  uint32_t count = (uint32_t)r->list->num_channels, next = 0;
  r->target = vl_alloc_array(context, count, sizeof *r->target);
  const char **names = vl_alloc_array(context, count, sizeof *names);
  vlResult result = r->target && names ? VL_OK : VL_ERROR_MEMORY;
  for (uint32_t i = 0; result == VL_OK && i < count; i++)
    r->target[i] = NOT_WANTED;
  for (uint32_t k = 0; result == VL_OK && k <= 5; k++)
    for (uint32_t i = 0; i < count; i++) {
      const char *name = r->list->entries[i].name.str;
      if (rank(name) != k || next >= r->count || !is_wanted(r->base.file, name))
        continue;
      names[next] = name;
      r->target[i] = next++;
    }
  if (result == VL_OK) {
    vlImageDef def = vl_default_image_def(r->width, r->height, r->count);
    def.names = names;
    def.type = r->user_type == EXR_PIXEL_HALF   ? VL_PIXEL_F16
               : r->user_type == EXR_PIXEL_UINT ? VL_PIXEL_U32
                                                : VL_PIXEL_F32;
    result = vl_codec_make(r->base.file, &def, &r->image);
    if (result != VL_OK) {
      vl_free(context, names);
      return result;
    }
  }
  vl_free(context, names);
  if (result == VL_OK && !(r->image->stored = vl_alloc_zero(context, r->count, 1)))
    result = VL_ERROR_MEMORY;
  for (uint32_t i = 0; result == VL_OK && i < count; i++) {
    exr_pixel_type_t type = r->list->entries[i].pixel_type;
    if (r->target[i] == NOT_WANTED)
      continue;
    r->image->stored[r->target[i]] = type == EXR_PIXEL_HALF   ? VL_PIXEL_F16
                                     : type == EXR_PIXEL_UINT ? VL_PIXEL_U32
                                                              : VL_PIXEL_F32;
  }
  if (result == VL_OK)
    result = vl_exr_attributes_in(r->exr, r->image);
  if (result == VL_OK && r->base.file->header) {
    *r->base.file->header = r->image;
    r->image = NULL;
    return VL_CANCELLED;
  }
  if (result == VL_ERROR_MEMORY)
    return vl_fail_memory(r->base.file->error);
  return result == VL_OK ? VL_OK
                         : vl_codec_broken(r->base.file, "its channels are not possible");
}

static vlResult read_all(Reader *r) {
  vlResult result = layout(r);
  uint32_t step_x = r->tiled ? (uint32_t)r->tile_width : r->width,
           step_y = (uint32_t)(r->tiled ? r->tile_height : r->lines);
  /* Checks that all chunks exist before the pixels are allocated. */
  for (uint32_t pass = r->base.file->header ? 1 : 0; pass < 2 && result == VL_OK; pass++) {
    if (pass == 1)
      result = create(r);
    for (uint64_t y = 0, row = 0; y < r->height && result == VL_OK; y += step_y, row++)
      for (uint64_t x = 0, column = 0; x < r->width && result == VL_OK; x += step_x, column++) {
        exr_chunk_info_t chunk;
        result = pass ? decode_chunk(r, (uint32_t)column, (uint32_t)row)
                      : find_chunk(r, (uint32_t)column, (uint32_t)row, &chunk);
      }
  }
  return result;
}

vlResult vl_exr_read(const vlImageFile *file, vlImage **image) {
  if (!headers_fit(file))
    return vl_codec_broken(file, "ends in its header, or the header is damaged");
  Reader r;
  memset(&r, 0, sizeof r);
  r.base.file = file;
  atomic_flag_clear(&r.base.failed);
  exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
  start.error_handler_fn = vl_exr_on_error;
  start.user_data = &r.base;
  start.read_fn = on_read;
  start.size_fn = on_size;
  start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  exr_result_t code = exr_start_read(&r.exr, file->name, &start);
  vlResult result = code == EXR_ERR_SUCCESS ? read_all(&r) : fail(&r, code);
  if (r.started)
    exr_decoding_destroy(r.exr, &r.pipeline);
  exr_finish(&r.exr);
  VL_FREE(file->context, r.target, r.dwa_channels, r.dwa_curve, r.packed, r.unpacked);
  if (result == VL_OK)
    *image = r.image;
  else
    vl_image_destroy(r.image);
  return result;
}
