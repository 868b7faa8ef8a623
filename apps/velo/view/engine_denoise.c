/* view/engine_denoise.c: the denoised preview: a copy of the image that pages see in place of
 * the samples. The film is never changed, and nothing that is saved is denoised. Coarse images
 * and the first pass are denoised, too: their standard errors are the spread of the pixels
 * around. Later the film's image is denoised when its samples have doubled. The processor time
 * of all this is a share of the render's. */
#include <math.h>
#include <string.h>

#include "cli/crop.h"
#include "cli/macros.h"
#include "image/image.h"
#include "velo/channels.h"
#include "velo/denoise.h"
#include "velo/tracer.h"
#include "view/engine_parts.h"

/* Processor time for the preview: this share of the program's, which may run ahead by so many
 * seconds per thread. In the first 30 s of an image these are at most 19 %. */
static const double max_share = 0.15, ahead_seconds = 7.5;
static const double usual_pixel_seconds = 3e-6; /* before it is measured */
/* Rows above the new ones that are denoised with them: as many as windows reach. */
enum { OVERLAP = 9, REACH = 2, CHANNELS = 13 };
static const char *const channel_names[CHANNELS] = {"R",
                                                    "G",
                                                    "B",
                                                    "feature.error.R",
                                                    "feature.error.G",
                                                    "feature.error.B",
                                                    "feature.albedo.R",
                                                    "feature.albedo.G",
                                                    "feature.albedo.B",
                                                    "feature.N.X",
                                                    "feature.N.Y",
                                                    "feature.N.Z",
                                                    "feature.disparity.Y"};

/* ---- when -------------------------------------------------------------------------------- */

static bool is_wanted(const Engine *e) {
  /* the samples of these tracers depend on each other */
  bool suited =
      e->race.best.tracer != VL_TRACER_SPPM && e->race.best.tracer != VL_TRACER_MERGING;
  return e->now.denoise && !e->now.channel && !e->preview.failed && suited;
}

bool engine_can_denoise(const Engine *e, double pixels) {
  const DenoisedPreview *p = &e->preview;
  double cost = pixels * (p->pixel_seconds > 0 ? p->pixel_seconds : usual_pixel_seconds),
         used = engine_program_seconds() - p->before,
         ahead = ahead_seconds * vl_context_threads(e->def.context);
  return is_wanted(e) && p->seconds + cost <= max_share * (used + cost + ahead);
}

bool engine_denoise_due(const Engine *e, uint32_t spp) {
  if (!spp || spp == e->preview.spp)
    return false;
  if (spp >= e->now.spp) /* the last one: nothing else is to be done */
    return is_wanted(e);
  return spp >= 2 * e->preview.spp && engine_can_denoise(e, engine_pixels(e));
}

void engine_forget_denoised(Engine *e) {
  DenoisedPreview *p = &e->preview;
  vl_image_destroy(p->features);
  *p = (DenoisedPreview){.pixel_seconds = p->pixel_seconds, .before = engine_program_seconds()};
}

/* ---- what the denoiser reads ------------------------------------------------------------- */

/* The standard deviation of the values around each pixel of R G B A, up to REACH pixels away in
 * each direction, in three channels of `to`: the error of an image of one sample per pixel. */
static void spread(const float *image, uint32_t width, uint32_t height, float *to) {
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++, to += CHANNELS) {
      uint32_t x0 = x > REACH ? x - REACH : 0, x1 = x + REACH < width ? x + REACH : width - 1,
               y0 = y > REACH ? y - REACH : 0, y1 = y + REACH < height ? y + REACH : height - 1;
      float sum[3] = {0}, squares[3] = {0}, n = (float)((x1 - x0 + 1) * (y1 - y0 + 1));
      for (uint32_t v = y0; v <= y1; v++)
        for (uint32_t u = x0; u <= x1; u++)
          for (int c = 0; c < 3; c++) {
            float value = image[4 * ((size_t)v * width + u) + (size_t)c];
            sum[c] += value;
            squares[c] += value * value;
          }
      for (int c = 0; c < 3; c++)
        to[c] = sqrtf(fmaxf(0, (squares[c] - sum[c] * sum[c] / n) / (n > 1 ? n - 1 : 1)));
    }
}

/* Copies `count` channels of pixels between rows of different numbers of channels. */
static void copy(const float *from, uint32_t from_channels, float *to, uint32_t to_channels,
                 uint32_t count, size_t pixels) {
  for (size_t i = 0; i < pixels; i++)
    memcpy(to + i * to_channels, from + i * from_channels, count * sizeof *to);
}

/* The features of the part's rows. Those of the whole film are kept, until it has four times as
 * many samples. */
static vlResult make_features(PartOfFilm *part, uint32_t first, uint32_t end,
                              vlImage **features) {
  Engine *e = part->engine;
  const uint32_t *crop = part->crop, spp = vl_film_spp(part->film);
  bool whole = part->scale == 1 && first == 0 && end == crop_height(crop);
  if (whole && e->preview.features && spp < 4 * e->preview.feature_spp) {
    *features = e->preview.features;
    return VL_OK;
  }
  vlChannelsDef def = vl_default_channels_def(part->camera->width, part->camera->height);
  const uint32_t rows[4] = {crop[0], crop[1] + first, crop[2], crop[1] + end};
  memcpy(def.crop, rows, sizeof rows);
  def.channels = VL_CHANNEL_FEATURES;
  def.space = e->model.job.defs->film.space;
  def.film = part->film;
  def.render = &e->model.job.defs->render;
  def.cancel = e->interrupt.cancel;
  vlResult result =
      vl_render_channels(e->model.world, part->camera, &def, features, NULL, NULL);
  if (result == VL_OK && whole) {
    vl_image_destroy(e->preview.features);
    e->preview.features = *features;
    e->preview.feature_spp = spp >= 16 ? UINT32_MAX / 4 : spp;
  }
  return result;
}

/* Makes the image of the part's rows that the denoiser reads. */
static vlResult gather(PartOfFilm *part, uint32_t first, uint32_t end, vlImage **image) {
  Engine *e = part->engine;
  vlDevelopDef develop = e->model.job.defs->develop;
  const uint32_t width = crop_width(part->crop);
  const size_t skip = (size_t)first * width, pixels = (size_t)(end - first) * width;
  vlImage *colours = NULL, *errors = NULL, *features = NULL;
  develop.independent = true;
  vlResult result =
      image_make(e->def.context, width, end - first, CHANNELS, channel_names, image);
  if (result == VL_OK)
    result = vl_film_develop(part->film, &develop, &colours);
  if (result == VL_OK && part->scale == 1 && vl_film_spp(part->film) > 1)
    result = vl_film_errors(part->film, &develop, &errors);
  if (result == VL_OK)
    result = make_features(part, first, end, &features);
  if (result == VL_OK) {
    float *to = vl_image_pixels(*image);
    const float *from = (const float *)vl_image_const_pixels(colours) + 4 * skip;
    copy(from, 4, to, CHANNELS, 3, pixels);
    if (errors)
      copy((const float *)vl_image_const_pixels(errors) + 3 * skip, 3, to + 3, CHANNELS, 3,
           pixels);
    else
      spread(from, width, end - first, to + 3);
    copy(vl_image_const_pixels(features), vl_image_channels(features), to + 6, CHANNELS, 7,
         pixels);
  }
  vl_image_destroy(colours);
  vl_image_destroy(errors);
  if (features != e->preview.features)
    vl_image_destroy(features);
  return result;
}

/* ---- the preview ------------------------------------------------------------------------- */

void engine_free_part(PartOfFilm *part) {
  vl_image_destroy(part->clean);
  part->clean = NULL;
}

/* The preview, whose rows are not denoised yet. */
static vlResult make_clean(PartOfFilm *part) {
  const uint32_t width = crop_width(part->crop), height = crop_height(part->crop);
  TRY_RESULT(image_make(part->engine->def.context, width, height, 4, NULL, &part->clean));
  if (part->engine->coarse.last)
    engine_fill_rows(part->engine, part->clean, part->scale, 0);
  return VL_OK;
}

static void publish(PartOfFilm *part, uint32_t rows) {
  Engine *e = part->engine;
  bool whole = rows == crop_height(part->crop);
  const FrameKind kind = {.format = FRAME_HALF,
                          .channels = 3,
                          .scale = part->scale,
                          .spp = whole && part->scale == 1 ? vl_film_spp(part->film) : 0,
                          .denoised = whole || e->coarse.last_denoised};
  engine_publish(e, part->clean, &kind);
  if (!whole)
    return;
  e->preview.spp = kind.spp;
  if (part->scale > 1)
    engine_keep_coarser(e, &part->clean, part->scale, true);
}

bool engine_denoise(PartOfFilm *part, uint32_t rows) {
  Engine *e = part->engine;
  DenoisedPreview *p = &e->preview;
  const uint32_t width = crop_width(part->crop),
                 first = part->rows > OVERLAP ? part->rows - OVERLAP : 0;
  const double start = engine_program_seconds();
  vlImage *image = NULL, *clean = NULL;
  vlDenoiseDef def = vl_default_denoise_def();
  def.cancel = e->interrupt.cancel;
  vlResult result = part->clean ? VL_OK : make_clean(part);
  if (result == VL_OK)
    result = gather(part, first, rows, &image);
  if (result == VL_OK)
    result = vl_denoise(image, &def, &clean, NULL, NULL);
  if (result == VL_OK) {
    copy((const float *)vl_image_const_pixels(clean) + 3 * (size_t)(part->rows - first) * width,
         3, (float *)vl_image_pixels(part->clean) + 4 * (size_t)part->rows * width, 4, 3,
         (size_t)(rows - part->rows) * width);
    publish(part, rows);
  }
  vl_image_destroy(image);
  vl_image_destroy(clean);
  const double used = engine_program_seconds() - start;
  p->seconds += used;
  if (result == VL_OK)
    engine_note_speed(&p->pixel_seconds, (uint64_t)(rows - part->rows) * width, used);
  part->rows = rows;
  p->failed = p->failed || (result != VL_OK && result != VL_CANCELLED);
  return result == VL_OK;
}
