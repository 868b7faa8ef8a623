/* view/engine_sensor.c: the mode "camera": what a sensor makes of the film. The film has a
 * spectrum and a box filter then; its light becomes photoelectrons, these the numbers of a raw
 * image, and that is developed. Shutter, ISO speed and the other settings of the sensor need no
 * new samples: of a film that has no new ones the light is kept, and of settings that do not
 * change the light the photoelectrons. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/image.h"
#include "render/denoised.h"
#include "sensor/sensor.h"
#include "velo/filter_kinds.h"
#include "velo/setting.h"
#include "view/engine_sensor.h"
#include "view/view.h"

/* Buckets of the film: 48 bytes per pixel each. */
enum { BUCKETS = 24, MAX_BUCKETS = 1000 };

/* The exposure times that the meter chooses from, seconds. */
static const double min_time = 1e-6, max_time = 1e5;

void engine_sensor_film(vlFilmDef *def) {
  if (def->buckets < 2)
    def->buckets = BUCKETS;
  def->filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
}

void engine_sensor_forget(Engine *e) {
  Shot *s = &e->shot;
  vl_sensor_destroy(s->sensor);
  vl_image_destroy(s->light);
  vl_image_destroy(s->errors);
  vl_raw_destroy(s->raw);
  free(s->means);
  *s = (Shot){.spp = 0};
}

/* ---- the command line -------------------------------------------------------------------- */

/* Sets a number of the exposure that an option gives. */
static int take_number(const OptionValue *value, const char *option, const char *row_name,
                       vlExposureDef *exposure) {
  char why[VL_GIVEN_MESSAGE];
  const vlParameter *row = vl_setting(VL_SETTING_EXPOSURE, row_name);
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = value->number};
  double number;
  if (!value->given)
    return -1;
  if (!vl_given_check(row, option, &given, &number, why))
    return report_usage("--expose: %s", why);
  vl_given_put(row, number, exposure);
  return -1;
}

/* The sensor of a file: its name is the file's, without the folder. */
static void take_file(ViewSensors *sensors, const char *path, const vlSensor *sensor) {
  const char *name = text_file_name(path);
  sensors->file = *vl_sensor_def(sensor);
  text_set(sensors->own, "%s", strlen(name) < sizeof sensors->own ? name : "the sensor file");
}

int engine_sensor_begin(Engine *e) {
  const OptionValue *v = e->def.arguments->values;
  const char *name = v[VIEW_EXPOSE].text;
  ViewSensor *wanted = &e->wanted.sensor;
  vlSensor *sensor = NULL;
  if (!v[VIEW_EXPOSE].given)
    return -1;
  if (e->model.job.defs->build.color == VL_COLOR_RGB)
    return report_usage("--expose: --color rgb has no spectrum, which a sensor needs");
  TRY(sensor_open(e->def.context, "--expose", name, &sensor));
  if (sensor_is_file(name))
    take_file(&e->sensors, name, sensor);
  vl_sensor_destroy(sensor);
  TRY(take_number(&v[RENDER_ISO], "--iso", "iso", &wanted->exposure));
  TRY(take_number(&v[RENDER_SECONDS], "--seconds", "exposure_time", &wanted->exposure));
  text_set(wanted->preset, "%s", e->sensors.own[0] ? e->sensors.own : name);
  wanted->metered = !v[RENDER_SECONDS].given;
  e->wanted.channel = CHANNEL_CAMERA;
  return -1;
}

bool engine_sensor_changed(Engine *e, bool alone) {
  e->shot.keeps_light = alone && e->now.channel == CHANNEL_CAMERA;
  return e->shot.keeps_light;
}

/* ---- what the sensor sees ---------------------------------------------------------------- */

/* The sensor of the preset that is chosen. */
static vlResult take_sensor(Engine *e, vlError *error) {
  Shot *s = &e->shot;
  const char *preset = e->now.sensor.preset;
  vlSensorDef def;
  if (s->sensor && strcmp(preset, s->preset) == 0)
    return VL_OK;
  vl_sensor_destroy(s->sensor);
  s->sensor = NULL;
  s->is_collected = false;
  text_set(s->preset, "%s", preset);
  TRY_RESULT(sensor_find(&e->sensors, preset, &def, error));
  return vl_sensor_create(e->def.context, &def, &s->sensor, error);
}

/* The channels of two images of the same size in one image, with the first one's attributes:
 * they say which part of the whole it is. */
static vlResult join(Engine *e, vlImage *const parts[2], vlImage **joined) {
  const vlImage *const both[2] = {parts[0], parts[1]};
  TRY_RESULT(denoised_join(e->def.context, both, 2, NULL, joined));
  return vl_image_add_attributes(*joined, parts[0]);
}

/* The film's colours and their standard errors, by which the render's own noise is compared
 * with that of photons. They take long: those of half as many samples will do, until the image
 * is done. */
static vlResult take_errors(Engine *e, const vlFilm *film) {
  Shot *s = &e->shot;
  const vlDevelopDef *develop = &e->model.job.defs->develop;
  const uint32_t spp = vl_film_spp(film);
  vlImage *parts[2] = {NULL};
  if (s->errors && spp < 2 * s->error_spp && spp < e->now.spp)
    return VL_OK;
  vl_image_destroy(s->errors);
  s->errors = NULL;
  vlResult result = vl_film_develop(film, develop, &parts[0]);
  if (result == VL_OK)
    result = vl_film_errors(film, develop, &parts[1]);
  if (result == VL_OK)
    result = join(e, parts, &s->errors);
  s->error_spp = spp;
  vl_image_destroy(parts[0]);
  vl_image_destroy(parts[1]);
  return result;
}

/* The film's spectrum, and behind it what take_errors makes. A coarse film has no errors. */
static vlResult read_light(Engine *e, const vlFilm *film, uint32_t scale) {
  Shot *s = &e->shot;
  vlImage *spectrum = NULL;
  vlResult result = vl_film_spectrum(film, &spectrum);
  if (result == VL_OK && (scale > 1 || vl_film_spp(film) < 2)) {
    s->light = spectrum;
    return VL_OK;
  }
  if (result == VL_OK)
    result = take_errors(e, film);
  vlImage *parts[2] = {spectrum, s->errors};
  if (result == VL_OK)
    result = join(e, parts, &s->light);
  vl_image_destroy(spectrum);
  return result;
}

/* The number of channels of the spectrum. */
static uint32_t count_buckets(const vlImage *light) {
  uint32_t count = 0;
  while (count < vl_image_channels(light) &&
         strncmp(vl_image_channel_name(light, count), "S0.", 3) == 0)
    count++;
  return count;
}

/* The mean luminance of the film in cd/m^2; NaN: it has none. */
static double mean_luminance(const vlFilm *film) {
  vlImage *image = NULL;
  double sum = 0;
  if (vl_film_luminance(film, &image) != VL_OK)
    return NAN;
  const size_t pixels = image_pixel_count(image);
  const float *values = vl_image_const_pixels(image);
  for (size_t i = 0; i < pixels; i++)
    sum += isfinite(values[i]) ? (double)values[i] : 0;
  vl_image_destroy(image);
  return sum / (double)pixels;
}

/* The light of the film, unless it is there already. After a change of the sensor alone that of
 * somewhat fewer samples will do: to read a large film takes longer than to expose it. */
static vlResult take_light(Engine *e, const vlFilm *film, uint32_t scale) {
  Shot *s = &e->shot;
  const uint32_t spp = vl_film_spp(film);
  const bool is_enough = s->keeps_light || s->spp == spp;
  const bool same = s->film == film && s->generation == e->now.generation && s->scale == scale;
  s->keeps_light = false;
  if (s->light && same && is_enough)
    return VL_OK;
  if (!same) {
    vl_image_destroy(s->errors);
    s->errors = NULL;
  }
  vl_image_destroy(s->light);
  free(s->means);
  s->light = NULL;
  s->means = NULL;
  s->is_collected = false;
  TRY_RESULT(read_light(e, film, scale));
  const size_t pixels = image_pixel_count(s->light);
  s->film = film;
  s->generation = e->now.generation;
  s->scale = scale;
  s->spp = spp;
  s->buckets = count_buckets(s->light);
  s->luminance = mean_luminance(film);
  s->means = malloc(pixels * sizeof *s->means);
  return s->means ? VL_OK : VL_ERROR_MEMORY;
}

/* ---- the exposure ------------------------------------------------------------------------ */

/* The f-number is the lens's, if that has an opening. */
static vlExposureDef present_exposure(const Engine *e) {
  vlExposureDef exposure = e->now.sensor.exposure;
  const double lens = camera_f_number(&e->now.camera);
  if (lens >= 0.5 && lens <= 1000)
    exposure.f_number = lens;
  return exposure;
}

/* The mean of the photoelectrons. */
static double mean_electrons(const Shot *s) {
  const size_t pixels = image_pixel_count(s->light);
  double sum = 0;
  for (size_t i = 0; i < pixels; i++)
    sum += s->means[i];
  return sum / (double)pixels;
}

static vlResult collect(Shot *s, const vlExposureDef *exposure, vlError *error) {
  const bool same =
      s->exposure.time == exposure->time && s->exposure.f_number == exposure->f_number;
  if (s->is_collected && same)
    return VL_OK;
  vlResult result = vl_sensor_collect(s->sensor, s->light, exposure, s->means, &s->out, error);
  s->is_collected = result == VL_OK;
  s->exposure = *exposure;
  s->electrons = result == VL_OK ? mean_electrons(s) : 0;
  return result;
}

/* The time at which the mean number is middle grey. It is found from the photoelectrons of any
 * other time. */
static vlResult meter(Shot *s, vlExposureDef *exposure, vlError *error) {
  vlExposureDef trial = *exposure;
  trial.time = 0.01;
  if (s->is_collected && s->exposure.f_number == exposure->f_number && s->exposure.time > 0)
    trial.time = s->exposure.time;
  vlResult result = collect(s, &trial, error);
  const double time = engine_metered_time(s, exposure);
  exposure->time = time > 0 ? fmin(fmax(time, min_time), max_time) : 0.01;
  return result;
}

/* The mean spectrum of the image as a light, for each nm. */
static void mean_light(const Shot *s, float values[VL_SPECTRUM_VALUES]) {
  const uint32_t channels = vl_image_channels(s->light);
  const size_t pixels = image_pixel_count(s->light);
  const float *from = vl_image_const_pixels(s->light);
  double sums[MAX_BUCKETS] = {0};
  for (size_t i = 0; i < pixels; i++)
    for (uint32_t c = 0; c < s->buckets; c++)
      sums[c] += isfinite(from[i * channels + c]) ? (double)from[i * channels + c] : 0;
  for (uint32_t i = 0; i < VL_SPECTRUM_VALUES; i++) {
    const double sum = sums[i * s->buckets / VL_SPECTRUM_VALUES];
    values[i] = sum > 0 ? (float)(sum / (double)pixels) : 0;
  }
}

/* The white of the development. False: there is no light at all, and it is that of D65. */
static bool find_white(const Engine *e, float values[VL_SPECTRUM_VALUES]) {
  if (e->now.sensor.white == VIEW_WHITE_AUTO) {
    double sum = 0;
    mean_light(&e->shot, values);
    for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
      sum += (double)values[i];
    return sum > 0;
  }
  const vlSpectrum named =
      vl_spectrum_named(e->now.sensor.white == VIEW_WHITE_A ? "stdillum-A" : "stdillum-D65");
  return vl_spectrum_tabulate(&named, VL_PARAMETER_ILLUMINANT, values, NULL) == VL_OK;
}

static vlResult expose(Engine *e, vlError *error) {
  Shot *s = &e->shot;
  vlExposureDef exposure = present_exposure(e);
  vl_exposure_set_window(&exposure, s->light);
  const uint32_t width = vl_image_width(s->light), height = vl_image_height(s->light);
  float white[VL_SPECTRUM_VALUES];
  vlResult result = e->now.sensor.metered ? meter(s, &exposure, error) : VL_OK;
  if (result == VL_OK)
    result = collect(s, &exposure, error);
  s->exposure = exposure;
  vl_raw_destroy(s->raw);
  s->raw = NULL;
  TRY_RESULT(result);
  TRY_RESULT(vl_sensor_raw(s->sensor, &exposure, find_white(e, white) ? white : NULL, width,
                           height, &s->raw, error));
  s->out.numbers = vl_raw_numbers(s->raw);
  result = vl_sensor_read_out(s->sensor, width, height, s->means, &exposure, &s->out, error);
  s->out.numbers = NULL;
  return result;
}

/* ---- the image --------------------------------------------------------------------------- */

/* R G B of a grey image. */
static vlResult make_grey(vlContext *context, vlImage **image) {
  vlImage *colours = NULL;
  TRY_RESULT(image_make_like(context, *image, 3, NULL, &colours));
  const float *from = vl_image_const_pixels(*image);
  float *to = vl_image_pixels(colours);
  for (size_t i = 0; i < image_pixel_count(*image); i++)
    to[3 * i] = to[3 * i + 1] = to[3 * i + 2] = from[i];
  vl_image_destroy(*image);
  *image = colours;
  return VL_OK;
}

/* Linear sRGB: the page has the curve of the last step. */
static vlResult develop(Engine *e, vlImage **image, vlError *error) {
  vlRawDevelopDef def = vl_default_raw_develop_def();
  def.stop_at = VL_RAW_STEP_COLOR;
  TRY_RESULT(vl_raw_develop(e->shot.raw, &def, image, error));
  return vl_image_channels(*image) == 1 ? make_grey(e->def.context, image) : VL_OK;
}

void engine_publish_camera(Engine *e, const vlFilm *film, uint32_t scale) {
  const double start = monotonic_seconds();
  vlError error = {0};
  vlImage *image = NULL;
  vlResult result = take_sensor(e, &error);
  if (result == VL_OK)
    result = take_light(e, film, scale);
  if (result == VL_OK)
    result = expose(e, &error);
  if (result == VL_OK)
    result = develop(e, &image, &error);
  const FrameKind kind = {.format = FRAME_HALF,
                          .channels = 3,
                          .scale = scale,
                          .spp = scale > 1 ? 0 : e->shot.spp,
                          .developed = true};
  if (result == VL_OK) {
    engine_publish(e, image, &kind);
    engine_tell_exposure(e, monotonic_seconds() - start);
  } else {
    status_error(e, &error, result);
  }
  vl_image_destroy(image);
}
