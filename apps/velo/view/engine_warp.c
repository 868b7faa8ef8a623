/* view/engine_warp.c: while the camera moves, the last clean image moves with it. Each of its
 * pixels is a point in the scene, by the exact distance; the new camera projects it, and the
 * nearest point of a pixel gives its colour. What no point covers is that of the coarse image
 * of the new camera. This is better than the coarse image alone, which is grain of few large
 * pixels: docs/view.md has the numbers. What depends on the direction, such as reflections, is
 * that of the old camera until the samples of the new one are shown. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/crop.h"
#include "image/image.h"
#include "velo/channels.h"
#include "view/engine_parts.h"

/* The moved image has at most so many pixels, whatever the size of the image is. Samples per
 * pixel from which an image is clean without the denoiser, and from which it is better than a
 * moved one. */
enum { MAX_PIXELS = 320000, CLEAN_SPP = 16, GRAINY_SPP = 4 };
/* Of the pixels, so many must be covered by points: else the cameras see different things. */
static const double min_cover = 0.6;

void engine_warp_forget(Engine *e) {
  vl_image_destroy(e->warp.image);
  vl_image_destroy(e->warp.distances);
  e->warp = (WarpSource){.scale = 0};
}

/* The whole image, of a camera at rest: it is projected as at one time. */
static bool is_whole(const Wanted *w) {
  const vlCamera *c = &w->camera.made;
  return !c->moves && crop_is_whole(w->crop, c->width, c->height);
}

/* Means of scale x scale pixels, R G B A. Null: no memory. */
static vlImage *shrink(vlContext *context, const vlImage *from, uint32_t scale) {
  const uint32_t width = vl_image_width(from), height = vl_image_height(from),
                 channels = vl_image_channels(from);
  const uint32_t columns = (width + scale - 1) / scale, rows = (height + scale - 1) / scale;
  vlImage *image = NULL;
  if (image_make(context, columns, rows, 4, NULL, &image) != VL_OK)
    return NULL;
  const float *pixels = vl_image_const_pixels(from);
  float *to = vl_image_pixels(image);
  for (uint32_t y = 0; y < rows; y++)
    for (uint32_t x = 0; x < columns; x++, to += 4) {
      const uint32_t x1 = (x + 1) * scale < width ? (x + 1) * scale : width,
                     y1 = (y + 1) * scale < height ? (y + 1) * scale : height;
      float sum[3] = {0};
      for (uint32_t v = y * scale; v < y1; v++)
        for (uint32_t u = x * scale; u < x1; u++)
          for (uint32_t c = 0; c < 3; c++)
            sum[c] += pixels[channels * ((size_t)v * width + u) + c];
      const float share = 1.0f / (float)((x1 - x * scale) * (y1 - y * scale));
      for (uint32_t c = 0; c < 3; c++)
        to[c] = sum[c] * share;
      to[3] = 1;
    }
  return image;
}

void engine_warp_keep(Engine *e, const vlImage *image, const FrameKind *kind) {
  const bool clean = kind->denoised || kind->spp >= CLEAN_SPP;
  if (e->def.lecture || e->def.stepwise || e->model.info.moves || e->now.channel ||
      kind->scale != 1 || !kind->spp || !clean || vl_image_channels(image) < 3 ||
      !is_whole(&e->now))
    return;
  uint32_t scale = 1;
  while (engine_pixels(e) > (double)MAX_PIXELS * scale * scale)
    scale++;
  vlImage *small = shrink(e->def.context, image, scale);
  if (!small)
    return;
  if (e->warp.generation != e->now.generation)
    engine_warp_forget(e);
  vl_image_destroy(e->warp.image);
  e->warp.image = small;
  e->warp.scale = scale;
  e->warp.generation = e->now.generation;
}

void engine_warp_prepare(Engine *e) {
  WarpSource *w = &e->warp;
  if (!w->image || w->distances || w->generation != e->now.generation ||
      vl_camera_coarse(&e->now.camera.made, w->scale, &w->camera) != VL_OK)
    return;
  vlChannelsDef def = vl_default_channels_def(w->camera.width, w->camera.height);
  def.channels = VL_CHANNEL_DISTANCE;
  def.cancel = e->interrupt.cancel;
  if (vl_render_channels(e->model.world, &w->camera, &def, &w->distances, NULL, NULL) != VL_OK)
    w->distances = NULL;
}

/* ---- moving ------------------------------------------------------------------------------ */

/* What the pixels of the moved image get: the index of a pixel of the source, from 1 on; 0:
 * none. */
typedef struct Cover {
  uint32_t *from;
  float *depth;
  size_t count; /* pixels that have one */
} Cover;

/* Projects a row of the source's pixels. points: of the row, 3 numbers each. */
static void cover_row(const vlCamera *to, const double *points, const uint8_t *valid,
                      uint32_t width, uint32_t first, double *pixels, double *z, uint8_t *seen,
                      Cover *cover) {
  vl_camera_project_batch(to, width, points, pixels, z, seen);
  for (uint32_t i = 0; i < width; i++) {
    const double x = floor(pixels[2 * i]), y = floor(pixels[2 * i + 1]);
    if (!valid[i] || !seen[i] || !(x >= 0 && y >= 0 && x < to->width && y < to->height))
      continue;
    const size_t at = (size_t)y * to->width + (size_t)x;
    if (cover->from[at] && !((float)z[i] < cover->depth[at]))
      continue;
    cover->count += cover->from[at] == 0;
    cover->from[at] = first + i + 1;
    cover->depth[at] = (float)z[i];
  }
}

/* Which pixel of the source each pixel of the camera `to` shows. False: no memory. */
static bool find_cover(const Engine *e, const vlCamera *to, Cover *cover) {
  const vlCamera *c = &e->warp.camera;
  const uint32_t width = c->width;
  const float *distances = vl_image_const_pixels(e->warp.distances);
  const vlWorldInfo *info = &e->model.info;
  double reach = 1;
  for (int k = 0; k < 3; k++)
    reach += fabs((double)info->bounds_max[k]) + fabs((double)info->bounds_min[k]) +
             fabs(c->world_from_camera[4 * k + 3]);
  double *numbers = calloc((size_t)width * 11, sizeof *numbers);
  uint8_t *flags = calloc((size_t)width * 2, 1);
  bool made = numbers && flags;
  double *film = numbers, *points = numbers + 2 * (size_t)width,
         *directions = points + 3 * (size_t)width, *pixels = directions + 3 * (size_t)width,
         *z = pixels + 2 * (size_t)width;
  for (uint32_t y = 0; made && y < c->height; y++) {
    for (uint32_t x = 0; x < width; x++) {
      film[2 * x] = x + 0.5;
      film[2 * x + 1] = y + 0.5;
    }
    vl_camera_unproject_batch(c, width, film, points, directions, flags);
    for (uint32_t x = 0; x < width; x++) {
      const double distance = (double)distances[(size_t)y * width + x],
                   length = isfinite(distance) ? distance : 1e4 * reach;
      for (int k = 0; k < 3; k++)
        points[3 * x + (uint32_t)k] += length * directions[3 * x + (uint32_t)k];
    }
    cover_row(to, points, flags, width, y * width, pixels, z, flags + width, cover);
  }
  free(numbers);
  free(flags);
  return made;
}

/* Sets a pixel that no point covers to the mean of its neighbours, if three or more are
 * covered. */
static void close_gap(const vlImage *source, const Cover *cover, const vlCamera *c, uint32_t x,
                      uint32_t y, float *to) {
  const float *colours = vl_image_const_pixels(source);
  float sum[3] = {0};
  uint32_t n = 0;
  for (uint32_t v = y ? y - 1 : 0; v <= y + 1 && v < c->height; v++)
    for (uint32_t u = x ? x - 1 : 0; u <= x + 1 && u < c->width; u++) {
      const uint32_t from = cover->from[(size_t)v * c->width + u];
      if (!from)
        continue;
      n++;
      for (uint32_t k = 0; k < 3; k++)
        sum[k] += colours[4 * (size_t)(from - 1) + k];
    }
  for (uint32_t k = 0; k < 3 && n >= 3; k++)
    to[k] = sum[k] / (float)n;
}

static void put_colours(const vlImage *source, const Cover *cover, const vlCamera *c,
                        float *to) {
  const float *colours = vl_image_const_pixels(source);
  for (uint32_t y = 0; y < c->height; y++)
    for (uint32_t x = 0; x < c->width; x++, to += 4) {
      const uint32_t from = cover->from[(size_t)y * c->width + x];
      if (from)
        memcpy(to, colours + 4 * (size_t)(from - 1), 3 * sizeof *to);
      else
        close_gap(source, cover, c, x, y, to);
    }
}

bool engine_warp_suits(const Engine *e, uint32_t scale) {
  const WarpSource *w = &e->warp;
  const vlCamera *made = &e->now.camera.made;
  return w->distances && w->generation != e->now.generation && scale > w->scale &&
         !e->now.channel && is_whole(&e->now) &&
         (made->width + w->scale - 1) / w->scale == w->camera.width &&
         (made->height + w->scale - 1) / w->scale == w->camera.height;
}

bool engine_warp_stays(const Engine *e) {
  const uint32_t spp = engine_spp(e);
  return e->warp.image && e->warp.shown == e->now.generation &&
         e->warp.generation != e->now.generation && spp < GRAINY_SPP && spp < e->now.spp;
}

bool engine_warp_publish(Engine *e) {
  WarpSource *w = &e->warp;
  vlCamera to;
  if (!e->coarse.last || vl_camera_coarse(&e->now.camera.made, w->scale, &to) != VL_OK)
    return false;
  const double used = engine_thread_seconds();
  const size_t pixels = (size_t)to.width * to.height;
  vlImage *image = NULL;
  Cover cover = {.from = calloc(pixels, sizeof *cover.from),
                 .depth = calloc(pixels, sizeof *cover.depth)};
  bool done = cover.from && cover.depth && find_cover(e, &to, &cover) &&
              (double)cover.count >= min_cover * (double)pixels &&
              image_make(e->def.context, to.width, to.height, 4, NULL, &image) == VL_OK;
  if (done) {
    engine_fill_rows(e, image, w->scale, 0);
    put_colours(w->image, &cover, &to, vl_image_pixels(image));
    const FrameKind kind = {
        .format = FRAME_HALF, .channels = 3, .scale = w->scale, .moved = true};
    engine_publish(e, image, &kind);
    w->shown = e->now.generation;
  }
  vl_image_destroy(image);
  free(cover.from);
  free(cover.depth);
  e->frames.seconds += engine_thread_seconds() - used;
  return done;
}
