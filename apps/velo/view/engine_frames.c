/* view/engine_frames.c: images become frames for the pages: the film, or an image of another
 * kind. While the film of a slow scene gets its first samples row by row, the rows without are
 * those of the coarser image before it. */
#include <math.h>

#include "view/engine_parts.h"

/* Seconds of a part of an image that is shown while it grows. */
#define PART_SECONDS 0.4

void engine_publish(Engine *e, const vlImage *image, FrameFormat format, uint32_t channels,
                    uint32_t scale, uint32_t spp) {
  double start = engine_clock();
  const float *matrix =
      format == FRAME_HALF ? frame_to_rec709(e->model.job.defs->film.space) : NULL;
  ViewFrame *frame = frame_make(image, format, channels, matrix);
  if (!frame)
    return;
  frame->serial = ++e->serial;
  frame->change = e->now.change;
  frame->width = e->now.camera.made.width;
  frame->height = e->now.camera.made.height;
  frame->x0 = e->now.crop[0] / scale * scale;
  frame->y0 = e->now.crop[1] / scale * scale;
  frame->scale = scale;
  frame->channel = e->now.channel;
  frame->spp = spp;
  server_show(e->server, frame);
  frame_drop(frame);
  e->published = engine_clock();
  e->publish_seconds = e->published - start;
}

/* ---- the rows that are not there yet ----------------------------------------------------- */

/* Where pixel i of the finer image, whose pixels are `scale` of the whole image wide and begin
 * at `first`, lies between two pixels of the coarser one. */
typedef struct Place {
  uint32_t low, high;
  float share; /* of the high one */
} Place;

static Place place(uint32_t i, uint32_t scale, uint32_t first, uint32_t coarse_scale,
                   uint32_t count) {
  double whole =
      ((double)(first / scale + i) + 0.5) * scale - first / coarse_scale * coarse_scale;
  double at = fmin(fmax(whole / coarse_scale - 0.5, 0), count - 1);
  uint32_t low = (uint32_t)at;
  return (Place){low, low + 1 < count ? low + 1 : low, (float)(at - low)};
}

/* Fills the rows from `rows` on with the coarser image, between its pixels linearly. Both are
 * R G B A. */
static void fill_rows(const Engine *e, vlImage *image, uint32_t scale, uint32_t rows) {
  const vlImage *from = e->coarser;
  const uint32_t width = vl_image_width(image), height = vl_image_height(image),
                 columns = vl_image_width(from), *crop = e->now.crop;
  const float *pixels = vl_image_const_pixels(from);
  float *to = (float *)vl_image_pixels(image) + 4 * (size_t)rows * width;
  for (uint32_t y = rows; y < height; y++) {
    Place v = place(y, scale, crop[1], e->coarser_scale, vl_image_height(from));
    for (uint32_t x = 0; x < width; x++, to += 4) {
      Place u = place(x, scale, crop[0], e->coarser_scale, columns);
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
  vl_image_destroy(e->coarser);
  e->coarser = NULL;
}

/* ---- the film ---------------------------------------------------------------------------- */

void engine_publish_film(Engine *e, const vlFilm *film, uint32_t scale, uint32_t rows) {
  double start = engine_clock(), used = engine_thread_seconds();
  vlImage *image = NULL;
  if (vl_film_develop(film, &e->model.job.defs->develop, &image) == VL_OK) {
    bool part = rows < vl_image_height(image) && e->coarser;
    if (part)
      fill_rows(e, image, scale, rows);
    engine_publish(e, image, FRAME_HALF, 3, scale, part || scale > 1 ? 0 : vl_film_spp(film));
    e->publish_seconds = engine_clock() - start;
    if (!part && scale > 1) {
      engine_forget_coarser(e);
      e->coarser = image;
      e->coarser_scale = scale;
      image = NULL;
    }
  }
  vl_image_destroy(image);
  e->frame_seconds += engine_thread_seconds() - used;
}

static bool publish_rows(void *user, const vlProgress *progress) {
  const PartOfFilm *part = user;
  if (progress->pass_done && progress->rows < part->height)
    engine_publish_film(part->engine, part->film, part->scale, progress->rows);
  return true;
}

void engine_render_in_parts(PartOfFilm *part, vlRenderDef *render, double pixel_seconds) {
  const double whole = pixel_seconds * part->width * part->height;
  if (!part->engine->coarser || whole < 2 * PART_SECONDS)
    return;
  render->pass_rows = (uint32_t)ceil(part->height * PART_SECONDS / whole);
  render->progress = publish_rows;
  render->progress_user = part;
}
