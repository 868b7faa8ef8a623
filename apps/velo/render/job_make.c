/* render/job_make.c: see job.h. Makes the defs and the camera of a render from the scene's defs
 * and the command line. */
#include "cli/crop.h"
#include "cli/macros.h"
#include "render/job.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "camera/camera.h"
#include "cli/kinds.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"
#include "render/lens_options.h"
#include "render/scene_options.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

const Choice sensor_choices[] = {{"sensors", 0}, {0}};
const Choice light_sampler_choices[] = {{"bvh", VL_LIGHT_SAMPLER_BVH},
                                        {"power", VL_LIGHT_SAMPLER_POWER},
                                        {"uniform", VL_LIGHT_SAMPLER_UNIFORM},
                                        {0}};
const Choice filter_samples_choices[] = {{"own", 0}, {"shared", 1}, {0}};
const Choice regularize_choices[] = {{"off", 0}, {"on", 1}, {0}};
const Choice color_choices[] = {{"spectral", VL_COLOR_SPECTRAL}, {"rgb", VL_COLOR_RGB}, {0}};
const Choice view_choices[] = {{"standard", VL_VIEW_STANDARD},
                               {"neutral", VL_VIEW_KHRONOS_NEUTRAL},
                               {"agx", VL_VIEW_AGX},
                               {"raw", VL_VIEW_RAW},
                               {0}};
const Choice stereo_choices[] = {{"none", VL_STEREO_NONE},
                                 {"parallel", VL_STEREO_PARALLEL},
                                 {"off-axis", VL_STEREO_OFF_AXIS},
                                 {"toe-in", VL_STEREO_TOE_IN},
                                 {"omnidirectional", VL_STEREO_OMNIDIRECTIONAL},
                                 {"ods", VL_STEREO_OMNIDIRECTIONAL},
                                 {0}};
const Choice eye_choices[] = {
    {"both", VL_EYE_BOTH}, {"left", VL_EYE_LEFT}, {"right", VL_EYE_RIGHT}, {0}};
const Choice bits_choices[] = {{"portable", VL_BITS_PORTABLE}, {"fast", VL_BITS_FAST}, {0}};
const Choice accelerator_choices[] = {
    {"embree", VL_ACCELERATOR_EMBREE}, {"bvh", VL_ACCELERATOR_BVH}, {0}};
const Choice shard_choices[] = {{"samples", 0}, {"tiles", 1}, {0}};
const Choice isa_choices[] = {
    {"base", VL_ISA_BASE}, {"v2", VL_ISA_V2}, {"v3", VL_ISA_V3}, {"v4", VL_ISA_V4}, {0}};

/* ---- overrides --------------------------------------------------------------------------- */

/* Sets the size of the film, which is rendered whole. */
static void set_size(vlFilmDef *film, uint32_t width, uint32_t height) {
  film->width = width;
  film->height = height;
  crop_set(film->crop, 0, 0, width, height);
}

/* The camera is that of a file, without a line. */
static void set_location(Job *job, const char *path) {
  job->camera_location = (vlError){0};
  text_set(job->camera_location.file, "%s", path);
}

/* File, line and column of the camera. The name is copied, since the scene's string ends with
 * the scene. */
static vlError camera_location(const vlSceneDefs *defs, const char *path) {
  vlSource source = defs->camera_source;
  vlError location = {.line = source.file ? source.line : 0,
                      .column = source.file ? source.column : 0};
  text_set(location.file, "%s", source.file ? source.file : path);
  return location;
}

/* Takes camera and image size from a camera file. Returns -1, or the exit code after reporting
 * the error. */
static int take_camera_file(Job *job, vlContext *context, vlSceneDefs *defs, const char *path,
                            const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  vlCameraRecord record;
  TRY(camera_load(context, path, 0, v[RENDER_FRAME].text, &v[RENDER_SIZE],
                  &v[RENDER_RESOLUTION], &record));
  defs->camera = record.camera;
  set_size(&defs->film, record.camera.width, record.camera.height);
  set_location(job, path);
  return -1;
}

static void take_receipt_camera(Job *job, vlSceneDefs *defs) {
  const ReceiptCamera *camera = job->receipt_camera;
  defs->camera = camera->def;
  set_size(&defs->film, camera->size[0], camera->size[1]);
  memcpy(defs->film.crop, camera->crop, sizeof camera->crop);
}

/* Takes camera and image size from another scene file. */
static int take_camera(Job *job, vlContext *context, vlScene *scene, const char *path,
                       const Arguments *arguments) {
  if (!camera_is_scene(path))
    return take_camera_file(job, context, vl_scene_defs(scene), path, arguments);
  vlScene *other = NULL;
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  load.permissive = arguments->values[RENDER_PERMISSIVE].given;
  load.strict = arguments->values[RENDER_STRICT].given;
  load.search_path = arguments->values[RENDER_SEARCH].text;
  vlResult result = scene_read(context, path, &load, &other, &error);
  if (result == VL_OK) {
    job->camera_location = camera_location(vl_scene_defs(other), path);
    result = vl_scene_take_camera(scene, other, &error);
  }
  int status = report_error(&error, result, path);
  vl_scene_destroy(other);
  return status;
}

/* The first pixel whose left edge is at or right of the fraction: pbrt's ceil(resolution *
 * fraction). */
static uint32_t crop_pixel(uint32_t size, double fraction) {
  double pixel = ceil(size * fraction);
  return pixel < size ? (uint32_t)pixel : size;
}

static int override_crop(vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *crop = &arguments->values[RENDER_CROP],
                    *window = &arguments->values[RENDER_CROPWINDOW];
  uint32_t width = defs->film.width, height = defs->film.height;
  TRY(options_exclude(arguments, RENDER_CROP, RENDER_CROPWINDOW));
  if (crop->given) {
    crop_set(defs->film.crop, 0, 0, width, height);
    return option_crop(crop, defs->film.crop);
  }
  if (window->given) {
    const double *n = window->numbers;
    uint32_t *c = defs->film.crop;
    crop_set(c, crop_pixel(width, n[0]), crop_pixel(height, n[2]), crop_pixel(width, n[1]),
             crop_pixel(height, n[3]));
    if (c[0] >= c[2] || c[1] >= c[3])
      return report_usage("--cropwindow \"%s\": holds no pixel of %u x %u", window->text, width,
                          height);
  }
  return -1;
}

/* Keeps the scene's crop window at the same fractions of the image. */
static void override_size(vlSceneDefs *defs, uint32_t width, uint32_t height) {
  double sx = (double)width / defs->film.width, sy = (double)height / defs->film.height;
  uint32_t *crop = defs->film.crop;
  for (int i = 0; i < 4; i++) {
    uint32_t limit = i & 1 ? height : width;
    double pixel = ceil(crop[i] * (i & 1 ? sy : sx) - 1e-6);
    crop[i] = pixel < limit ? (uint32_t)pixel : limit;
  }
  if (crop[0] == crop[2])
    crop[crop[0] ? 0 : 2] += crop[0] ? (uint32_t)-1 : 1u;
  if (crop[1] == crop[3])
    crop[crop[1] ? 1 : 3] += crop[1] ? (uint32_t)-1 : 1u;
  defs->film.width = width;
  defs->film.height = height;
}

/* Whether the sampler can continue beyond its planned number of samples per pixel. */
static bool sampler_is_open(vlSamplerKind kind) {
  const vlKindFamily *samplers = vl_kind_family_find("samplers");
  return (uint32_t)kind < samplers->kind_count &&
         samplers->rows[kind]->traits & VL_SAMPLER_TRAIT_OPEN;
}

/* The tracer with which --tracer auto begins: one that sees of the scene what its own tracer
 * sees (vl_choose_tracer). */
static vlTracer before_race(vlTracer tracer) {
  const vlKindFamily *tracers = vl_kind_family_find("tracers");
  bool past = (uint32_t)tracer < tracers->kind_count &&
              tracers->rows[tracer]->traits & VL_TRACER_TRAIT_NO_MEDIA;
  return past ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
}

static void override_sampling(vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const vlTracer own = defs->render.tracer;
  options_put(render_options, v, VL_SETTING_RENDER, defs);
  if (v[RENDER_TRACER].integer == TRACER_AUTO)
    defs->render.tracer = before_race(own);
  if (v[RENDER_FILTER].given)
    defs->film.filter = vl_default_pixel_filter(defs->film.filter.kind);
  if (v[RENDER_FILTER_SAMPLES].given)
    defs->render.share_samples = v[RENDER_FILTER_SAMPLES].integer == 1;
  if (v[RENDER_SENSOR].given)
    defs->film.sensor = vl_sensor_name((uint32_t)v[RENDER_SENSOR].integer);
  if (v[RENDER_TIME].given && !v[RENDER_SPP].given) {
    if (sampler_is_open(defs->render.sampler))
      defs->render.spp = 65536;
    else
      report_warning(
          "the sampler %s has a fixed number of samples: the render ends at %u spp even if "
          "--time is not over; give --spp",
          kind_name("samplers", (int)defs->render.sampler), defs->render.spp);
  }
}

/* Samplers with a fixed number of samples get the sequence of the whole render, even if only
 * some of its samples are rendered (--shard, --samples). */
static void fix_sequence(vlRenderDef *render) {
  if (!render->sequence && !sampler_is_open(render->sampler))
    render->sequence = render->spp;
}

/* Parses N[:MIN:MAX]. */
static int override_spectrum(vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *v = &arguments->values[RENDER_SPECTRUM];
  if (v->given) {
    unsigned count;
    double low = 360, high = 830;
    int used = 0;
    bool good =
        sscanf(v->text, "%5u%n", &count, &used) == 1 && count <= 1000 && v->text[0] != '-';
    if (good && v->text[used]) {
      int more = 0;
      good = sscanf(v->text + used, ":%lf:%lf%n", &low, &high, &more) == 2 &&
             !v->text[used + more];
    }
    if (!good || !(low >= 360 && high <= 830 && low < high))
      return report_usage(
          "--spectrum \"%s\": must be N or N:MIN:MAX, N at most 1000 buckets from MIN to "
          "MAX, inside of 360 to 830 nm",
          v->text);
    defs->film.buckets = count;
    defs->film.lambda_min = low;
    defs->film.lambda_max = high;
  }
  if (!defs->film.buckets || defs->build.color != VL_COLOR_RGB)
    return -1;
  if (v->given)
    return report_usage("--color rgb: there is no spectrum then");
  return report_usage(
      "--color rgb: the film of %s is in wavelengths; --spectrum 0 leaves them out",
      arguments->operands[0]);
}

bool job_sequence_is_planned(const Job *job, const Arguments *arguments) {
  return !arguments->values[RENDER_SEQUENCE].given &&
         !sampler_is_open(job->defs->render.sampler);
}

static int make_camera(Job *job, vlCameraDef def, uint32_t width, uint32_t height) {
  vlError error = {0};
  vlCamera camera;
  /* its warnings were reported when the camera was read */
  vlResult result = vl_camera_make(&def, &camera, NULL, &error);
  if (result != VL_OK) {
    text_set(job->camera_location.message, "%s", error_text(&error, result));
    return report_error(error.file[0] ? &error : &job->camera_location, result, NULL);
  }
  if (camera.width == width && camera.height == height) {
    job->camera = camera;
    return -1;
  }
  if (vl_camera_resize(&camera, width, height, &job->camera) == VL_OK)
    return -1;
  return report_failure(STATUS_SCENE, "%s: the camera of %u x %u pixels cannot have %u x %u",
                        job->path, camera.width, camera.height, width, height);
}

int job_make_film(const Job *job, vlFilm **film) {
  const vlFilmDef *def = &job->defs->film;
  char what[200];
  text_set(what, "no film of %u x %u pixels with these settings is possible", def->width,
           def->height);
  return report_reason(vl_film_create(job->context, def, film), job->path, what);
}

int job_end_pass(const Job *job, vlResult result, const vlError *error) {
  return result == VL_CANCELLED ? signals_status() : report_finish(error, result, job->path);
}

/* Applies the options of stereo. The def describes the camera midway between the eyes; frames.c
 * makes the cameras of the eyes. */
static int override_stereo(vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  vlStereo *stereo = &defs->camera.stereo;
  if (v[RENDER_STEREO].given)
    stereo->mode = (vlStereoMode)v[RENDER_STEREO].integer;
  bool none = stereo->mode == VL_STEREO_NONE;
  if (none &&
      (v[RENDER_INTEROCULAR].given || v[RENDER_CONVERGENCE].given || v[RENDER_EYE].given))
    return report_usage("--interocular, --convergence and --eye go with --stereo MODE");
  if (v[RENDER_INTEROCULAR].given)
    stereo->interocular = v[RENDER_INTEROCULAR].number;
  if (v[RENDER_CONVERGENCE].given)
    stereo->convergence = v[RENDER_CONVERGENCE].number;
  if (v[RENDER_EYE].given)
    defs->camera.stereo_eye = (vlEye)v[RENDER_EYE].integer;
  return -1;
}

/* Applies image size and crop of the command line and makes the camera. The camera is made for
 * the image size of its description and then resized, which keeps the framing. */
static int fit_camera(Job *job, vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *size = &arguments->values[RENDER_RESOLUTION];
  vlCameraDef camera = defs->camera;
  camera.stereo_eye = VL_EYE_BOTH;
  if (size->given)
    override_size(defs, (uint32_t)size->integers[0], (uint32_t)size->integers[1]);
  TRY(override_crop(defs, arguments));
  TRY(make_camera(job, camera, defs->film.width, defs->film.height));
  return lens_focus_on(&job->camera, arguments);
}

int job_take_camera(Job *job, vlSceneDefs *defs, const vlCameraDef *def, const char *path,
                    const Arguments *arguments) {
  vlStereo stereo = job->defs->camera.stereo;
  *defs = *job->defs;
  defs->camera = *def;
  defs->camera.stereo = stereo;
  set_size(&defs->film, def->width, def->height);
  set_location(job, path);
  job->defs = defs;
  TRY(lens_override(NULL, defs, arguments));
  return fit_camera(job, defs, arguments);
}

/* Parses "row", "open", "middle", "close" or seconds. */
static int read_channels_time(Job *job, const Arguments *arguments) {
  static const char *const words[] = {"open", "middle", "close"};
  const OptionValue *v = &arguments->values[RENDER_CHANNELS_TIME];
  job->channels_share = VL_UNSET;
  job->channels_seconds = VL_UNSET;
  if (!v->given || strcmp(v->text, "row") == 0)
    return -1;
  for (int i = 0; i < 3; i++)
    if (strcmp(v->text, words[i]) == 0) {
      job->channels_share = 0.5 * i;
      return -1;
    }
  if (parse_numbers(v->text, 1, &job->channels_seconds) && fabs(job->channels_seconds) < 1e12)
    return -1;
  return report_usage("--channels-time \"%s\": must be row, open, middle, close or seconds",
                      v->text);
}

double job_channels_time(const Job *job) {
  const vlCamera *c = &job->camera;
  if (!isnan(job->channels_seconds))
    return job->channels_seconds;
  if (isnan(job->channels_share))
    return VL_UNSET;
  return vl_camera_time(c, 0.5 * c->width, 0.5 * c->height, job->channels_share);
}

bool job_stop_asked(void *user) {
  return signals_count() > *(const int *)user;
}

vlChannelsDef job_channels_def(const Job *job, const vlFilm *film, int *signals) {
  vlChannelsDef def = vl_default_channels_def(job->camera.width, job->camera.height);
  def.space = job->defs->film.space;
  def.film = film;
  def.render = film ? &job->defs->render : NULL;
  def.exposure = job->defs->develop.exposure;
  def.time = job_channels_time(job);
  def.stop = job_stop_asked;
  def.stop_user = signals;
  memcpy(def.crop, job->defs->film.crop, sizeof def.crop);
  return def;
}

int job_make(Job *job, vlContext *context, vlScene *scene, const char *path,
             const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  vlSceneDefs *defs = vl_scene_defs(scene);
  job->context = context;
  job->path = path;
  job->defs = defs;
  job->camera_location = camera_location(defs, path);
  if (v[RENDER_CAMERA].given && !scene_camera_is_own(path, arguments)) {
    int status = -1;
    vl_context_record_files(context, false); /* the receipt holds the camera itself */
    if (job->receipt_camera)
      take_receipt_camera(job, defs);
    else
      status = take_camera(job, context, scene, v[RENDER_CAMERA].text, arguments);
    vl_context_record_files(context, job->records_files);
    TRY(status);
  }
  TRY(read_channels_time(job, arguments));
  TRY(override_stereo(defs, arguments));
  TRY(lens_override(scene, defs, arguments));
  TRY(fit_camera(job, defs, arguments));
  override_sampling(defs, arguments);
  defs->render.transparent = v[RENDER_TRANSPARENT].given;
  fix_sequence(&defs->render);
  if (v[RENDER_TIME].given)
    defs->render.time_limit = v[RENDER_TIME].number;
  return override_spectrum(defs, arguments);
}
