/* sensor/read_out.c: from mean photoelectrons to the whole numbers of a frame, with the noise
 * of each step. The order of the steps is that of docs/sensor.md. */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "sensor/random.h"
#include "sensor/sensor.h"

typedef struct ReadOut {
  const vlSensor *sensor;
  uint32_t width;
  uint32_t window[4]; /* left, top, width and height of the whole */
  const double *means;
  vlSensorOutput *out;
  const double *columns; /* offset of each column, e- */
  double dark;           /* mean dark electrons */
  double per_electron;   /* DN/e- */
  double largest;        /* number of the converter, DN */
  uint64_t keys[VL_STAGE_COLUMN + 1];
  atomic_uint_fast64_t full, black, white;
} ReadOut;

/* A normal number of a stage, times its deviation; without a deviation none is drawn. */
static double normal(const ReadOut *r, vlSensorStage stage, uint64_t index, double deviation) {
  if (deviation == 0.0)
    return 0.0;
  vlRandom random = vl_random_at(r->keys[stage], index);
  return deviation * vl_random_normal(&random);
}

/* The electrons in a pixel's well at the end of the exposure. pixel: its number in the whole
 * frame. */
static double well(const ReadOut *r, double mean, uint64_t pixel) {
  const vlSensorDef *def = &r->sensor->def;
  mean = mean > 0.0 ? mean : 0.0; /* NaN, too */
  mean *= 1.0 + normal(r, VL_STAGE_PRNU, pixel, def->prnu);
  double dark =
      r->dark * (1.0 + normal(r, VL_STAGE_DARK_PATTERN, pixel, def->dark_nonuniformity));
  mean = (mean > 0.0 ? mean : 0.0) + (dark > 0.0 ? dark : 0.0);
  vlRandom random = vl_random_at(r->keys[VL_STAGE_ELECTRONS], pixel);
  return vl_random_poisson(&random, mean);
}

static void read_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  ReadOut *r = user;
  const vlSensorDef *def = &r->sensor->def;
  uint64_t whole_row = (uint64_t)r->window[1] + y;
  double row = normal(r, VL_STAGE_ROW, whole_row, def->row_noise);
  uint64_t full = 0;
  uint64_t black = 0;
  uint64_t white = 0;
  for (uint32_t x = 0; x < r->width; x++) {
    uint64_t at = (uint64_t)y * r->width + x;
    uint64_t pixel = whole_row * r->window[2] + r->window[0] + x;
    double electrons = well(r, r->means[at], pixel);
    full += electrons >= def->full_well;
    electrons = electrons < def->full_well ? electrons : def->full_well;
    electrons += normal(r, VL_STAGE_DSNU, pixel, def->dsnu);
    electrons += normal(r, VL_STAGE_READ, pixel, def->read_noise) + row + r->columns[x];
    double number = electrons * r->per_electron + def->black_level;
    number += normal(r, VL_STAGE_ADC, pixel, def->adc_noise);
    number = __builtin_floor(number + 0.5);
    black += number < 0.0;
    white += number > r->largest;
    number = number < 0.0 ? 0.0 : number > r->largest ? r->largest : number;
    if (r->out->numbers)
      r->out->numbers[at] = (uint16_t)number;
    if (r->out->electrons)
      r->out->electrons[at] = (float)electrons;
  }
  atomic_fetch_add(&r->full, full);
  atomic_fetch_add(&r->black, black);
  atomic_fetch_add(&r->white, white);
}

static void set_up(ReadOut *r, const vlExposureDef *exposure) {
  const vlSensorDef *def = &r->sensor->def;
  r->dark = vl_exposure_dark(def, exposure);
  r->per_electron = vl_exposure_gain(def, exposure) / def->gain;
  r->largest = ldexp(1.0, (int)def->bits) - 1.0;
  for (int i = 0; i <= VL_STAGE_COLUMN; i++) {
    bool fixed = i < VL_STAGE_ELECTRONS;
    r->keys[i] = vl_random_key(fixed ? def->seed : exposure->seed, fixed ? 0 : exposure->frame,
                               (vlSensorStage)i);
  }
}

vlResult vl_sensor_read_out(const vlSensor *sensor, uint32_t width, uint32_t height,
                            const double *means, const vlExposureDef *exposure,
                            vlSensorOutput *out, vlError *error) {
  vlExposureDef usual = vl_default_exposure_def();
  vl_error_clear(error);
  if (!sensor || !means || !out || !width || !height)
    return vl_fail_argument(error, "an argument is null");
  exposure = exposure ? exposure : &usual;
  uint32_t window[4];
  VL_TRY(vl_exposure_check(exposure, error));
  VL_TRY(vl_exposure_window(exposure, width, height, window, error));
  double *columns = vl_alloc_array(sensor->context, width, sizeof *columns);
  if (!columns)
    return vl_fail_memory(error);
  ReadOut r = {
      .sensor = sensor, .width = width, .means = means, .out = out, .columns = columns};
  memcpy(r.window, window, sizeof window);
  set_up(&r, exposure);
  for (uint32_t x = 0; x < width; x++)
    columns[x] = normal(&r, VL_STAGE_COLUMN, (uint64_t)window[0] + x, sensor->def.column_noise);
  vl_parallel_for(sensor->context, height, read_row, &r);
  vl_free(sensor->context, columns);
  out->full = atomic_load(&r.full);
  out->black = atomic_load(&r.black);
  out->white = atomic_load(&r.white);
  return VL_OK;
}

vlResult vl_sensor_expose(const vlSensor *sensor, const vlImage *image,
                          const vlExposureDef *exposure, vlSensorOutput *out, vlError *error) {
  if (!sensor || !image || !out)
    return vl_fail_argument(error, "an argument is null");
  vlExposureDef own = exposure ? *exposure : vl_default_exposure_def();
  uint32_t width = vl_image_width(image);
  uint32_t height = vl_image_height(image);
  vl_exposure_set_window(&own, image);
  double *means = vl_alloc_array(sensor->context, (size_t)width * height, sizeof *means);
  if (!means)
    return vl_fail_memory(error);
  vlResult result = vl_sensor_collect(sensor, image, &own, means, out, error);
  if (result == VL_OK)
    result = vl_sensor_read_out(sensor, width, height, means, &own, out, error);
  vl_free(sensor->context, means);
  return result;
}
