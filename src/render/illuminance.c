/* render/illuminance.c: the illuminance of the visible surfaces: a render whose first surfaces
 * are white and diffuse. A white diffuse surface of irradiance E has the radiance E / pi. */
#include <string.h>

#include "base/error.h"
#include "math/vec.h"
#include "render/block.h"
#include "render/channel_pass.h"
#include "velo/filter_kinds.h"
#include "velo/tracer.h"

/* The film's pixels are their own area, so that edges of surfaces weigh as they are seen. */
static vlFilmDef film_def(const vlChannelPass *p) {
  vlFilmDef def = vl_default_film_def(p->camera.width, p->camera.height);
  memcpy(def.crop, p->def->crop, sizeof def.crop);
  def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  return def;
}

/* The callback of the render. */
static bool go_on(void *user, VL_UNUSED const vlProgress *progress) {
  return !vl_stop_check(user);
}

/* As many samples as the image has, of the same sequence. */
static vlRenderDef render_def(const vlChannelPass *p) {
  const vlFilm *film = p->def->film;
  vlFilmSequence sequence = vl_film_sequence(film);
  vlRenderDef def = *p->def->render;
  def.tracer = VL_TRACER_VOLPATH;
  def.own_tracer = NULL;
  def.max_depth = def.max_depth > 0 ? def.max_depth : 1; /* direct light always counts */
  def.transparent = false;
  def.noise = 0;
  def.time_limit = 0;
  def.pass_rows = 0;
  def.first_sample = sequence.first;
  def.sequence = sequence.length;
  def.spp = sequence.first + vl_film_spp(film);
  def.progress = go_on;
  def.progress_user = p->stop;
  def.cancel = p->def->cancel;
  def.priority = p->def->priority;
  return def;
}

/* Divides by the share of each pixel that shows a surface. */
static vlResult write_channel(const vlChannelPass *p, const vlFilm *film, vlError *error) {
  vlImage *luminance = NULL, *colors = NULL;
  vlResult r = vl_film_luminance(film, &luminance);
  if (r == VL_OK)
    r = vl_film_develop(film, NULL, &colors);
  if (r == VL_OK) {
    const float *y = vl_image_const_pixels(luminance), *rgba = vl_image_const_pixels(colors);
    size_t pixels = (size_t)vl_image_width(colors) * vl_image_height(colors);
    for (size_t i = 0; i < pixels; i++) {
      float seen = rgba[4 * i + 3];
      *vl_channel_floats(p, i, VL_INDEX_ILLUMINANCE) = seen > 0.0f ? VL_PI * y[i] / seen : 0.0f;
    }
  }
  vl_image_destroy(luminance);
  vl_image_destroy(colors);
  return r == VL_OK ? VL_OK : vl_fail_memory(error);
}

vlResult vl_channel_illuminance(const vlChannelPass *p, const vlCamera *camera,
                                vlError *error) {
  if (!vl_channel_wanted(p, VL_CHANNEL_ILLUMINANCE))
    return VL_OK;
  vlFilmDef film_is = film_def(p);
  vlRenderDef render = render_def(p);
  vlPilot pilot = {.spread = 1.0f, .irradiance = true};
  vlFilm *film = NULL;
  if (vl_film_create(p->world->context, &film_is, &film) != VL_OK)
    return vl_fail_memory(error);
  vlResult r = vl_render_pilot(p->world, camera, film, &render, &pilot, NULL, error);
  if (r == VL_OK)
    r = write_channel(p, film, error);
  vl_film_destroy(film);
  return r;
}
