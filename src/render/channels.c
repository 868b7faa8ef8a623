/* render/channels.c: ground truth: which channels there are, their images, and the pass over
 * the tiles. This pass is separate from vl_render: no pixel of the image depends on it. */
#include "velo/channels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "base/unset.h"
#include "render/block.h"
#include "render/channel_pass.h"

/* ---- which channels there are ------------------------------------------------------------ */

static const struct Channel {
  const char *name;
  uint32_t floats, ids; /* number of components; Cryptomatte's floats depend on the ranks */
  const char *names[7]; /* of the floats, then of the ids; see FEATURE_ERRORS, too */
} channels[VL_CHANNEL_COUNT] = {
    {"Z", 1, 0, {"Z"}},
    {"distance", 1, 0, {"distance.Y"}},
    {"P", 3, 0, {"P.X", "P.Y", "P.Z"}},
    {"N", 3, 0, {"N.X", "N.Y", "N.Z"}},
    {"Ng", 3, 0, {"Ng.X", "Ng.Y", "Ng.Z"}},
    {"uv", 2, 0, {"uv.U", "uv.V"}},
    {"albedo", 3, 0, {"albedo.R", "albedo.G", "albedo.B"}},
    {"ray", 3, 0, {"ray.X", "ray.Y", "ray.Z"}},
    {"id.object", 0, 1, {"id.object"}},
    {"id.material", 0, 1, {"id.material"}},
    {"id.instance", 0, 1, {"id.instance"}},
    {"id.primitive", 0, 1, {"id.primitive"}},
    {"samples", 0, 1, {"samples"}},
    {"film", 2, 0, {"film.X", "film.Y"}},
    {"error", 3, 0, {"error.R", "error.G", "error.B"}},
    {"forward", 2, 1, {"forward.U", "forward.V", "forward.hidden"}},
    {"backward", 2, 1, {"backward.U", "backward.V", "backward.hidden"}},
    {"crypto.object", 2, 0, {NULL}},
    {"crypto.material", 2, 0, {NULL}},
    {"crypto.instance", 2, 0, {NULL}},
    {"features",
     7,
     0,
     {"feature.albedo.R", "feature.albedo.G", "feature.albedo.B", "feature.N.X", "feature.N.Y",
      "feature.N.Z", "feature.disparity.Y"}},
    {"luminance", 1, 0, {"luminance.Y"}},
    {"illuminance", 1, 0, {"illuminance.Y"}},
};
static const uint32_t CRYPTO =
    VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL | VL_CHANNEL_CRYPTO_INSTANCE;
/* The features' last three floats, with errors only: the standard errors of independent
 * samples, for denoisers. */
static const char *const FEATURE_ERRORS[3] = {"feature.error.R", "feature.error.G",
                                              "feature.error.B"};
static const uint32_t ERRORS_OF_FEATURES = VL_CHANNEL_ERROR | VL_CHANNEL_FEATURES;
enum { MAX_RANKS = 32, MAX_FLOATS = 48 + 3 * 2 * MAX_RANKS };

const char *vl_channel_name(uint32_t index) {
  return index < VL_CHANNEL_COUNT ? channels[index].name : NULL;
}

vlChannelsDef vl_default_channels_def(uint32_t width, uint32_t height) {
  return (vlChannelsDef){.cookie = VL_COOKIE_CHANNELS,
                         .channels = VL_CHANNEL_ALL,
                         .crop = {0, 0, width, height},
                         .space = VL_SPACE_SRGB,
                         .ranks = 6,
                         .exposure = 1,
                         .time = VL_UNSET};
}

/* ---- validation -------------------------------------------------------------------------- */

static vlResult check_film(const vlCamera *camera, const vlChannelsDef *def, vlError *error) {
  bool counts = (def->channels & (CRYPTO | VL_CHANNEL_FEATURES | VL_CHANNEL_ILLUMINANCE)) ||
                def->mode != VL_CHANNEL_MODE_CENTRE;
  bool errors = (def->channels & VL_CHANNEL_ERROR) != 0;
  bool luminance = (def->channels & VL_CHANNEL_LUMINANCE) != 0;
  if (!counts && !errors && !luminance)
    return VL_OK;
  if (!def->film || (counts && !def->render))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "ground truth: Cryptomatte, features, standard errors, luminance, illuminance and "
        "modes other than the centre need the image's film and how it was rendered");
  const vlFilmDef *film = vl_film_def(def->film);
  if (counts)
    VL_TRY(vl_render_def_check(def->render, "ground truth: def.render", error));
  if (film->width != camera->width || film->height != camera->height)
    return vl_fail_argument(error, "ground truth: camera (%u x %u) and film (%u x %u) differ",
                            camera->width, camera->height, film->width, film->height);
  if (counts && vl_film_spp(def->film) == 0)
    return vl_fail_argument(error, "ground truth: the film has no samples yet");
  if (errors && (!film->errors || memcmp(film->crop, def->crop, sizeof film->crop) != 0))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "ground truth: standard errors need a film of the same crop that was made for them");
  if (luminance && memcmp(film->crop, def->crop, sizeof film->crop) != 0)
    return vl_fail_argument(error, "ground truth: luminance needs a film of the same crop");
  return VL_OK;
}

static vlResult check(const vlWorld *world, const vlCamera *camera, const vlChannelsDef *def,
                      vlImage **floats, vlImage **ids, vlError *error) {
  if (!world || !camera || !def)
    return vl_fail_argument(error, "ground truth: world, camera or def is null");
  if (def->cookie != VL_COOKIE_CHANNELS)
    return vl_fail_argument(error, "ground truth: " VL_BAD_COOKIE);
  if (!vl_is_unset(def->time) && !isfinite(def->time))
    return vl_fail_argument(error, "ground truth: time is %g; it must be finite", def->time);
  if (def->channels == 0 || def->channels >> VL_CHANNEL_COUNT)
    return vl_fail_argument(error, "ground truth: no such channels: %#x", def->channels);
  const uint32_t *c = def->crop;
  if (!vl_crop_fits(c, camera->width, camera->height))
    return vl_fail_argument(
        error, "ground truth: crop %u,%u,%u,%u does not suit a camera of %u x %u pixels", c[0],
        c[1], c[2], c[3], camera->width, camera->height);
  if ((unsigned)def->mode > VL_CHANNEL_MODE_COVERAGE || def->ranks < 2 ||
      def->ranks > MAX_RANKS || def->ranks % 2)
    return vl_fail_argument(error, "ground truth: mode %d or %u ranks: there is no such thing",
                            (int)def->mode, def->ranks);
  if ((unsigned)def->space > VL_SPACE_ACES2065_1)
    return vl_fail_argument(error, "ground truth: space %d: there is no such thing",
                            (int)def->space);
  if (((def->channels & VL_CHANNEL_FORWARD) && !def->forward) ||
      ((def->channels & VL_CHANNEL_BACKWARD) && !def->backward))
    return vl_fail_argument(error, "ground truth: flow needs the other camera");
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++)
    if ((def->channels >> i & 1) &&
        ((channels[i].floats && !floats) || (channels[i].ids && !ids)))
      return vl_fail_argument(error,
                              "ground truth: a wanted channel has no image that receives it");
  return check_film(camera, def, error);
}

/* ---- images ------------------------------------------------------------------------------ */

/* Names of the requested channels of one kind. Cryptomatte's are pairs of ranks, two in a
 * layer. */
static uint32_t list_names(vlChannelPass *p, int id, const char *names[MAX_FLOATS],
                           char crypto[MAX_FLOATS][24]) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++) {
    const struct Channel *c = &channels[i];
    if (!vl_channel_wanted(p, 1u << i))
      continue;
    p->first[id][i] = count;
    if (i < VL_INDEX_CRYPTO || i >= VL_INDEX_FEATURES) {
      uint32_t first = id ? c->floats : 0, parts = id ? c->ids : c->floats;
      for (uint32_t k = 0; k < parts; k++)
        names[count++] = c->names[first + k];
      bool errors = i == VL_INDEX_FEATURES && !id &&
                    (p->def->channels & ERRORS_OF_FEATURES) == ERRORS_OF_FEATURES;
      for (uint32_t k = 0; k < 3 && errors; k++)
        names[count++] = FEATURE_ERRORS[k];
      continue;
    }
    for (uint32_t k = 0; k < 2 * p->def->ranks && !id; k++) {
      snprintf(crypto[count], sizeof crypto[count], "%s%02u.%c",
               vl_cryptomatte_type((vlIdKind)(i - VL_INDEX_CRYPTO)), k / 4, "RGBA"[k % 4]);
      names[count] = crypto[count];
      count++;
    }
  }
  return count;
}

static vlResult make_images(vlChannelPass *p, vlError *error) {
  for (int id = 0; id < 2; id++) {
    const char *names[MAX_FLOATS];
    char crypto[MAX_FLOATS][24];
    uint32_t count = list_names(p, id, names, crypto);
    p->step[id] = count;
    if (count == 0)
      continue;
    vlImageDef def = vl_default_image_def(p->def->crop[2] - p->def->crop[0],
                                          p->def->crop[3] - p->def->crop[1], count);
    def.names = names;
    def.type = id ? VL_PIXEL_U32 : VL_PIXEL_F32;
    def.unset = true; /* the tiles clear their pixels */
    vlResult r = vl_image_create(p->world->context, &def, &p->images[id]);
    if (r == VL_ERROR_MEMORY)
      return vl_fail_memory(error);
    if (r != VL_OK)
      return vl_fail(error, r, "ground truth: the image cannot be made");
  }
  return VL_OK;
}

static vlResult copy_luminance(const vlChannelPass *p, vlError *error) {
  if (!vl_channel_wanted(p, VL_CHANNEL_LUMINANCE))
    return VL_OK;
  vlImage *image;
  vlResult r = vl_film_luminance(p->def->film, &image);
  if (r == VL_ERROR_MEMORY)
    return vl_fail_memory(error);
  if (r != VL_OK)
    return vl_fail(error, r,
                   "ground truth: luminance needs a film of the sensor cie1931 without white "
                   "balance");
  size_t pixels = (size_t)vl_image_width(image) * vl_image_height(image);
  const float *from = vl_image_const_pixels(image);
  for (size_t i = 0; i < pixels; i++)
    *vl_channel_floats(p, i, VL_INDEX_LUMINANCE) = from[i];
  vl_image_destroy(image);
  return VL_OK;
}

/* ---- the pass ---------------------------------------------------------------------------- */

vlResult vl_channel_make_workers(vlChannelPass *p, vlError *error) {
  vlContext *context = p->world->context;
  uint32_t threads = vl_context_threads(context);
  bool counts = p->spp > 0,
       flow = vl_channel_wanted(p, VL_CHANNEL_FORWARD | VL_CHANNEL_BACKWARD);
  bool features = vl_channel_wanted(p, VL_CHANNEL_FEATURES);
  p->workers = vl_alloc_zero(context, threads, sizeof *p->workers);
  for (uint32_t i = 0; p->workers && i < threads; i++) {
    vlChannelWorker *w = &p->workers[i];
    w->scratch = vl_alloc_zero(context, 1, vl_ground_truth_scratch_size());
    w->batch = vl_alloc_zero(context, 1, sizeof *w->batch);
    w->rows = vl_alloc_zero(context, (size_t)VL_CHANNEL_ROWS * VL_ROW_SIZE, sizeof(float));
    if (counts)
      w->tallies = vl_alloc_zero(context, 3, sizeof *w->tallies);
    if (p->shares)
      w->hits = vl_alloc_array(context, VL_SHARED_HITS, sizeof *w->hits);
    if (features)
      w->features = vl_alloc_zero(context, 1, sizeof *w->features);
    if (flow)
      w->other = vl_alloc_zero(context, 1, sizeof *w->other);
    if (flow)
      w->lanes = vl_alloc_zero(context, VL_BATCH, sizeof *w->lanes);
    if (!w->scratch || !w->batch || !w->rows || (counts && !w->tallies) ||
        (p->shares && !w->hits) || (features && !w->features) ||
        (flow && (!w->other || !w->lanes)))
      return vl_fail_memory(error);
  }
  if (p->shares)
    p->reconstruction = vl_reconstruction_of(vl_film_filter(p->def->film));
  return p->workers ? VL_OK : vl_fail_memory(error);
}

static vlResult open_mattes(vlChannelPass *p, vlError *error) {
  for (int k = 0; k < 3; k++)
    if (vl_channel_wanted(p, VL_CHANNEL_CRYPTO_OBJECT << k) &&
        vl_cryptomatte_open(p->world, (vlIdKind)k, &p->crypto[k]) != VL_OK)
      return vl_fail_memory(error);
  return VL_OK;
}

static vlResult describe_mattes(vlChannelPass *p, vlError *error) {
  for (int k = 0; k < 3; k++)
    if (vl_channel_wanted(p, VL_CHANNEL_CRYPTO_OBJECT << k) &&
        vl_cryptomatte_describe(p->world, &p->crypto[k], p->images[0]) != VL_OK)
      return vl_fail_memory(error);
  return VL_OK;
}

void vl_channel_free_workers(vlChannelPass *p) {
  vlContext *context = p->world->context;
  for (uint32_t i = 0; p->workers && i < vl_context_threads(context); i++) {
    vlChannelWorker *w = &p->workers[i];
    VL_FREE(context, w->scratch, w->batch, w->rows, w->tallies, w->hits, w->features, w->other,
            w->lanes);
  }
  vl_free(context, p->workers);
}

static void free_all(vlChannelPass *p) {
  vl_channel_free_workers(p);
  for (int k = 0; k < 3; k++)
    vl_cryptomatte_close(p->world->context, &p->crypto[k]);
}

/* Prepares two sets of rays for the image's samples: unchanged ones, and ones through the
 * middle of the lens at the middle of the shutter interval. */
static void prepare_counting(vlChannelPass *p, const vlCamera *camera, vlIsa isa) {
  const vlChannelsDef *def = p->def;
  if (!(def->channels & (CRYPTO | VL_CHANNEL_FEATURES)) && def->mode == VL_CHANNEL_MODE_CENTRE)
    return;
  const vlFilmDef *film = vl_film_def(def->film);
  p->first_sample = vl_film_sequence(def->film).first;
  p->spp = vl_film_spp(def->film);
  vlSampler sampler;
  vl_sampler_init(&sampler, def->render->sampler, def->render->seed, film->width, film->height,
                  vl_film_sequence(def->film).length);
  sampler.own = def->render->own_sampler;
  vl_film_rays_init(&p->image, camera, vl_film_filter(def->film), &sampler, isa);
  vl_film_rays_init(&p->choice, p->rows ? &p->rolling : &p->camera, vl_film_filter(def->film),
                    &sampler, isa);
  p->choice.middle = true;
  p->shares = vl_shares_samples(film, def->render);
  p->choice.uniform = p->image.uniform = p->shares;
  vl_film_rays_clock(&p->image, p->world);
  vl_film_rays_clock(&p->choice, p->world);
}

/* The time (s) by which half of the light has arrived at the middle of the image. */
static double middle_time(const vlCamera *c) {
  return vl_camera_time(c, 0.5 * c->width, 0.5 * c->height, 0.5);
}

static vlCamera pinhole(const vlCamera *camera, double time) {
  vlCamera c = *camera;
  vl_camera_at(camera, time, &c);
  c.lens_radius = 0;
  return c;
}

void vl_channel_prepare(vlChannelPass *p, const vlCamera *camera) {
  vlIsa isa = vl_context_isa(p->world->context);
  const uint32_t *film_crop = p->def->film ? vl_film_def(p->def->film)->crop : NULL;
  p->adaptive = film_crop && vl_film_is_adaptive(p->def->film) &&
                memcmp(film_crop, p->def->crop, sizeof p->def->crop) == 0;
  p->time = p->def->time == p->def->time ? p->def->time : middle_time(camera);
  p->camera = pinhole(camera, p->time);
  p->rolling = *camera;
  p->rolling.lens_radius = 0;
  p->rows = vl_is_unset(p->def->time) && camera->readout > 0;
  p->columns = p->rows && (camera->readout_direction == VL_READOUT_RIGHT ||
                           camera->readout_direction == VL_READOUT_LEFT);
  p->open = vl_camera_time(camera, 0.5 * camera->width, 0.5 * camera->height, 0.0);
  p->close = vl_camera_time(camera, 0.5 * camera->width, 0.5 * camera->height, 1.0);
  vl_camera_compile(p->rows ? &p->rolling : &p->camera, &p->compiled);
  const vlCamera *others[2] = {p->def->forward, p->def->backward};
  for (int i = 0; i < 2; i++) {
    if (!vl_channel_wanted(p, VL_CHANNEL_FORWARD << i))
      continue;
    p->other_time[i] = middle_time(others[i]);
    p->other[i] = pinhole(others[i], p->other_time[i]);
    if (others[i]->readout > 0) {
      p->other[i] = *others[i];
      p->other[i].lens_radius = 0;
    }
    vl_camera_compile(&p->other[i], &p->other_compiled[i]);
  }
  p->camera_kernels = vl_camera_kernels(isa);
  p->ground_truth_kernels = vl_ground_truth_kernels(isa);
  const float footprint = 0.25f; /* the same as for the image's samples */
  p->ground_truth = (vlGroundTruthDef){.pixel_spread = footprint * p->compiled.pixel_spread,
                                       .pixel_width = footprint * p->compiled.pixel_width,
                                       .isa = isa,
                                       .shading = vl_channel_wanted(p, VL_CHANNEL_N),
                                       .albedo = vl_channel_wanted(p, VL_CHANNEL_ALBEDO)};
  vl_ground_truth_plan_albedo(p->world, p->def->space, &p->ground_truth);
  p->features = p->ground_truth;
  p->features.shading = p->features.albedo = p->features.coarse = true;
  vl_ground_truth_plan_albedo(p->world, p->def->space, &p->features);
  const uint32_t *crop = p->def->crop;
  p->tile_x0 = crop[0] / VL_CHANNEL_TILE;
  p->tile_y0 = crop[1] / VL_CHANNEL_TILE;
  p->tiles_x = (crop[2] + VL_CHANNEL_TILE - 1) / VL_CHANNEL_TILE - p->tile_x0;
  p->tiles = p->tiles_x * ((crop[3] + VL_CHANNEL_TILE - 1) / VL_CHANNEL_TILE - p->tile_y0);
  vl_channel_plan_features(p);
  prepare_counting(p, camera, isa);
}

vlResult vl_render_channels(const vlWorld *world, const vlCamera *camera,
                            const vlChannelsDef *def, vlImage **floats, vlImage **ids,
                            vlError *error) {
  vl_error_clear(error);
  if (floats)
    *floats = NULL;
  if (ids)
    *ids = NULL;
  VL_TRY(check(world, camera, def, floats, ids, error));
  vlChannelPass pass, *p = &pass;
  memset(p, 0, sizeof *p);
  vlStop stop;
  vl_stop_init(&stop, def->cancel, def->stop, def->stop_user);
  p->world = world;
  p->def = def;
  p->stop = &stop;
  vl_channel_prepare(p, camera);
  vlResult result = make_images(p, error);
  if (result == VL_OK)
    result = vl_channel_make_workers(p, error);
  if (result == VL_OK)
    result = open_mattes(p, error);
  if (result == VL_OK) {
    vlLoopDef loop = vl_loop_def(def->priority, def->cancel);
    vl_parallel_for_at(world->context, &loop, p->tiles, vl_channel_tile, p);
    result = atomic_load(&stop.stopped) ? vl_fail(error, VL_CANCELLED, "stopped")
                                        : describe_mattes(p, error);
  }
  if (result == VL_OK)
    result = copy_luminance(p, error);
  if (result == VL_OK)
    result = vl_channel_illuminance(p, camera, error);
  free_all(p);
  if (result != VL_OK) {
    vl_image_destroy(p->images[0]);
    vl_image_destroy(p->images[1]);
    return result;
  }
  if (floats)
    *floats = p->images[0];
  if (ids)
    *ids = p->images[1];
  return VL_OK;
}
