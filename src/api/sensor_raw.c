/* api/sensor_raw.c: the raw image of an exposure (velo/sensor_raw.h). */
#include "velo/sensor_raw.h"

#include <math.h>

#include "sensor/sensor.h"

/* The value; 0, which stands for an unknown one, if it is beyond what a raw image holds. */
static float known_or_zero(double value) {
  return value >= 1e-6 && value <= 1e6 ? (float)value : 0.0f;
}

/* Black and white level, gain and noise of the raw image's numbers. */
static void set_levels(const vlSensorDef *sensor, const vlExposureDef *exposure,
                       vlRawDef *def) {
  double per_electron = vl_exposure_gain(sensor, exposure) / sensor->gain;
  double dark = vl_exposure_dark(sensor, exposure);
  double largest = ldexp(1.0, (int)sensor->bits) - 1.0;
  double black = fmin(sensor->black_level + per_electron * dark, largest);
  double full = fmin(sensor->black_level + per_electron * sensor->full_well, largest);
  double adc = sensor->adc_noise / per_electron;
  double variance = sensor->read_noise * sensor->read_noise + adc * adc + dark +
                    sensor->row_noise * sensor->row_noise +
                    sensor->column_noise * sensor->column_noise;
  def->bits = sensor->bits;
  def->white = (uint16_t)floor(full + 0.5);
  for (uint32_t i = 0; i < def->pattern_rows * def->pattern_columns; i++)
    def->black[i] = (uint16_t)floor(black + 0.5);
  def->gain = known_or_zero(per_electron);
  def->read_noise = known_or_zero(sqrt(variance));
}

static void set_exposure(const vlSensorDef *sensor, const vlExposureDef *exposure,
                         vlRawDef *def) {
  double iso = sensor->base_iso * vl_exposure_gain(sensor, exposure) + 0.5;
  def->exposure_time = known_or_zero(vl_exposure_seconds(exposure));
  def->f_number = known_or_zero(exposure->f_number);
  def->focal_length = known_or_zero(exposure->focal_length / 1000.0);
  def->iso = iso >= 1.0 && iso < 65536.0 ? (uint32_t)iso : 0;
}

/* The sensitivities of the raw image's colours: efficiencies times the wavelength. */
static void set_color(const vlSensorDef *sensor, const float *light, vlRawDef *def) {
  float sensitivities[VL_RAW_MAX_COLORS * VL_SPECTRUM_VALUES];
  uint8_t colors[VL_RAW_MAX_COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  static const char letters[] = "RGBCMYW"; /* of vlRawColor's codes */
  for (uint32_t k = 0; k < count; k++) {
    const vlSensorFilter *filter =
        &sensor->filters[vl_sensor_filter_index(sensor, letters[colors[k]])];
    for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
      sensitivities[k * VL_SPECTRUM_VALUES + i] =
          filter->efficiency[i] * (float)(VL_SPECTRUM_FIRST_NM + i);
  }
  vl_raw_match_color(def, sensitivities, light, NULL); /* if it fails, def has no colour */
}

/* The sensor whose mosaic begins at the window's first corner. */
static vlSensorDef in_window(const vlSensorDef *sensor, const uint32_t window[4]) {
  vlSensorDef def = *sensor;
  for (uint32_t y = 0; y < def.pattern_height; y++)
    for (uint32_t x = 0; x < def.pattern_width; x++) {
      uint32_t row = (window[1] + y) % def.pattern_height;
      uint32_t column = (window[0] + x) % def.pattern_width;
      def.pattern[y * def.pattern_width + x] =
          sensor->pattern[row * def.pattern_width + column];
    }
  return def;
}

vlResult vl_sensor_raw(const vlSensor *sensor, const vlExposureDef *exposure,
                       const float *light, uint32_t width, uint32_t height, vlRaw **raw,
                       vlError *error) {
  const vlExposureDef usual = vl_default_exposure_def();
  char pattern[2 * VL_SENSOR_CELLS + 1];
  vl_error_clear(error);
  if (!sensor || !raw)
    return vl_fail_argument(error, "raw image: sensor or result is null");
  *raw = NULL;
  exposure = exposure ? exposure : &usual;
  uint32_t window[4];
  VL_TRY(vl_exposure_check(exposure, error));
  VL_TRY(vl_exposure_window(exposure, width, height, window, error));
  const vlSensorDef part = in_window(&sensor->def, window);
  vlRawDef def = vl_default_raw_def(width, height);
  VL_TRY(vl_raw_set_pattern(&def, vl_sensor_pattern(&part, pattern), error));
  set_levels(&sensor->def, exposure, &def);
  set_exposure(&sensor->def, exposure, &def);
  set_color(&sensor->def, light, &def);
  return vl_raw_create(sensor->context, &def, raw, error);
}
