/* render/exposure.c: see exposure.h. The target value 0.18 is from Reinhard et al.,
 * "Photographic tone reproduction", 2002. */
#include "render/exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/vector.h"
#include "image/image.h"
#include "velo/channels.h"
#include "velo/edit.h"
#include "velo/material.h"
#include "velo/tracer.h"

int exposure_parse(const OptionValue *value, float *ev, bool *meter) {
  *ev = 0;
  *meter = false;
  if (!value->given)
    return -1;
  if (strcmp(value->text, "auto") == 0) {
    *meter = true;
    return -1;
  }
  double number;
  TRY(option_number("--exposure (or auto)", value->text,
                    vl_setting(VL_SETTING_PROGRAM, "exposure"), &number));
  *ev = (float)number;
  return -1;
}

static double luminance(const vlImage *image, const int rgb[3], uint32_t x, uint32_t y) {
  static const double weights[3] = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (int c = 0; c < 3; c++)
    sum += weights[c] * (double)vl_image_get(image, x, y, (uint32_t)rgb[c]);
  return sum > 0 && isfinite(sum) ? sum : 0;
}

float exposure_meter(const vlImage *image) {
  int rgb[3];
  int alpha = vl_image_find_channel(image, "A");
  if (!image_find_rgb(image, "", rgb))
    return 0;
  uint32_t width = vl_image_width(image), height = vl_image_height(image);
  double total = 0, logs = 0, weights = 0;
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++)
      total += luminance(image, rgb, x, y);
  double min = 1e-3 * total / ((double)width * height);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) {
      double v = luminance(image, rgb, x, y);
      double w = alpha < 0 ? 1 : (double)vl_image_get(image, x, y, (uint32_t)alpha);
      if (v > 0 && v >= min && w > 0) {
        logs += w * log2(v);
        weights += w;
      }
    }
  if (!(weights > 0))
    return 0;
  double ev = round(10 * (log2(0.18) - logs / weights)) / 10;
  return (float)(ev < -64 ? -64 : ev > 64 ? 64 : ev);
}

/* ---- models ------------------------------------------------------------------------------ */

/* The longer sides of the small renders: shares of the image's, in 16ths, within limits. Each
 * pixel has as many samples as one of a first image: both take (6^2 + 3^2) / 16^2 = 18 % of the
 * paths of a first image of 256 pixels or fewer, and less of a larger one. Below 128 pixels it
 * is more. */
enum { METER_SIDE = 96, METER_SPP = 8, METER_DEPTH = 6 };
typedef struct SmallDef {
  const char *what; /* it is for */
  int share, min, max;
} SmallDef;
static const SmallDef meter_small = {"exposure", 6, 48, METER_SIDE},
                      unlit_small = {"light", 3, 24, 48};
#define WHITE 0.62 /* mean of a white model in the studio */
#define SHEEN 0.04 /* what dark surfaces reflect like glass */

/* Sums of a model's pixels: luminance of radiance and albedo; and the luminance of all pixels
 * of the image. */
typedef struct ModelLight {
  double radiance[METER_SIDE * METER_SIDE], albedo[METER_SIDE * METER_SIDE],
      ratio[METER_SIDE * METER_SIDE], all[METER_SIDE * METER_SIDE];
  size_t count, all_count;
} ModelLight;

/* Radiance per albedo of a model's pixels. SHEEN counts as albedo, too. A pixel counts at most
 * as four times the median: lamps and highlights. 0: there are no pixels. */
static double mean_light(ModelLight *light) {
  double radiance = 0, albedo = 0;
  size_t n = light->count;
  if (n == 0)
    return 0;
  for (size_t i = 0; i < n; i++) {
    light->albedo[i] += SHEEN;
    light->ratio[i] = light->radiance[i] / light->albedo[i];
  }
  qsort(light->ratio, n, sizeof *light->ratio, by_value);
  double max = 4 * light->ratio[n / 2];
  for (size_t i = 0; i < n; i++) {
    double limit = max > 0 ? max * light->albedo[i] : INFINITY;
    radiance += light->radiance[i] < limit ? light->radiance[i] : limit;
    albedo += light->albedo[i];
  }
  return radiance / albedo;
}

/* The luminance that a tenth of the pixels exceeds; sorts them. */
static double bright(double *pixels, size_t count) {
  qsort(pixels, count, sizeof *pixels, by_value);
  return pixels[count * 9 / 10];
}

/* The most stops by which the image may be made brighter: a tenth of the model's pixels may
 * become white (mirrors and glass show little of a lamp's light), and a tenth of all pixels
 * brighter than a white model. Call after mean_light. */
static double max_stops(ModelLight *light, double white) {
  double model = -log2(bright(light->radiance, light->count)),
         all = log2(white) - log2(bright(light->all, light->all_count));
  double max = model < all ? model : all;
  return max > 0 ? max : 0;
}

/* The luminance that half of the pixels exceed. Call after max_stops. */
static double median_of(const ModelLight *light) {
  return light->all[light->all_count / 2];
}

/* Whether one sees through the material: what it shows is the light behind it. id: of the
 * channel id.material. */
static bool is_clear(const vlScene *scene, uint32_t id) {
  const vlMaterialId material = {id - 1}; /* 1 is the default material */
  const vlMaterialDef *m = id > 1 ? vl_scene_material(scene, material) : NULL;
  if (!m || m->kind == VL_MATERIAL_DIELECTRIC || m->kind == VL_MATERIAL_THIN_DIELECTRIC)
    return m != NULL;
  const vlFloatInput *through = &m->principled.transmission;
  return m->kind == VL_MATERIAL_PRINCIPLED && (through->value > 0.5f || through->texture.index);
}

/* A small render of the model. */
typedef struct SmallRender {
  vlImage *color, *albedos, *ids;
} SmallRender;

/* Which pixels of the model count. */
typedef enum Counted {
  REFLECTING,    /* those that reflect light, glass left out */
  CLEAR_AS_WELL, /* glass counts, too */
  EMITTING       /* those that only emit light; each as a white surface of that radiance */
} Counted;

/* Returns how many pixels show any of the model, if only in part. */
static size_t gather(ModelLight *light, const vlScene *scene, Counted counted,
                     const SmallRender *small) {
  size_t seen = 0;
  light->count = light->all_count = 0;
  const vlImage *image = small->color;
  int rgb[3], own[3];
  image_find_rgb(image, "", rgb);
  image_find_rgb(small->albedos, "albedo.", own);
  int alpha = vl_image_find_channel(image, "A");
  const uint32_t *id = vl_image_const_pixels(small->ids);
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++, id++) {
      light->all[light->all_count++] = luminance(image, rgb, x, y);
      const float opacity = vl_image_get(image, x, y, (uint32_t)alpha);
      seen += opacity > 0;
      if (!(opacity > 0.99f))
        continue;
      double albedo = luminance(small->albedos, own, x, y);
      const bool reflects = albedo > 1e-4; /* else it only emits light, or is black */
      if (reflects == (counted == EMITTING))
        continue;
      if (counted != CLEAR_AS_WELL && is_clear(scene, *id))
        continue;
      const double radiance = luminance(image, rgb, x, y);
      if (counted == EMITTING && !(radiance > 0))
        continue;
      light->radiance[light->count] = radiance;
      light->albedo[light->count++] = counted == EMITTING ? 1 - SHEEN : albedo;
    }
  return seen;
}

static void tell_rays(const char *what, const vlCamera *camera, const vlRenderStats *stats) {
  const uint64_t rays = stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
  if (report_is_verbose())
    report_note("%s: a render of %u x %u pixels, %llu rays", what, camera->width,
                camera->height, (unsigned long long)rays);
}

static vlResult render_small(vlContext *context, const vlWorld *world, const vlCamera *camera,
                             const vlSceneDefs *defs, const char *what, SmallRender *small,
                             vlError *error) {
  vlFilmDef film_def = vl_default_film_def(camera->width, camera->height);
  vlRenderDef render = vl_default_render_def();
  render.tracer = defs->render.tracer == VL_TRACER_PATH ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
  render.max_depth =
      defs->render.max_depth < METER_DEPTH ? defs->render.max_depth : METER_DEPTH;
  render.spp = METER_SPP;
  vlChannelsDef channels = vl_default_channels_def(camera->width, camera->height);
  channels.channels = VL_CHANNEL_ALBEDO | VL_CHANNEL_ID_MATERIAL;
  vlFilm *film = NULL;
  vlRenderStats stats = {0};
  vlResult result = vl_film_create(context, &film_def, &film);
  if (result == VL_OK)
    result = vl_render(world, camera, film, &render, &stats, error);
  tell_rays(what, camera, &stats);
  if (result == VL_OK)
    result = vl_film_develop(film, &defs->develop, &small->color);
  if (result == VL_OK)
    result = vl_render_channels(world, camera, &channels, &small->albedos, &small->ids, error);
  vl_film_destroy(film);
  return result;
}

/* The light on the model: the radiance of a white surface (0: no pixel shows the model) and the
 * share of the model's pixels that get less than a quarter of it. */
typedef struct Metered {
  double white, unlit, max_stops;
  double median; /* of the luminance of all pixels; 0 of surfaces that only emit */
  size_t pixels, all;
  size_t seen; /* pixels that show any of the model */
} Metered;

/* The longer side of a small render of an image. */
static uint32_t small_side(const SmallDef *def, uint32_t width, uint32_t height) {
  const double side = def->share / 16.0 * (width > height ? width : height);
  return (uint32_t)(side < def->min ? def->min : side > def->max ? def->max : side);
}

/* def: of the small render of an image of this size. lamps: the light is not that of the studio
 * alone: a model of glass, too, is metered. */
static vlResult measure(vlContext *context, const vlScene *scene, const vlWorld *world,
                        const vlCamera *camera, const vlSceneDefs *defs, const SmallDef *def,
                        const uint32_t size[2], bool lamps, Metered *metered, vlError *error) {
  double k = small_side(def, size[0], size[1]) /
             (double)(camera->width > camera->height ? camera->width : camera->height);
  uint32_t width = (uint32_t)(camera->width * k + 0.5),
           height = (uint32_t)(camera->height * k + 0.5);
  vlCamera camera_small = *camera;
  SmallRender small = {NULL, NULL, NULL};
  *metered = (Metered){.white = 0};
  if (k < 1 &&
      vl_camera_resize(camera, width ? width : 1, height ? height : 1, &camera_small) != VL_OK)
    return VL_OK;
  vlResult result = render_small(context, world, &camera_small, defs, def->what, &small, error);
  ModelLight *light = result == VL_OK ? calloc(1, sizeof *light) : NULL;
  if (result == VL_OK && !light)
    result = VL_ERROR_MEMORY;
  if (result == VL_OK) {
    metered->seen = gather(light, scene, REFLECTING, &small);
    if (light->count == 0 && lamps)
      gather(light, scene, CLEAR_AS_WELL, &small);
    bool emits = light->count == 0 && gather(light, scene, EMITTING, &small) && light->count;
    metered->white = mean_light(light);
    metered->pixels = light->count;
    metered->all = light->all_count;
    size_t unlit = 0;
    for (size_t i = 0; i < light->count; i++)
      unlit += light->ratio[i] <= 0.25 * metered->white;
    metered->unlit = light->count ? (double)unlit / (double)light->count : 0;
    const bool reflects = light->count && !emits;
    metered->max_stops = reflects ? max_stops(light, WHITE) : 0;
    metered->median = reflects ? median_of(light) : 0;
  }
  free(light);
  vl_image_destroy(small.color);
  vl_image_destroy(small.albedos);
  vl_image_destroy(small.ids);
  return result;
}

/* An image of which more than half is nearly white, a white thing on a white plain, is made
 * darker: white becomes light grey, on which white edges and shadows are seen. */
static double without_glare(double stops, double median) {
  const double glare = 0.75, paper = 0.55;
  const double shown = median * exp2(stops);
  return shown > glare ? stops + log2(paper / shown) : stops;
}

int exposure_meter_model(vlContext *context, const vlScene *scene, const vlWorld *world,
                         const vlCamera *camera, const vlSceneDefs *defs, double leave,
                         float *ev) {
  Metered m;
  vlError error = {0};
  *ev = 0;
  const uint32_t size[2] = {camera->width, camera->height};
  TRY(report_error(
      &error,
      measure(context, scene, world, camera, defs, &meter_small, size, leave <= 0, &m, &error),
      "metering"));
  double stops = m.white > 0 ? log2(WHITE / m.white) : 0;
  stops = stops > 0 && stops > m.max_stops ? m.max_stops : stops;
  stops = without_glare(fabs(stops) <= leave ? 0 : stops, m.median);
  stops = round(10 * stops) / 10;
  *ev = (float)(stops < -64 ? -64 : stops > 64 ? 64 : stops);
  if (m.all && !m.seen)
    report_note(
        "note: nothing of the model is seen: the camera looks elsewhere, or the model is "
        "transparent or very thin");
  if (report_is_verbose() && m.all)
    report_note(
        "exposure: white has %.3g on %zu of %zu pixels of the model, %.2g is wanted: %+.1f EV",
        m.white, m.pixels, m.all, WHITE, (double)*ev);
  return -1;
}

int exposure_find_unlit(vlContext *context, const vlScene *scene, const vlWorld *world,
                        const vlCamera *camera, const vlSceneDefs *defs, const uint32_t size[2],
                        bool *unlit) {
  Metered m;
  vlError error = {0};
  *unlit = false;
  TRY(report_error(
      &error,
      measure(context, scene, world, camera, defs, &unlit_small, size, false, &m, &error),
      "metering"));
  *unlit = m.pixels > 0 && (m.white < WHITE / 1024 || (m.white < WHITE / 32 && m.unlit > 0.5));
  return -1;
}

void exposure_tell(float ev) {
  report_note("exposed by %+.1f EV, as metered (--exposure 0 leaves the light as it is)",
              (double)ev);
}
