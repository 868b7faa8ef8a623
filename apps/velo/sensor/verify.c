/* sensor/verify.c: `velo sensor verify`: exposes a sensor to flat fields and a slanted edge,
 * measures its parameters by EMVA 1288 and ISO 12233, and compares them with its own numbers.
 */
#include "sensor/verify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "sensor/sensor.h"

enum {
  VERIFY_ISO,
  VERIFY_TEMPERATURE,
  VERIFY_SEED,
  VERIFY_SIZE,
  VERIFY_STACK,
  VERIFY_FRAMES,
  VERIFY_PLOT,
  VERIFY_THREADS
};
/* Light and times of the steps: the last one is 8 % above the saturation, and long enough for
 * five dark electrons. */
static void plan(Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double iso = v->exposure.iso > 0.0 ? v->exposure.iso / def->base_iso : 1.0;
  double warmer = v->exposure.temperature - def->dark_temperature;
  double dark = def->dark_current * exp2(warmer / def->doubling);
  v->gain = iso * v->exposure.gain / def->gain;
  double converter = (exp2(def->bits) - 1.0 - def->black_level) / v->gain;
  v->saturation = fmin(def->full_well, converter);
  v->full_electrons = 1.08 * v->saturation;
  v->full_time = dark > 0.0 ? fmin(fmax(5.0 / dark, 1e-3), 1e4) : 0.05;
  v->full_time = floor(v->full_time * 1e6 + 0.5) * 1e-6; /* the same on every machine */
  double largest = 0.0;
  for (uint32_t f = 0; f < def->filter_count; f++)
    for (int i = 0; i < VL_SENSOR_WAVELENGTHS; i++)
      largest = fmax(largest, (double)def->filters[f].efficiency[i]);
  v->efficiency = fmax(largest * def->fill_factor, 1e-6);
}

/* Frames of a stack, so many that the noise that is left in the pixels' means adds a tenth to
 * the error of a pattern's variance: the noise is then about a third of it. */
static uint32_t frames_for(double noise, double pattern) {
  double frames = pattern > 0.0 ? 3.0 * noise / pattern : 0.0;
  return (uint32_t)fmin(fmax(ceil(frames), 16.0), 400.0);
}

static void plan_stack(Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double rounding = 1.0 / 12.0 / (v->gain * v->gain);
  double adc = def->adc_noise / v->gain;
  double dark = def->read_noise * def->read_noise + def->row_noise * def->row_noise +
                def->column_noise * def->column_noise + adc * adc + rounding;
  double half = 0.5 * v->saturation;
  uint32_t frames = frames_for(dark, def->dsnu * def->dsnu);
  uint32_t bright = frames_for(dark + half, def->prnu * half * (def->prnu * half));
  v->stack = frames > bright ? frames : bright;
}

static void print_rows(const Verify *v) {
  printf("%-24s %14s %14s %12s\n", "", "expected", "measured", "difference");
  for (int i = 0; i < v->count; i++) {
    const VerifyRow *row = &v->rows[i];
    char name[64];
    text_set(name, "%s, %s", row->name, row->unit);
    if (row->skip)
      printf("%-24s %s\n", name, row->skip);
    else if (isnan(row->expected))
      printf("%-24s %14s %14.6g %12s %s\n", name, "-", row->measured, "",
             verify_passes(row) ? "ok" : "TOO LARGE");
    else
      printf("%-24s %14.6g %14.6g %10.3f %% %s\n", name, row->expected, row->measured,
             100.0 * (row->measured / row->expected - 1.0),
             verify_passes(row) ? "ok" : "WRONG");
  }
}

static int allocate(Verify *v) {
  size_t count = (size_t)v->size * v->size;
  v->means = malloc(count * sizeof *v->means);
  v->frames[0] = malloc(count * sizeof *v->frames[0]);
  v->frames[1] = malloc(count * sizeof *v->frames[1]);
  return v->means && v->frames[0] && v->frames[1] ? -1 : report_no_memory();
}

static int verify(Verify *v, const OptionValue *plot) {
  plan(v);
  if (!v->stack)
    plan_stack(v);
  TRY(allocate(v));
  TRY(verify_frames(v));
  verify_parameters(v);
  TRY(verify_edge(v));
  if (plot->given)
    TRY(verify_plot(v, plot->text));
  print_rows(v);
  int status = STATUS_OK;
  for (int i = 0; i < v->count; i++)
    if (!verify_passes(&v->rows[i]))
      status = STATUS_OTHER;
  return status;
}

static int run(const Arguments *arguments, vlContext *context) {
  const OptionValue *values = arguments->values;
  Verify v = {.context = context, .exposure = vl_default_exposure_def(), .size = 512};
  TRY(exposure_options(arguments, &v.exposure));
  v.size = option_count(&values[VERIFY_SIZE], v.size);
  v.stack = option_count(&values[VERIFY_STACK], v.stack);
  v.folder = values[VERIFY_FRAMES].text;
  int status = sensor_open(v.context, "sensor verify", arguments->operands[0], &v.sensor);
  if (status < 0)
    status = verify(&v, &values[VERIFY_PLOT]);
  verify_folder_close(&v);
  free(v.means);
  free(v.frames[0]);
  free(v.frames[1]);
  vl_sensor_destroy(v.sensor);
  return status;
}

static Option options[] = {
    {VERIFY_ISO, "iso", "ISO speed; default: the sensor's base_iso", OPTION_TEXT, "N"},
    {VERIFY_TEMPERATURE, "temperature", "temperature of the sensor, degrees Celsius",
     OPTION_TEXT, "C"},
    {VERIFY_SEED, "seed", "seed of the noise", OPTION_TEXT, "N"},
    {VERIFY_SIZE, "size", "side of the frames in pixels; default 512", OPTION_INTEGER, "N", 16,
     4096},
    {VERIFY_STACK, "stack",
     "frames of the stacks for DSNU and PRNU; default: 16 to 400, by the sensor's noise",
     OPTION_INTEGER, "N", 3, 1000},
    {VERIFY_FRAMES, "frames",
     "write the frames (.png, 16 bits) and the descriptor EMVA1288_Data.txt, which EMVA's own "
     "program reads, to a new folder",
     OPTION_TEXT, "DIR"},
    {VERIFY_PLOT, "plot", "write the photon transfer curve", OPTION_TEXT, "FILE.svg"},
    THREADS_OPTION(VERIFY_THREADS, "result"),
    {0}};

const Command sensor_verify_command = {
    .name = "sensor verify",
    .usage = "NAME|FILE [options]",
    .summary = "measure a sensor by EMVA 1288 and compare it with itself",
    .text =
        "Exposes the sensor to flat fields, dark frames and a slanted edge, which are "
        "computed, not\n"
        "rendered, and measures gain, noise, dark current, saturation, DSNU, PRNU, linearity "
        "and MTF.\n"
        "Exit code 1: a parameter differs by more than 1 % (linearity: 0.1 %, MTF: 2 %).",
    .examples =
        "velo sensor verify generic_mono --plot transfer.svg\n"
        "velo sensor verify my.yaml --frames emva",
    .options = options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run,
};
