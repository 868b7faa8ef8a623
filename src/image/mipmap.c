/* image/mipmap.c: see mipmap.h. */
#include "image/mipmap.h"

#include <string.h>

#include "base/free.h"
#include "color/color.h"
#include "image/pixel.h"

enum { STARTS = 4096 };

typedef struct Builder {
  vlMipmap *map;
  float begin[4][256]; /* [c][code]: the smallest linear value whose nearest code is `code` */
  uint8_t start[4][STARTS]; /* [c][i]: code at i / STARTS, where the search starts */
  bool one_table;           /* all channels have the same decoding */
  float *column;            /* one row: weighted sum of source rows */
  float *line;              /* one decoded row */
  vlTask *task;             /* null: none */
} Builder;

size_t vl_mipmap_bytes(const vlMipmap *map) {
  size_t total = sizeof *map;
  for (uint32_t i = 0; i < map->level_count; i++)
    total += (size_t)map->levels[i].width * map->levels[i].height * map->channels *
             (map->is_bytes ? 1 : 4);
  return total;
}

void vl_mipmap_destroy(vlMipmap *map) {
  if (!map)
    return;
  for (uint32_t i = 0; i < map->level_count; i++)
    VL_FREE(map->context, vl_owned(map->levels[i].bytes), vl_owned(map->levels[i].floats));
  vl_free(map->context, map);
}

/* The code nearest to v. v lies in [0, 1], as means of decoded bytes do. */
static uint8_t nearest_code(const Builder *b, uint32_t channel, float v) {
  uint32_t i = (uint32_t)(v * STARTS), code = b->start[channel][i < STARTS ? i : STARTS - 1];
  while (code < 255 && v >= b->begin[channel][code + 1])
    code++;
  return (uint8_t)code;
}

static void make_tables(Builder *b, const vlImage *image, const vlMipmapDef *def) {
  vlMipmap *map = b->map;
  for (uint32_t c = 0; c < map->channels; c++) {
    vlEncoding encoding = def->own_encoding ? def->encoding : image->encoding;
    float gamma = def->own_encoding ? def->gamma : image->gamma;
    if (vl_is_alpha(image->names[def->channel[c]]))
      encoding = VL_ENCODING_LINEAR;
    vl_decode_table(encoding, gamma, map->decode[c]);
    for (int i = 1; i < 256; i++)
      b->begin[c][i] = encoding == VL_ENCODING_SRGB
                           ? vl_srgb8_begin[i]
                           : (float)vl_decode(encoding, gamma, (i - 0.5) / 255.0);
    for (uint32_t i = 0, code = 0; i < STARTS; i++) {
      while (code < 255 && (float)i / STARTS >= b->begin[c][code + 1])
        code++;
      b->start[c][i] = (uint8_t)code;
    }
  }
  b->one_table = true;
  for (uint32_t c = 1; c < map->channels; c++)
    b->one_table &= memcmp(map->decode[0], map->decode[c], sizeof map->decode[0]) == 0;
}

/* Decodes row y of a 16-bit image by the encoding in def. */
static void row_16bit(const vlImage *image, const vlMipmapDef *def, uint32_t y, float *out) {
  const uint16_t *row = vl_image_const_row(image, y);
  for (uint32_t c = 0; c < def->count; c++) {
    vlEncoding encoding =
        vl_is_alpha(image->names[def->channel[c]]) ? VL_ENCODING_LINEAR : def->encoding;
    for (uint32_t x = 0; x < image->width; x++)
      out[(size_t)x * def->count + c] = (float)vl_decode(
          encoding, def->gamma, row[(size_t)x * image->channels + def->channel[c]] / 65535.0);
  }
}

static vlResult finest_level(vlMipmap *map, const vlImage *image, const vlMipmapDef *def) {
  uint32_t n = map->channels;
  size_t row = (size_t)image->width * n;
  void *block =
      vl_alloc_array(map->context, row * image->height, map->is_bytes ? 1 : sizeof(float));
  if (!block)
    return VL_ERROR_MEMORY;
  vlMipLevel *level = &map->levels[map->level_count++];
  *level = (vlMipLevel){image->width, image->height, map->is_bytes ? block : NULL,
                        map->is_bytes ? NULL : block};
  for (uint32_t y = 0; y < image->height; y++) {
    if (vl_task_stopped(def->task, NULL, 0))
      return VL_CANCELLED;
    if (map->is_bytes) {
      const uint8_t *from = vl_image_const_row(image, y);
      uint8_t *to = (uint8_t *)block + row * y;
      for (uint32_t x = 0; x < image->width; x++)
        for (uint32_t c = 0; c < n; c++)
          to[(size_t)x * n + c] = from[(size_t)x * image->channels + def->channel[c]];
    } else if (image->type == VL_PIXEL_U16 && def->own_encoding) {
      row_16bit(image, def, y, (float *)block + row * y);
    } else {
      vl_image_row_to_float(image, y, def->channel, n, (float *)block + row * y);
    }
  }
  return VL_OK;
}

/* The weight of source cell i in destination cell d when `from` cells are resampled to `to`. */
static float share(uint32_t i, uint32_t d, uint32_t from, uint32_t to) {
  double low = (double)d * from / to, high = (double)(d + 1) * from / to;
  double a = i > low ? i : low, b = i + 1.0 < high ? i + 1.0 : high;
  return b > a ? (float)((b - a) * to / from) : 0.0f;
}

/* Row y of the source as floats: from the floats of the level before when they exist, otherwise
 * decoded from the finest level. */
static const float *source_row(Builder *b, const vlMipLevel *from, const float *floats,
                               uint32_t y) {
  uint32_t n = b->map->channels;
  size_t row = (size_t)from->width * n;
  if (floats)
    return floats + row * y;
  const uint8_t *bytes = from->bytes + row * y;
  if (b->one_table) {
    for (size_t i = 0; i < row; i++)
      b->line[i] = b->map->decode[0][bytes[i]];
    return b->line;
  }
  for (uint32_t c = 0; c < n; c++)
    for (uint32_t x = 0; x < from->width; x++)
      b->line[(size_t)x * n + c] = b->map->decode[c][bytes[(size_t)x * n + c]];
  return b->line;
}

/* Halves the width of a row of sums (or keeps a width of 1): two texels each. */
static void shrink_pairs(const float *column, uint32_t width, uint32_t n, float *out) {
  for (uint32_t x = 0; x < width; x++)
    for (uint32_t c = 0; c < n; c++)
      out[(size_t)x * n + c] =
          0.5f * column[(size_t)2 * x * n + c] + 0.5f * column[((size_t)2 * x + 1) * n + c];
}

/* False: stopped. */
static bool shrink(Builder *b, const vlMipLevel *from, const float *floats, uint32_t width,
                   uint32_t height, float *out) {
  uint32_t n = b->map->channels;
  size_t row = (size_t)from->width * n;
  for (uint32_t y = 0; y < height; y++, out += (size_t)width * n) {
    if (vl_task_stopped(b->task, NULL, 0))
      return false;
    uint32_t first = (uint32_t)((uint64_t)y * from->height / height);
    uint32_t last = (uint32_t)(((uint64_t)(y + 1) * from->height + height - 1) / height);
    for (uint32_t i = first; i < last; i++) {
      float w = share(i, y, from->height, height);
      const float *line = source_row(b, from, floats, i);
      if (i == first)
        for (size_t k = 0; k < row; k++)
          b->column[k] = w * line[k];
      else
        for (size_t k = 0; k < row; k++)
          b->column[k] += w * line[k];
    }
    if (from->width == 2 * width) {
      shrink_pairs(b->column, width, n, out);
      continue;
    }
    for (uint32_t x = 0; x < width; x++) {
      uint32_t left = (uint32_t)((uint64_t)x * from->width / width);
      uint32_t right = (uint32_t)(((uint64_t)(x + 1) * from->width + width - 1) / width);
      float *to = out + (size_t)x * n;
      for (uint32_t c = 0; c < n; c++)
        to[c] = 0.0f;
      for (uint32_t i = left; i < right; i++) {
        float w = share(i, x, from->width, width);
        for (uint32_t c = 0; c < n; c++)
          to[c] += w * b->column[(size_t)i * n + c];
      }
    }
  }
  return true;
}

/* Rounds the means to codes. */
static void store_codes(const Builder *b, const float *floats, size_t count, uint8_t *bytes) {
  const uint32_t n = b->map->channels;
  for (size_t i = 0; i < count; i += n)
    for (uint32_t c = 0; c < n; c++)
      bytes[i + c] = nearest_code(b, c, floats[i + c]);
}

/* Makes the next coarser level. *kept holds the floats of the level before (null for 8-bit
 * level 0) and is replaced by the new level's. */
static vlResult add_level(Builder *b, float **kept) {
  vlMipmap *map = b->map;
  const vlMipLevel *from = &map->levels[map->level_count - 1];
  uint32_t width = from->width > 1 ? from->width / 2 : 1,
           height = from->height > 1 ? from->height / 2 : 1;
  size_t count = (size_t)width * height * map->channels;
  float *floats = vl_alloc_array(map->context, count, sizeof *floats);
  uint8_t *bytes = map->is_bytes ? vl_alloc_array(map->context, count, 1) : NULL;
  vlResult result = floats && (!map->is_bytes || bytes) ? VL_OK : VL_ERROR_MEMORY;
  if (result == VL_OK &&
      !shrink(b, from, map->is_bytes ? *kept : from->floats, width, height, floats))
    result = VL_CANCELLED;
  if (result != VL_OK) {
    VL_FREE(map->context, floats, bytes);
    return result;
  }
  if (bytes)
    store_codes(b, floats, count, bytes);
  if (map->is_bytes) {
    vl_free(map->context, *kept);
    *kept = floats;
  }
  map->levels[map->level_count++] =
      (vlMipLevel){width, height, bytes, map->is_bytes ? NULL : floats};
  return VL_OK;
}

vlResult vl_mipmap_create(const vlImage *image, const vlMipmapDef *def, vlMipmap **mipmap) {
  *mipmap = NULL;
  if (def->count < 1 || def->count > 4)
    return VL_ERROR_ARGUMENT;
  for (uint32_t c = 0; c < def->count; c++)
    if (def->channel[c] >= image->channels)
      return VL_ERROR_ARGUMENT;
  if (def->own_encoding && def->encoding == VL_ENCODING_GAMMA && !(def->gamma > 0.0f))
    return VL_ERROR_ARGUMENT;
  vlContext *context = image->context;
  Builder *b = vl_alloc_zero(context, 1, sizeof *b);
  vlMipmap *map = vl_alloc_zero(context, 1, sizeof *map);
  vlResult result = b && map ? VL_OK : VL_ERROR_MEMORY;
  float *kept = NULL;
  if (map)
    map->context = context; /* vl_mipmap_destroy needs the context */
  if (result == VL_OK) {
    b->map = map;
    b->task = def->task;
    map->channels = def->count;
    map->space_given = vl_image_space(image, &map->space);
    map->is_bytes = image->type == VL_PIXEL_U8;
    if (map->is_bytes)
      make_tables(b, image, def);
    size_t row = (size_t)image->width * def->count;
    b->column = vl_alloc_array(context, row, sizeof(float));
    b->line = vl_alloc_array(context, row, sizeof(float));
    result = b->column && b->line ? finest_level(map, image, def) : VL_ERROR_MEMORY;
  }
  while (result == VL_OK && !def->only_finest && map->level_count < VL_MIP_LEVELS) {
    const vlMipLevel *last = &map->levels[map->level_count - 1];
    if (last->width == 1 && last->height == 1)
      break;
    result = add_level(b, &kept);
  }
  vl_free(context, kept);
  if (b) {
    VL_FREE(context, b->column, b->line);
  }
  vl_free(context, b);
  if (result == VL_OK)
    *mipmap = map;
  else
    vl_mipmap_destroy(map);
  return result;
}
