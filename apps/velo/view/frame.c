/* view/frame.c: see frame.h. */
#include "view/frame.h"

#include <stdlib.h>
#include <string.h>

#include "cli/crop.h"
#include "cli/vector.h"
#include "velo/color.h"

/* Rounds to the nearest half float, ties to even. Values above the largest half become the
 * largest; NaN becomes 0. */
static uint16_t to_half(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  uint32_t sign = bits >> 16 & 0x8000u, rest = bits & 0x7fffffffu;
  if (rest > 0x7f800000u)
    return 0;
  if (rest >= 0x477fe000u)
    return (uint16_t)(sign | 0x7bffu);
  if (rest < 0x38800000u) { /* a multiple of 2^-24: adding 0.5 makes the addition round */
    memcpy(&value, &rest, sizeof rest);
    value += 0.5f;
    memcpy(&rest, &value, sizeof rest);
    return (uint16_t)(sign | (rest - 0x3f000000u));
  }
  rest += 0xfffu + (rest >> 13 & 1u);
  return (uint16_t)(sign | (rest - 0x38000000u) >> 13);
}

static size_t pixel_size(const ViewFrame *frame) {
  return frame->channels * (frame->format == FRAME_HALF ? sizeof(uint16_t) : sizeof(float));
}

static void fill_row(ViewFrame *frame, const vlImage *image, uint32_t y, const float *matrix) {
  uint32_t stored = vl_image_channels(image), n = frame->channels;
  const void *pixels = vl_image_const_pixels(image);
  bool ids = vl_image_type(image) == VL_PIXEL_U32;
  uint8_t *to = frame->pixels + (size_t)y * frame->columns * pixel_size(frame);
  for (uint32_t x = 0; x < frame->columns; x++) {
    size_t at = ((size_t)y * frame->columns + x) * stored;
    float v[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t c = 0; c < n; c++)
      v[c] = ids ? (float)((const uint32_t *)pixels)[at + c] : ((const float *)pixels)[at + c];
    if (matrix) {
      const float a = v[0], b = v[1], d = v[2];
      for (int i = 0; i < 3; i++)
        v[i] = matrix[3 * i] * a + matrix[3 * i + 1] * b + matrix[3 * i + 2] * d;
    }
    for (uint32_t c = 0; c < n; c++) {
      uint16_t half = to_half(v[c]);
      if (frame->format == FRAME_HALF)
        memcpy(to + 2 * c, &half, sizeof half);
      else
        memcpy(to + 4 * c, &v[c], sizeof v[c]);
    }
    to += pixel_size(frame);
  }
}

ViewFrame *frame_make(const vlImage *image, FrameFormat format, uint32_t channels,
                      const float *matrix) {
  ViewFrame *frame = calloc(1, sizeof *frame);
  if (!frame)
    return NULL;
  frame->references = 1;
  frame->format = format;
  frame->channels = channels;
  frame->scale = 1;
  frame->columns = vl_image_width(image);
  frame->rows = vl_image_height(image);
  frame->pixels = malloc((size_t)frame->columns * frame->rows * pixel_size(frame));
  if (!frame->pixels) {
    free(frame);
    return NULL;
  }
  for (uint32_t y = 0; y < frame->rows; y++)
    fill_row(frame, image, y, matrix);
  return frame;
}

const float *frame_to_rec709(vlColorSpace space, float matrix[9]) {
  double from_xyz[9], to_xyz[9], rec709[9], product[9];
  if (space == VL_SPACE_SRGB || vl_color_space_matrix(space, from_xyz) != VL_OK ||
      vl_color_space_matrix(VL_SPACE_SRGB, rec709) != VL_OK ||
      !matrix3_invert(from_xyz, to_xyz))
    return NULL;
  matrix3_multiply(rec709, to_xyz, product);
  for (int i = 0; i < 9; i++)
    matrix[i] = (float)product[i];
  return matrix;
}

ViewFrame *frame_keep(ViewFrame *frame) {
  if (frame)
    atomic_fetch_add(&frame->references, 1);
  return frame;
}

void frame_drop(ViewFrame *frame) {
  if (!frame || atomic_fetch_sub(&frame->references, 1) != 1)
    return;
  free(frame->pixels);
  free(frame);
}

/* ---- the message ------------------------------------------------------------------------- */

static bool same_form(const ViewFrame *a, const ViewFrame *b) {
  return b && a->width == b->width && a->height == b->height && a->x0 == b->x0 &&
         a->y0 == b->y0 && a->scale == b->scale && a->columns == b->columns &&
         a->rows == b->rows && a->format == b->format && a->channels == b->channels &&
         a->channel == b->channel;
}

static bool tile_differs(const ViewFrame *a, const ViewFrame *b, const uint32_t tile[4]) {
  size_t size = pixel_size(a);
  for (uint32_t y = tile[1]; y < tile[3]; y++) {
    size_t at = ((size_t)y * a->columns + tile[0]) * size;
    if (memcmp(a->pixels + at, b->pixels + at, crop_width(tile) * size) != 0)
      return true;
  }
  return false;
}

static size_t tile_bytes(const ViewFrame *frame, const uint32_t tile[4]) {
  size_t bytes = crop_pixels(tile) * pixel_size(frame);
  return 8 + (bytes + 3) / 4 * 4;
}

static uint8_t *put_tile(const ViewFrame *frame, const uint32_t tile[4], uint8_t *to) {
  const uint16_t rectangle[4] = {(uint16_t)tile[0], (uint16_t)tile[1],
                                 (uint16_t)crop_width(tile), (uint16_t)crop_height(tile)};
  size_t row = rectangle[2] * pixel_size(frame), used = 0;
  memcpy(to, rectangle, sizeof rectangle);
  to += sizeof rectangle;
  for (uint32_t y = tile[1]; y < tile[3]; y++, used += row)
    memcpy(to + used,
           frame->pixels + ((size_t)y * frame->columns + tile[0]) * pixel_size(frame), row);
  memset(to + used, 0, (4 - used % 4) % 4);
  return to + (used + 3) / 4 * 4;
}

static uint32_t tile_end(uint32_t start, uint32_t limit) {
  return start + FRAME_TILE < limit ? start + FRAME_TILE : limit;
}

/* Lists the tiles that changed. Returns their number; the whole frame counts as one tile if
 * most changed. */
static uint32_t changed_tiles(const ViewFrame *now, const ViewFrame *before,
                              uint32_t (*tiles)[4]) {
  uint32_t count = 0, all = 0;
  const uint32_t whole[4] = {0, 0, now->columns, now->rows};
  if (!same_form(now, before)) {
    memcpy(tiles[0], whole, sizeof whole);
    return 1;
  }
  for (uint32_t y = 0; y < now->rows; y += FRAME_TILE)
    for (uint32_t x = 0; x < now->columns; x += FRAME_TILE, all++) {
      const uint32_t tile[4] = {x, y, tile_end(x, now->columns), tile_end(y, now->rows)};
      if (tile_differs(now, before, tile))
        memcpy(tiles[count++], tile, sizeof tile);
    }
  if (4 * count <= 3 * all)
    return count;
  memcpy(tiles[0], whole, sizeof whole);
  return 1;
}

uint8_t *frame_message(const ViewFrame *now, const ViewFrame *before, size_t before_room,
                       size_t *size) {
  size_t max = (size_t)((now->columns + FRAME_TILE - 1) / FRAME_TILE) *
               ((now->rows + FRAME_TILE - 1) / FRAME_TILE);
  uint32_t(*tiles)[4] = malloc(max * sizeof *tiles);
  if (!tiles)
    return NULL;
  uint32_t count = changed_tiles(now, before, tiles);
  *size = FRAME_HEADER;
  for (uint32_t i = 0; i < count; i++)
    *size += tile_bytes(now, tiles[i]);
  uint8_t *message = malloc(before_room + *size);
  if (message) {
    const uint32_t header[FRAME_HEADER / 4] = {1,
                                               now->serial,
                                               now->change,
                                               now->width,
                                               now->height,
                                               now->x0,
                                               now->y0,
                                               now->scale,
                                               now->columns,
                                               now->rows,
                                               now->format,
                                               now->channels,
                                               now->channel,
                                               now->spp,
                                               count,
                                               now->moved ? 2u : now->denoised};
    memcpy(message + before_room, header, sizeof header);
    uint8_t *to = message + before_room + FRAME_HEADER;
    for (uint32_t i = 0; i < count; i++)
      to = put_tile(now, tiles[i], to);
  }
  free(tiles);
  return message;
}
