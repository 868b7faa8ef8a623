/* render/channels.c: see channels.h. */
#include "render/channels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera/camera.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"
#include "image/image.h"
#include "render/attributes.h"
#include "render/gbuffer.h"

const Choice channel_mode_choices[] = {{"centre", VL_CHANNEL_MODE_CENTRE},
                                       {"center", VL_CHANNEL_MODE_CENTRE},
                                       {"nearest", VL_CHANNEL_MODE_NEAREST},
                                       {"coverage", VL_CHANNEL_MODE_COVERAGE},
                                       {0}};

/* ---- which ------------------------------------------------------------------------------- */

static int read_one(const char *name, uint32_t *channels) {
  static const struct {
    const char *name;
    uint32_t bits;
  } groups[] = {
      {"all", VL_CHANNEL_ALL},
      {"crypto", CHANNELS_CRYPTO},
  };
  const char *names[VL_CHANNEL_COUNT + 2];
  int count = 0;
  for (size_t i = 0; i < LENGTH(groups); i++) {
    names[count++] = groups[i].name;
    if (strcmp(name, groups[i].name) != 0)
      continue;
    *channels |= groups[i].bits;
    return -1;
  }
  for (uint32_t i = 0; vl_channel_name(i); i++) {
    names[count++] = vl_channel_name(i);
    if (strcmp(name, vl_channel_name(i)) != 0)
      continue;
    *channels |= 1u << i;
    return -1;
  }
  const char *near = did_you_mean("", name, names, count);
  if (*near)
    return report_usage("--channels: unknown name \"%s\"%s", name, near);
  char list[400];
  text_list(list, sizeof list, names, count);
  return report_usage("--channels: unknown name \"%s\"; accepted are %s", name, list);
}

static int read_list(const char *list, uint32_t *channels) {
  char name[64];
  while (text_take_word(&list, name, sizeof name))
    TRY(read_one(name, channels));
  return -1;
}

int channels_choose(Channels *c, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  memset(c, 0, sizeof *c);
  c->mode = (vlChannelMode)option_count(&v[RENDER_CHANNELS_MODE], VL_CHANNEL_MODE_CENTRE);
  c->ranks = option_count(&v[RENDER_CRYPTO_RANKS], 6);
  if (c->ranks % 2)
    return report_usage(
        "--crypto-ranks %u: two ranks share a layer, so that their number is even", c->ranks);
  c->boxes = v[RENDER_BOXES].given;
  if (c->boxes)
    c->bits |= VL_CHANNEL_ID_OBJECT | VL_CHANNEL_ID_INSTANCE;
  TRY(v[RENDER_CHANNELS].given ? read_list(v[RENDER_CHANNELS].text, &c->bits) : -1);
  if (c->bits && c->mode != VL_CHANNEL_MODE_CENTRE)
    c->bits |= VL_CHANNEL_FILM; /* adds the film position, without which the point's sample is
                                   unknown */
  static const int options[2] = {RENDER_FLOW_CAMERA, RENDER_FLOW_CAMERA_BEFORE};
  for (int i = 0; i < 2; i++) {
    if (v[options[i]].given) {
      c->other_paths[i] = v[options[i]].text;
      c->bits |= VL_CHANNEL_FORWARD << i;
    }
  }
  return -1;
}

/* ---- the pass ---------------------------------------------------------------------------- */

/* A camera of another image size is resized with the same framing, as the image's own camera
 * is. */
int channels_load(Channels *c, vlContext *context, const Job *job) {
  const vlFilmDef *film = &job->defs->film;
  bool own_sensor = film->sensor && strcmp(film->sensor, "cie1931") != 0;
  if ((c->bits & VL_CHANNEL_LUMINANCE) && (own_sensor || film->white_balance > 0))
    return report_failure(STATUS_SCENE,
                          "%s: --channels luminance needs the sensor cie1931 and no white "
                          "balance; the film has %s",
                          job->path, own_sensor ? film->sensor : "a white balance");
  for (int i = 0; i < 2; i++) {
    if (!c->other_paths[i])
      continue;
    vlCameraRecord record;
    TRY(camera_load(context, c->other_paths[i], 0, NULL, NULL, NULL, &record));
    vlError error = {0};
    vlCamera camera;
    vlResult result = vl_camera_make(&record.camera, &camera, NULL, &error);
    if (result == VL_OK)
      result = vl_camera_resize(&camera, job->camera.width, job->camera.height, &c->others[i]);
    if (result != VL_OK)
      return report_error(&error, result, c->other_paths[i]);
  }
  return -1;
}

static int find_boxes(Channels *c, const Job *job) {
  static const vlIdKind kinds[2] = {VL_ID_OBJECT, VL_ID_INSTANCE};
  for (int k = 0; k < 2; k++) {
    c->box_list[k] =
        calloc((size_t)vl_world_id_count(job->world, kinds[k]) + 1, sizeof(vlIdBox));
    if (!c->box_list[k])
      return report_no_memory();
  }
  vlBoxesDef def = vl_default_boxes_def(job->camera.width, job->camera.height);
  memcpy(def.crop, job->defs->film.crop, sizeof def.crop);
  int signals = signals_count();
  def.stop = job_stop_asked;
  def.stop_user = &signals;
  vlError error = {0};
  vlResult result =
      vl_world_boxes(job->world, &job->camera, &def, c->box_list[0], c->box_list[1], &error);
  return job_end_pass(job, result, &error);
}

/* The camera whose rows are exposed for an instant each, that of `share` of their exposure. */
static vlCamera rows_at(const vlCamera *camera, double share) {
  bool last_row = camera->readout_direction == VL_READOUT_UP,
       last_column = camera->readout_direction == VL_READOUT_LEFT;
  vlCamera instant = *camera;
  instant.shutter_open = instant.shutter_close =
      vl_camera_time(camera, last_column ? camera->width - 0.5 : 0.5,
                     last_row ? camera->height - 0.5 : 0.5, share);
  instant.shutter_points = 0;
  return instant;
}

/* Without another camera, flow is within the shutter interval: forward from the channels' time
 * to the end of the interval, and backward to its beginning; with a rolling shutter, that of
 * each row. */
static void shutter_ends(Channels *c, const Job *job) {
  const vlCamera *camera = &job->camera;
  bool rows = camera->readout > 0 && isnan(job_channels_time(job));
  for (int i = 0; i < 2 && rows; i++)
    if (!c->other_paths[i])
      c->others[i] = rows_at(camera, i ? 0.0 : 1.0);
  if (rows)
    return;
  for (int i = 0; i < 2; i++)
    if (!c->other_paths[i])
      vl_camera_at(
          camera,
          vl_camera_time(camera, 0.5 * camera->width, 0.5 * camera->height, i ? 0.0 : 1.0),
          &c->others[i]);
}

bool channels_any(const Channels *c) {
  return c->bits || c->spectrum || c->gbuffer;
}

void channels_take(Channels *c, Job *job) {
  bool wanted = job->defs->gbuffer != VL_GBUFFER_NONE;
  c->spectrum = job->defs->film.buckets > 0;
  c->gbuffer = wanted && !c->bits;
  if (wanted && c->bits)
    report_note("--channels are written in place of the film's gbuffer");
}

uint64_t channels_values(const Channels *c, uint32_t buckets) {
  static const uint8_t values[VL_CHANNEL_COUNT] = {1, 1, 3, 3, 3, 2, 3, 3,        1, 1,
                                                   1, 1, 1, 2, 3, 3, 3, [20] = 7, 1, 1};
  /* the gbuffer's channels and the ground truth that they are computed from */
  enum { GBUFFER = 48 };
  uint64_t sum = c->gbuffer ? GBUFFER : 0;
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++)
    if (c->bits & 1u << i)
      sum += CHANNELS_CRYPTO & 1u << i ? 2 * c->ranks : values[i];
  const uint32_t both = VL_CHANNEL_ERROR | VL_CHANNEL_FEATURES;
  if ((c->bits & both) == both)
    sum += 3; /* feature.error */
  return sum + (c->spectrum ? buckets : 0);
}

double channels_seconds(const Channels *c, uint32_t buckets, uint32_t spp, double sample,
                        double writing) {
  /* measured: cost of a camera ray relative to a sample, and of writing a channel relative to
   * its uncompressed size */
  const double ray = 0.3, compressed = 0.5;
  uint32_t rays = c->bits || c->gbuffer ? 1 : 0;
  if (c->bits & CHANNELS_CRYPTO || c->mode != VL_CHANNEL_MODE_CENTRE)
    rays += spp;
  if (c->bits & VL_CHANNEL_FEATURES)
    rays += spp < VL_FEATURE_SAMPLES ? spp : VL_FEATURE_SAMPLES;
  double again = c->bits & VL_CHANNEL_ILLUMINANCE ? sample * spp : 0;
  return again + ray * sample * rays +
         compressed * writing * (double)channels_values(c, buckets) / 3;
}

int channels_render(Channels *c, const Job *job, const vlFilm *film) {
  vlResult spectrum = c->spectrum ? vl_film_spectrum(film, &c->layers[2]) : VL_OK;
  TRY(report_reason(spectrum, job->path, "the image's spectrum cannot be made"));
  if (c->gbuffer)
    return gbuffer_render(job, film, &c->layers[3]);
  if (!c->bits)
    return STATUS_OK;
  shutter_ends(c, job);
  int signals = signals_count();
  vlChannelsDef def = job_channels_def(job, film, &signals);
  def.channels = c->bits;
  def.samples = vl_film_spp(film);
  def.mode = c->mode;
  def.ranks = c->ranks;
  if (c->bits & VL_CHANNEL_FORWARD)
    def.forward = &c->others[0];
  if (c->bits & VL_CHANNEL_BACKWARD)
    def.backward = &c->others[1];
  vlError error = {0};
  vlResult result =
      vl_render_channels(job->world, &job->camera, &def, &c->layers[0], &c->layers[1], &error);
  if (result == VL_OK)
    result = channels_make_visible(&c->layers[1]);
  return result == VL_OK && c->boxes ? find_boxes(c, job) : job_end_pass(job, result, &error);
}

vlResult channels_describe(const Channels *c, vlImage *image) {
  TRY_RESULT(channels_describe_mode(c, image));
  for (int k = 0; k < CHANNEL_LAYERS; k++)
    TRY_RESULT(attributes_add_layer(image, c->layers[k]));
  return VL_OK;
}

vlResult channels_describe_mode(const Channels *c, vlImage *image) {
  if (!c->bits)
    return VL_OK;
  return image_set_text(image, "velo.channels",
                        choice_name(channel_mode_choices, (int)c->mode));
}

void channels_free(Channels *c) {
  for (int k = 0; k < CHANNEL_LAYERS; k++)
    vl_image_destroy(c->layers[k]);
  for (int k = 0; k < 2; k++)
    free(c->box_list[k]);
  memset(c->layers, 0, sizeof c->layers);
  memset(c->box_list, 0, sizeof c->box_list);
}
