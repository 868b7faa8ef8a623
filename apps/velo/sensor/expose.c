/* sensor/expose.c: `velo sensor expose`: exposes a sensor to a stored spectral image and writes
 * the numbers of its frames, or its electrons. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/header.h"
#include "image/image.h"
#include "render/output_names.h"
#include "render/pattern.h"
#include "sensor/sensor.h"
#include "velo/sensor_raw.h"

enum {
  EXPOSE_OUTPUT,
  EXPOSE_SENSOR,
  EXPOSE_TIME,
  EXPOSE_F_NUMBER,
  EXPOSE_ISO,
  EXPOSE_GAIN,
  EXPOSE_TEMPERATURE,
  EXPOSE_FOCAL_LENGTH,
  EXPOSE_RADIANCE,
  EXPOSE_SEED,
  EXPOSE_FRAME,
  EXPOSE_BRACKET,
  EXPOSE_WHITE,
  EXPOSE_THREADS
};
enum { MAX_FRAMES = 64 };

typedef struct Expose {
  vlContext *context;
  vlSensor *sensor;
  vlImage *image, *numbers, *electrons;
  double *means;
  vlExposureDef exposure;
  double bracket[MAX_FRAMES]; /* stops */
  uint32_t frames;
  float light[VL_SPECTRUM_VALUES]; /* the white of raw files */
  const char *path;                /* of the image */
  const char *const *paths;
  int count;
} Expose;

/* ---- what is asked ---------------------------------------------------------------------- */

/* Files of velo/raw.h. */
static bool is_raw_file(const char *path) {
  return text_ends_with(path, ".dng") || text_ends_with(path, ".tif") ||
         text_ends_with(path, ".tiff");
}

static bool holds_electrons(const char *path) {
  return text_ends_with(path, ".exr");
}

/* Reads "-2,0,2". */
static int parse_bracket(Expose *e, const OptionValue *value) {
  const char *at = value->given ? value->text : "0";
  for (;;) {
    char *end;
    double stops = strtod(at, &end);
    if (end == at || !(stops >= -30 && stops <= 30) || (*end && *end != ',') ||
        e->frames == MAX_FRAMES)
      return report_usage(
          "--bracket must be at most %d numbers from -30 to 30 stops, with "
          "commas between; it is \"%s\"",
          MAX_FRAMES, value->text);
    e->bracket[e->frames++] = stops;
    if (!*end)
      return -1;
    at = end + 1;
  }
}

static int check_outputs(const Expose *e) {
  if (!e->count)
    return report_usage("sensor expose: give the name of the raw image with -o");
  for (int i = 0; i < e->count; i++) {
    const char *path = e->paths[i];
    if (!holds_electrons(path) && !is_raw_file(path) && !text_ends_with(path, ".png"))
      return report_usage(
          "output \"%s\": the suffix must be .dng (a raw file), .tif or .png (numbers, 16 bits) or "
          ".exr (electrons)",
          path);
    TRY(pattern_check(path));
    if (e->frames > 1 && !pattern_has(path, 'd'))
      return report_usage("output \"%s\": the name of several frames needs %%d", path);
  }
  return -1;
}

static bool path_of(const char *pattern, uint32_t frame, char path[4096]) {
  PatternValues values = {.number = frame};
  return pattern_expand(pattern, &values, path, 4096);
}

/* No file that is written twice, or was read. */
static int check_names(const Expose *e) {
  OutputNames names = {0};
  char path[4096];
  for (uint32_t f = 0; f < e->frames; f++)
    for (int i = 0; i < e->count; i++) {
      if (!path_of(e->paths[i], f, path))
        return report_usage("output \"%s\": too long", e->paths[i]);
      output_names_add(&names, path, VL_OUTPUT_PLAIN);
    }
  return output_names_check(&names, e->context);
}

/* ---- frames ----------------------------------------------------------------------------- */

static vlResult add_number(vlImage *image, const char *name, double value) {
  vlAttribute attribute = {.name = name, .type = VL_ATTRIBUTE_DOUBLE, .numbers = {value}};
  return vl_image_set_attribute(image, &attribute);
}

/* What the electrons of an .exr mean. */
static vlResult describe(const Expose *e, const vlExposureDef *exposure) {
  const vlSensorDef *def = vl_sensor_def(e->sensor);
  char text[2 * VL_SENSOR_CELLS + 1];
  TRY_RESULT(image_set_text(e->electrons, "sensorPattern", vl_sensor_pattern(def, text)));
  TRY_RESULT(vl_exposure_write_window(exposure, e->electrons));
  TRY_RESULT(add_number(e->electrons, "exposureTime", exposure->time));
  TRY_RESULT(add_number(e->electrons, "exposureStops", exposure->stops));
  TRY_RESULT(add_number(e->electrons, "fNumber", exposure->f_number));
  return add_number(e->electrons, "sensorFullWell", def->full_well);
}

static vlResult write_raw(const Expose *e, const char *path, const vlExposureDef *exposure,
                          vlError *error) {
  vlRaw *raw = NULL;
  uint32_t width = vl_image_width(e->numbers), height = vl_image_height(e->numbers);
  TRY_RESULT(vl_sensor_raw(e->sensor, exposure, e->light, width, height, &raw, error));
  memcpy(vl_raw_numbers(raw), vl_image_const_pixels(e->numbers),
         sizeof(uint16_t) * width * height);
  vlResult result = vl_raw_write(raw, path, error);
  vl_raw_destroy(raw);
  return result;
}

/* Reads the spectrum of --white: that of D65 if there is none. */
static int read_white(Expose *e, const OptionValue *value) {
  vlSpectrum spectrum = vl_spectrum_named(value->given ? value->text : "stdillum-D65");
  vlError error = {0};
  vlResult result = vl_spectrum_tabulate(&spectrum, VL_PARAMETER_ILLUMINANT, e->light, &error);
  return result == VL_OK ? -1 : report_usage("--white: %s", error.message);
}

static int write_frame(Expose *e, uint32_t frame, const vlExposureDef *exposure) {
  char path[4096];
  TRY(report_reason(describe(e, exposure), e->paths[0], "the frame cannot be described"));
  for (int i = 0; i < e->count; i++) {
    vlError error = {0};
    path_of(e->paths[i], frame, path);
    const vlImage *image = holds_electrons(path) ? e->electrons : e->numbers;
    TRY(report_error(&error,
                     is_raw_file(path) ? write_raw(e, path, exposure, &error)
                                       : vl_image_write(image, path, NULL, &error),
                     path));
  }
  return -1;
}

/* A sample has 4 wavelengths. */
static void tell_few_samples(const vlImage *image) {
  vlAttribute samples;
  uint32_t buckets = 0;
  for (uint32_t c = 0; c < vl_image_channels(image); c++)
    buckets += strncmp(vl_image_channel_name(image, c), "S0.", 3) == 0;
  if (vl_image_find_attribute(image, "samplesPerPixel", &samples) != VL_OK ||
      4 * samples.numbers[0] >= buckets)
    return;
  report_warning(
      "the image has %.0f samples per pixel for %u buckets of its spectrum; most buckets have "
      "what lies between those beside them: render it with --spp %u or more",
      samples.numbers[0], buckets, buckets);
}

/* Pixels of a sensor collect the light of their own area. */
static void tell_filter(const vlImage *image) {
  const char *filter = header_text(image, "velo.filter");
  if (filter && strcmp(filter, "box") != 0)
    report_warning(
        "the image has the filter \"%s\", which takes light of the neighbours; a pixel of a "
        "sensor has its own area: render it with --filter box",
        filter);
}

/* What a reader of the frame should know. */
static void tell(const Expose *e, uint32_t frame, const vlSensorOutput *out) {
  double pixels = (double)image_pixel_count(e->image);
  if (frame == 0) {
    tell_few_samples(e->image);
    tell_filter(e->image);
  }
  if (frame == 0 && out->not_finite)
    report_warning("%llu pixels of the image are not finite; the sensor sees them black",
                   (unsigned long long)out->not_finite);
  if (frame == 0 && out->negative)
    report_warning("%llu pixels of the image are negative; the sensor sees them black",
                   (unsigned long long)out->negative);
  if (isnan(out->film_noise)) {
    if (frame == 0)
      report_note(
          "the image has no standard errors (--channels error), so its own noise is "
          "not compared with photon noise");
  } else if (out->film_noise > 0.01) {
    report_warning(
        "frame %u: in %.0f %% of the pixels the image's own noise is above a tenth "
        "of the photon noise: render it with more samples",
        frame, 100.0 * out->film_noise);
  }
  report_note(
      "frame %u: %.2f %% of the pixels have a full well, %.2f %% are above the "
      "converter's range, %.2f %% below",
      frame, 100.0 * (double)out->full / pixels, 100.0 * (double)out->white / pixels,
      100.0 * (double)out->black / pixels);
}

/* Of an image whose camera moves or whose rows have times of their own, the exposure is the
 * interval of its shutter. */
static void tell_motion(const Expose *e) {
  vlAttribute shutter;
  vlAttribute readout;
  vlAttribute moves;
  if (vl_image_find_attribute(e->image, "velo.shutter", &shutter) != VL_OK)
    return;
  bool rolls = vl_image_find_attribute(e->image, "velo.readout", &readout) == VL_OK;
  if (!rolls && vl_image_find_attribute(e->image, "velo.worldFromCameraOpen", &moves) != VL_OK)
    return;
  double open = shutter.numbers[1] - shutter.numbers[0];
  double time = e->exposure.time;
  if (open > 0.0 && fabs(time - open) > 0.01 * open)
    report_warning(
        "the image's camera %s, and its shutter is open for %g s; the sensor is exposed for "
        "%g s: --exposure-time %g has the light of that motion",
        rolls ? "has a rolling shutter" : "moves", open, time, open);
}

static int expose(Expose *e) {
  uint32_t width = vl_image_width(e->image);
  uint32_t height = vl_image_height(e->image);
  for (uint32_t f = 0; f < e->frames; f++) {
    vlError error = {0};
    vlExposureDef exposure = e->exposure;
    exposure.stops = e->bracket[f];
    exposure.frame += f;
    vl_exposure_set_window(&exposure, e->image);
    vlSensorOutput out = {.numbers = vl_image_pixels(e->numbers),
                          .electrons = vl_image_pixels(e->electrons)};
    vlResult result = vl_sensor_collect(e->sensor, e->image, &exposure, e->means, &out, &error);
    if (result == VL_OK)
      result = vl_sensor_read_out(e->sensor, width, height, e->means, &exposure, &out, &error);
    if (result == VL_ERROR_ARGUMENT)
      return report_failure(STATUS_SCENE, "%s: %s", e->path, error.message);
    TRY(report_error(&error, result, NULL));
    tell(e, f, &out);
    TRY(write_frame(e, f, &exposure));
  }
  return STATUS_OK;
}

static int make_frames(Expose *e) {
  uint32_t width = vl_image_width(e->image);
  uint32_t height = vl_image_height(e->image);
  vlImageDef def = vl_default_image_def(width, height, 1);
  def.type = VL_PIXEL_U16;
  vlResult result = vl_image_create(e->context, &def, &e->numbers);
  static const char *const name[1] = {"electrons"};
  if (result == VL_OK)
    result = image_make(e->context, width, height, 1, name, &e->electrons);
  e->means = malloc(sizeof *e->means * width * height);
  if (result == VL_OK && !e->means)
    result = VL_ERROR_MEMORY;
  return report_reason(result, e->path, "the frame cannot be made");
}

static int run(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  Expose e = {.path = arguments->operands[0],
              .context = context,
              .exposure = vl_default_exposure_def(),
              .paths = arguments->texts,
              .count = arguments->text_count};
  TRY(exposure_options(arguments, &e.exposure));
  TRY(parse_bracket(&e, &v[EXPOSE_BRACKET]));
  TRY(read_white(&e, &v[EXPOSE_WHITE]));
  TRY(check_outputs(&e));
  int status = sensor_open(e.context, "--sensor",
                           v[EXPOSE_SENSOR].given ? v[EXPOSE_SENSOR].text : "ideal", &e.sensor);
  if (status < 0)
    status = image_load(e.context, e.path, &e.image);
  if (status < 0)
    status = check_names(&e);
  if (status < 0)
    status = make_frames(&e);
  if (status < 0)
    tell_motion(&e);
  if (status < 0)
    status = expose(&e);
  free(e.means);
  vl_image_destroy(e.numbers);
  vl_image_destroy(e.electrons);
  vl_image_destroy(e.image);
  vl_sensor_destroy(e.sensor);
  return status;
}

static Option options[] = {
    {EXPOSE_OUTPUT, "output",
     "file to write; may be given several times: .dng is a raw file with all metadata, .tif "
     "and .png have the numbers (16 bits), .exr the electrons",
     OPTION_TEXTS, "FILE", .letter = 'o'},
    {EXPOSE_SENSOR, "sensor",
     "a sensor file (.yaml), or ideal, ideal_rggb, generic_mono, generic_rggb, generic_quad, "
     "raspberry_pi_hq, or generic_rggb with the sensitivities of a measured camera "
     "(canon_eos_5d, ...). Default: ideal",
     OPTION_TEXT, "NAME|FILE"},
    {EXPOSE_TIME, "exposure-time", "exposure time in seconds", OPTION_TEXT, "S"},
    {EXPOSE_F_NUMBER, "f-number", "focal length divided by the pupil's diameter", OPTION_TEXT,
     "N"},
    {EXPOSE_ISO, "iso", "ISO speed; default: the sensor's base_iso", OPTION_TEXT, "N"},
    {EXPOSE_GAIN, "gain", "a further factor of the amplifier", OPTION_TEXT, "FACTOR"},
    {EXPOSE_TEMPERATURE, "temperature", "temperature of the sensor, degrees Celsius",
     OPTION_TEXT, "C"},
    {EXPOSE_FOCAL_LENGTH, "focal-length",
     "darken the image with cos^4 of the angle from the axis, as a lens of this focal length; "
     "not for cameras that have done so",
     OPTION_TEXT, "MM"},
    {EXPOSE_RADIANCE, "radiance",
     "radiance of the image's value 1, W/(m^2 sr nm); default 1/72983: 1 is 1 cd/m^2",
     OPTION_TEXT, "L"},
    {EXPOSE_SEED, "seed", "seed of the noise", OPTION_TEXT, "N"},
    {EXPOSE_FRAME, "frame", "number of the first frame: other noise with the same seed",
     OPTION_TEXT, "N"},
    {EXPOSE_BRACKET, "bracket",
     "a frame for each number: the exposure time times 2^EV. The names need %d: raw_%d.png",
     OPTION_TEXT, "EV,EV,..."},
    {EXPOSE_WHITE, "white",
     "what raw files (.dng) call the white of the scene's light: stdillum-A, stdillum-D50, "
     "...; default: stdillum-D65",
     OPTION_TEXT, "SPECTRUM"},
    THREADS_OPTION(EXPOSE_THREADS, "result"),
    {0}};

const Command sensor_expose_command = {
    .name = "sensor expose",
    .usage = "FILE.exr -o FILE [options]",
    .summary = "expose a sensor to a stored spectral image",
    .text =
        "Reads an image with a spectrum (velo render --spectrum N --filter box) and computes "
        "what a\n"
        "sensor makes of it: photons, electrons and whole numbers, with noise. docs/sensor.md "
        "has the\n"
        "model and the form of sensor files.",
    .examples =
        "velo sensor expose room.exr --sensor generic_rggb --iso 400 -o raw.dng\n"
        "velo sensor expose room.exr --sensor my.yaml --bracket -4,-2,0 -o raw_%d.png",
    .options = options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run,
};
