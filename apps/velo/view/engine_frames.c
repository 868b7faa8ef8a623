/* view/engine_frames.c: images become frames for the pages: the film, or an image of another
 * kind. While the film of a slow scene gets its first samples row by row, the rows without are
 * those of the coarser image before it. */
#include <math.h>

#include "cli/crop.h"
#include "cli/macros.h"
#include "view/engine_sensor.h"

/* Seconds of a part of an image that is shown while it grows. */
#define PART_SECONDS 0.4

void engine_publish(Engine *e, const vlImage *image, const FrameKind *kind) {
  double start = monotonic_seconds();
  const uint32_t scale = kind->scale;
  float to_rec709[9];
  const float *matrix = kind->format == FRAME_HALF && !kind->developed
                            ? frame_to_rec709(e->model.job.defs->film.space, to_rec709)
                            : NULL;
  ViewFrame *frame = frame_make(image, kind->format, kind->channels, matrix);
  if (!frame)
    return;
  frame->serial = ++e->frames.serial;
  frame->change = e->now.change;
  frame->width = e->now.camera.made.width;
  frame->height = e->now.camera.made.height;
  frame->x0 = e->now.crop[0] / scale * scale;
  frame->y0 = e->now.crop[1] / scale * scale;
  frame->scale = scale;
  frame->channel = e->now.channel;
  frame->spp = kind->spp;
  frame->denoised = kind->denoised;
  frame->moved = kind->moved;
  server_show(e->server, frame);
  frame_drop(frame);
  e->frames.published = monotonic_seconds();
  e->frames.publish_seconds = e->frames.published - start;
  engine_warp_keep(e, image, kind);
}

/* ---- the rows that are not there yet ----------------------------------------------------- */

/* Where pixel i of the finer image, whose pixels are `scale` of the whole image wide and begin
 * at `first`, lies between two pixels of the coarser one. */
typedef struct Blend {
  uint32_t low, high;
  float share; /* of the high one */
} Blend;

static Blend blend_at(uint32_t i, uint32_t scale, uint32_t first, uint32_t coarse_scale,
                      uint32_t count) {
  double whole =
      ((double)(first / scale + i) + 0.5) * scale - first / coarse_scale * coarse_scale;
  double at = fmin(fmax(whole / coarse_scale - 0.5, 0), count - 1);
  uint32_t low = (uint32_t)at;
  return (Blend){low, low + 1 < count ? low + 1 : low, (float)(at - low)};
}

/* Between the pixels of the coarser image it is linear. */
void engine_fill_rows(const Engine *e, vlImage *image, uint32_t scale, uint32_t rows) {
  const vlImage *from = e->coarse.last;
  const uint32_t width = vl_image_width(image), height = vl_image_height(image),
                 columns = vl_image_width(from), *crop = e->now.crop;
  const float *pixels = vl_image_const_pixels(from);
  float *to = (float *)vl_image_pixels(image) + 4 * (size_t)rows * width;
  for (uint32_t y = rows; y < height; y++) {
    Blend v = blend_at(y, scale, crop[1], e->coarse.last_scale, vl_image_height(from));
    for (uint32_t x = 0; x < width; x++, to += 4) {
      Blend u = blend_at(x, scale, crop[0], e->coarse.last_scale, columns);
      const float *low = pixels + 4 * (size_t)v.low * columns,
                  *high = pixels + 4 * (size_t)v.high * columns;
      for (uint32_t c = 0; c < 4; c++) {
        float a = low[4 * u.low + c] + u.share * (low[4 * u.high + c] - low[4 * u.low + c]),
              b = high[4 * u.low + c] + u.share * (high[4 * u.high + c] - high[4 * u.low + c]);
        to[c] = a + v.share * (b - a);
      }
    }
  }
}

void engine_forget_coarser(Engine *e) {
  vl_image_destroy(e->coarse.last);
  e->coarse.last = NULL;
  e->coarse.last_denoised = false;
}

void engine_keep_coarser(Engine *e, vlImage **image, uint32_t scale, bool denoised) {
  engine_forget_coarser(e);
  e->coarse.last = *image;
  e->coarse.last_scale = scale;
  e->coarse.last_denoised = denoised;
  *image = NULL;
}

/* ---- the film ---------------------------------------------------------------------------- */

bool engine_is_of_film(uint32_t channel) {
  return channel == 0 || channel == CHANNEL_ERROR || channel == CHANNEL_LUMINANCE ||
         channel == CHANNEL_CAMERA;
}

/* Sends the luminance of a film. Rows without samples are not filled. */
static void publish_luminance(Engine *e, const vlFilm *film, uint32_t scale) {
  vlImage *image = NULL;
  const vlResult result = vl_film_luminance(film, &image);
  const FrameKind kind = {.format = FRAME_FLOAT,
                          .channels = 1,
                          .scale = scale,
                          .spp = scale > 1 ? 0 : vl_film_spp(film)};
  if (result == VL_OK) {
    engine_publish(e, image, &kind);
  } else {
    vlError error = {0};
    text_set(error.message, "the luminance cannot be shown: %s",
             result == VL_ERROR_MEMORY ? "out of memory" : LUMINANCE_NEEDS);
    status_error(e, &error, result);
  }
  vl_image_destroy(image);
}

static void publish_colours(Engine *e, const vlFilm *film, uint32_t scale, uint32_t rows) {
  vlImage *image = NULL;
  if (vl_film_develop(film, &e->model.job.defs->develop, &image) == VL_OK) {
    bool part = rows < vl_image_height(image) && e->coarse.last;
    if (part)
      engine_fill_rows(e, image, scale, rows);
    const FrameKind kind = {.format = FRAME_HALF,
                            .channels = 3,
                            .scale = scale,
                            .spp = part || scale > 1 ? 0 : vl_film_spp(film)};
    engine_publish(e, image, &kind);
    if (!part && scale > 1)
      engine_keep_coarser(e, &image, scale, false);
  }
  vl_image_destroy(image);
}

void engine_publish_film(Engine *e, const vlFilm *film, uint32_t scale, uint32_t rows) {
  double start = monotonic_seconds(), used = engine_thread_seconds();
  if (e->now.channel == CHANNEL_LUMINANCE)
    publish_luminance(e, film, scale);
  else if (e->now.channel == CHANNEL_CAMERA)
    engine_publish_camera(e, film, scale);
  else
    publish_colours(e, film, scale, rows);
  e->frames.publish_seconds = monotonic_seconds() - start;
  e->frames.seconds += engine_thread_seconds() - used;
}

static bool publish_rows(void *user, const vlProgress *progress) {
  PartOfFilm *part = user;
  const uint32_t rows = progress->rows;
  if (!progress->pass_done || rows >= crop_height(part->crop))
    return true;
  if (!part->denoise || !engine_denoise(part, rows))
    engine_publish_film(part->engine, part->film, part->scale, rows);
  return true;
}

void engine_render_in_parts(PartOfFilm *part, vlRenderDef *render, double pixel_seconds) {
  const uint32_t height = crop_height(part->crop);
  const double whole = pixel_seconds * crop_width(part->crop) * height;
  if (!part->engine->coarse.last || whole < 2 * PART_SECONDS || engine_warp_stays(part->engine))
    return;
  render->pass_rows = (uint32_t)ceil(height * PART_SECONDS / whole);
  render->progress = publish_rows;
  render->progress_user = part;
}
