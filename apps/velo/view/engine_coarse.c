/* view/engine_coarse.c: coarse images. The first image after a change is as fine as fits into
 * first_seconds, by the time that the last ones took. It is always finished: further changes
 * are gathered meanwhile, and the newest one is shown next. So there are new images however
 * fast changes follow each other; if each change stopped the image before it, changes that come
 * faster than images would leave none. */
#include <math.h>
#include <string.h>

#include "cli/crop.h"
#include "image/image.h"
#include "velo/channels.h"
#include "velo/tracer.h"
#include "view/engine_sensor.h"

/* The coarsest image has 1/MAX_SCALE of the width and height. Pixels of the first image: before
 * speed is known; as many as it should have (160 x 90); fewer would hardly be quicker. */
enum { MAX_SCALE = 32, FIRST_PIXELS = 8192, GOOD_PIXELS = 14400, MIN_PIXELS = 2048 };
/* Of the first image after a change: others can follow it 25 times a second. */
static const double first_seconds = 0.03;
/* Of one with GOOD_PIXELS where they take longer. */
static const double longest_first = 0.085;

void engine_note_speed(double *sample_seconds, uint64_t samples, double seconds) {
  double one = seconds / (double)(samples ? samples : 1);
  if (samples > 1000)
    *sample_seconds = *sample_seconds > 0 ? 0.5 * (*sample_seconds + one) : one;
}

double engine_pixels(const Engine *e) {
  const uint32_t *c = e->now.crop;
  return (double)crop_pixels(c);
}

/* The scale of the first image after a change, from the seconds that one pixel takes; 0: not
 * known. */
static uint32_t first_scale(const Engine *e, double pixel_seconds) {
  double pixels = engine_pixels(e),
         max = pixel_seconds > 0 ? first_seconds / pixel_seconds : FIRST_PIXELS;
  double good = fmin(MAX_SCALE, fmax(1, floor(sqrt(pixels / GOOD_PIXELS))));
  if (pixel_seconds > 0 && pixels / (good * good) * pixel_seconds <= longest_first)
    max = fmax(max, pixels / (good * good));
  max = fmax(max, MIN_PIXELS);
  uint32_t scale = 1;
  while (scale < MAX_SCALE && pixels > max * scale * scale)
    scale++;
  return scale;
}

/* ---- colours ----------------------------------------------------------------------------- */

/* Sends the last clean image, moved to this camera, in place of a coarse one, which fills its
 * gaps. */
static void publish_moved(Engine *e, const vlFilm *film, uint32_t scale) {
  vlImage *image = NULL;
  if (vl_film_develop(film, &e->model.job.defs->develop, &image) == VL_OK)
    engine_keep_coarser(e, &image, scale, false);
  if (!engine_warp_publish(e))
    engine_publish_film(e, film, scale, UINT32_MAX);
}

/* False: interrupted. */
static bool render_colours(Engine *e, uint32_t scale) {
  vlCamera camera;
  vlFilmDef whole = e->model.job.defs->film;
  vlRenderDef render = engine_render_def(e, 1);
  vlFilm *film = NULL;
  vlError error = {0};
  vlRenderStats stats = {0};
  memcpy(whole.crop, e->now.crop, sizeof whole.crop);
  vlFilmDef def = vl_coarse_film_def(&whole, scale);
  if (e->now.channel == CHANNEL_CAMERA)
    engine_sensor_film(&def);
  render.priority = 1;
  vlResult result = vl_camera_coarse(&e->now.camera.made, scale, &camera);
  if (result == VL_OK)
    result = vl_film_create(e->def.context, &def, &film);
  PartOfFilm part = {.engine = e, .film = film, .camera = &camera, .scale = scale};
  memcpy(part.crop, def.crop, sizeof part.crop);
  const bool warps = engine_warp_suits(e, scale);
  part.denoise = !warps && !e->interrupt.first_runs &&
                 engine_can_denoise(e, engine_pixels(e) / (scale * scale));
  if (!warps)
    engine_render_in_parts(&part, &render, e->coarse.pixel_seconds);
  double start = monotonic_seconds();
  if (result == VL_OK)
    result = vl_render(e->model.world, &camera, film, &render, &stats, &error);
  if (result == VL_OK) {
    engine_note_speed(&e->coarse.pixel_seconds, stats.camera_rays, monotonic_seconds() - start);
    if (warps)
      publish_moved(e, film, scale);
    else if (!part.denoise || !engine_denoise(&part, crop_height(def.crop)))
      engine_publish_film(e, film, scale, UINT32_MAX);
  }
  engine_free_part(&part);
  vl_film_destroy(film);
  return result == VL_OK;
}

/* ---- ground truth ------------------------------------------------------------------------ */

/* Flow and whether the other camera sees the point, in one image. scale: pixels of the image
 * per pixel. Null: no memory. */
static vlImage *join_flow(vlContext *context, const vlImage *flow, const vlImage *hidden,
                          uint32_t scale) {
  vlImage *image = NULL;
  if (image_make_like(context, flow, 3, NULL, &image) != VL_OK)
    return NULL;
  float *to = vl_image_pixels(image);
  const float *from = vl_image_const_pixels(flow);
  const uint32_t *ids = vl_image_const_pixels(hidden);
  for (size_t i = 0; i < image_pixel_count(flow); i++) {
    to[3 * i] = (float)scale * from[2 * i];
    to[3 * i + 1] = (float)scale * from[2 * i + 1];
    to[3 * i + 2] = (float)ids[i];
  }
  return image;
}

/* The illuminance takes as many samples as a film has: this one, whose light nobody sees. */
static vlResult make_film(Engine *e, const vlCamera *camera, const vlFilmDef *def,
                          vlRenderDef *render, vlFilm **film, vlError *error) {
  *render = engine_render_def(e, e->coarse.light_spp);
  render->tracer = VL_TRACER_RAYCAST;
  const vlResult result = vl_film_create(e->def.context, def, film);
  return result == VL_OK ? vl_render(e->model.world, camera, *film, render, NULL, error)
                         : result;
}

/* False: interrupted. The standard error is that of the film. */
static bool render_channel(Engine *e, uint32_t scale) {
  vlFilmDef whole = e->model.job.defs->film;
  vlCamera camera = e->now.camera.made, mark = e->now.mark;
  memcpy(whole.crop, e->now.crop, sizeof whole.crop);
  const vlFilmDef film = vl_coarse_film_def(&whole, scale);
  vlResult result = scale > 1 ? vl_camera_coarse(&e->now.camera.made, scale, &camera) : VL_OK;
  if (result == VL_OK && scale > 1)
    result = vl_camera_coarse(&e->now.mark, scale, &mark);
  vlChannelsDef def = vl_default_channels_def(camera.width, camera.height);
  vlImage *floats = NULL, *ids = NULL;
  vlError error = {0};
  def.forward = e->now.channel == CHANNEL_FLOW ? &mark : NULL;
  def.channels = 1u << (e->now.channel - 1);
  def.space = whole.space;
  memcpy(def.crop, film.crop, sizeof def.crop);
  def.render = &e->model.job.defs->render;
  def.film = e->film;
  def.exposure = e->model.job.defs->develop.exposure;
  def.cancel = e->interrupt.cancel;
  vlFilm *few = NULL;
  vlRenderDef render = e->model.job.defs->render;
  const bool light = e->now.channel == CHANNEL_ILLUMINANCE;
  if (light && result == VL_OK) {
    result = make_film(e, &camera, &film, &render, &few, &error);
    def.film = few;
    def.render = &render;
  }
  double start = monotonic_seconds();
  if (result == VL_OK)
    result = vl_render_channels(e->model.world, &camera, &def, &floats, &ids, &error);
  vlImage *flow =
      def.forward && result == VL_OK ? join_flow(e->def.context, floats, ids, scale) : NULL;
  const vlImage *image = flow ? flow : floats ? floats : ids;
  if (result == VL_OK && image) {
    if (e->now.channel != CHANNEL_ERROR && !light)
      engine_note_speed(&e->coarse.channel_seconds, image_pixel_count(image),
                        monotonic_seconds() - start);
    const FrameKind kind = {
        .format = FRAME_FLOAT,
        .channels = vl_image_channels(image) < 3 ? vl_image_channels(image) : 3,
        .scale = scale,
        .spp = scale > 1 ? 0
               : light   ? e->coarse.light_spp
                         : engine_spp(e)};
    engine_publish(e, image, &kind);
  }
  if (result != VL_OK && result != VL_CANCELLED)
    status_error(e, &error, result);
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  vl_image_destroy(flow);
  vl_film_destroy(few);
  return result != VL_CANCELLED;
}

bool engine_render_error(Engine *e) {
  return engine_spp(e) < 2 || render_channel(e, 1);
}

/* ---- which one is next ------------------------------------------------------------------- */

void engine_coarse_begin(Engine *e) {
  bool colours = engine_is_of_film(e->now.channel);
  bool light = e->now.channel == CHANNEL_ILLUMINANCE;
  e->coarse.light_spp = 1;
  e->coarse.next =
      first_scale(e, colours || light ? e->coarse.pixel_seconds : e->coarse.channel_seconds);
  if (colours && (e->coarse.next == 1 || e->now.channel == CHANNEL_ERROR))
    e->coarse.next = 0; /* the film is next */
}

/* The whole image of the illuminance is rendered again with four times the samples, up to those
 * that are wanted. */
static void more_light(Engine *e, uint32_t scale) {
  if (scale > 1 || e->now.channel != CHANNEL_ILLUMINANCE || e->coarse.light_spp >= e->now.spp)
    return;
  e->coarse.light_spp =
      4 * e->coarse.light_spp < e->now.spp ? 4 * e->coarse.light_spp : e->now.spp;
  e->coarse.next = 1;
}

bool engine_coarse_next(Engine *e) {
  const uint32_t scale = e->coarse.next;
  if (!engine_is_of_film(e->now.channel)) {
    e->coarse.next = scale / 2;
    if (render_channel(e, scale)) {
      more_light(e, scale);
      return true;
    }
    e->now.channel = UINT32_MAX; /* it is rendered anew */
    e->coarse.next = 0;
    return false;
  }
  bool done = render_colours(e, scale);
  e->coarse.next = done && scale > 3 ? scale / 2 : 0;
  return done;
}
