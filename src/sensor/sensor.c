/* sensor/sensor.c: defs of sensors and exposures: defaults, checks, mosaics, efficiencies. */
#include "sensor/sensor.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/text.h"
#include "color/sensor.h"
#include "math/elementary.h"
#include "schema/schema.h"

vlSensorDef vl_default_sensor_def(void) {
  vlSensorDef def = {.cookie = VL_COOKIE_SENSOR};
  vl_row_set_defaults(&vl_sensor_settings_row, &def);
  def.crosstalk[4] = 1.0;
  def.pattern_width = 1;
  def.pattern_height = 1;
  def.pattern[0] = 'W';
  def.filter_count = 1;
  def.filters[0].name = 'W';
  for (int i = 0; i < VL_SENSOR_WAVELENGTHS; i++)
    def.filters[0].efficiency[i] = 1.0f;
  return def;
}

vlExposureDef vl_default_exposure_def(void) {
  vlExposureDef def = {.cookie = VL_COOKIE_EXPOSURE};
  vl_row_set_defaults(&vl_exposure_settings_row, &def);
  return def;
}

/* ---- mosaics ----------------------------------------------------------------------------- */

static const struct {
  const char *name, *rows;
} patterns[] = {{"mono", "W"},
                {"rggb", "RG/GB"},
                {"bggr", "BG/GR"},
                {"grbg", "GR/BG"},
                {"gbrg", "GB/RG"},
                {"quad", "RRGG/RRGG/GGBB/GGBB"},
                {"rgbw", "WRWG/RWGW/WGWB/GWBW"}};

static bool same_word(const char *a, const char *b) {
  for (; *a && *b; a++, b++)
    if (tolower((unsigned char)*a) != tolower((unsigned char)*b))
      return false;
  return *a == *b;
}

vlResult vl_sensor_set_pattern(vlSensorDef *def, const char *pattern, vlError *error) {
  if (!def || !pattern)
    return vl_fail_argument(error, "pattern is missing");
  const char *rows = pattern;
  for (size_t i = 0; i < VL_LENGTH(patterns); i++)
    if (same_word(pattern, patterns[i].name))
      rows = patterns[i].rows;
  char cells[VL_SENSOR_CELLS];
  uint32_t count = 0;
  uint32_t width = 0;
  uint32_t column = 0;
  for (const char *at = rows;; at++) {
    bool ends = !*at || *at == '/';
    width = ends && !width ? column : width;
    if ((ends && column != width) ||
        (!ends && (!isalpha((unsigned char)*at) || count == VL_SENSOR_CELLS)))
      width = 0;
    if (!width && (ends || count == VL_SENSOR_CELLS || !isalpha((unsigned char)*at)))
      return vl_fail_argument(
          error,
          "pattern must be mono, RGGB, BGGR, GRBG, GBRG, quad, rgbw, or rows of as "
          "many letters with slashes between, at most %d in all (\"RG/GB\"); it is "
          "\"%s\"",
          VL_SENSOR_CELLS, vl_short_text(pattern).text);
    if (!*at)
      break;
    column = ends ? 0 : column + 1;
    if (!ends)
      cells[count++] = (char)toupper((unsigned char)*at);
  }
  memset(def->pattern, 0, sizeof def->pattern);
  memcpy(def->pattern, cells, count);
  def->pattern_width = width;
  def->pattern_height = count / width;
  return VL_OK;
}

const char *vl_sensor_pattern(const vlSensorDef *def, char text[2 * VL_SENSOR_CELLS + 1]) {
  size_t n = 0;
  for (uint32_t i = 0; i < def->pattern_width * def->pattern_height && i < VL_SENSOR_CELLS;
       i++) {
    if (i && i % def->pattern_width == 0)
      text[n++] = '/';
    text[n++] = def->pattern[i];
  }
  text[n] = 0;
  return text;
}

/* ---- efficiencies ------------------------------------------------------------------------ */

uint32_t vl_sensor_filter_index(const vlSensorDef *def, char name) {
  uint32_t i = 0;
  while (i < def->filter_count && def->filters[i].name != name)
    i++;
  return i;
}

/* The filter with that letter, which is added if there is none. Null: there are too many. */
static vlSensorFilter *filter_of(vlSensorDef *def, char name, vlError *error) {
  if (!isalpha((unsigned char)name)) {
    vl_fail_argument(error, "the name of a filter must be a letter");
    return NULL;
  }
  name = (char)toupper((unsigned char)name);
  uint32_t i = vl_sensor_filter_index(def, name);
  if (i == VL_SENSOR_FILTERS) {
    vl_fail_argument(error, "efficiency: there are more than %d filters", VL_SENSOR_FILTERS);
    return NULL;
  }
  def->filter_count = i == def->filter_count ? i + 1 : def->filter_count;
  def->filters[i].name = name;
  return &def->filters[i];
}

static vlResult check_curve(char name, uint32_t count, const double *wavelengths,
                            const double *efficiency, vlError *error) {
  for (uint32_t i = 0; i < count; i++) {
    if (!(wavelengths[i] > 0.0 && wavelengths[i] < 1e5))
      return vl_fail_argument(
          error,
          "efficiency of %c: a wavelength must be above 0 and below 100000 nm; it "
          "is %g nm",
          name, wavelengths[i]);
    if (i && !(wavelengths[i] > wavelengths[i - 1]))
      return vl_fail_argument(
          error, "efficiency of %c: wavelengths must ascend; %g nm comes after %g nm", name,
          wavelengths[i], wavelengths[i - 1]);
    if (!(efficiency[i] >= 0.0 && efficiency[i] <= 1.0))
      return vl_fail_argument(
          error,
          "efficiency of %c must be from 0 to 1 electrons per photon; it is %g at "
          "%g nm",
          name, efficiency[i], wavelengths[i]);
  }
  return count ? VL_OK : vl_fail_argument(error, "efficiency of %c has no values", name);
}

vlResult vl_sensor_set_efficiency(vlSensorDef *def, char filter, uint32_t count,
                                  const double *wavelengths, const double *efficiency,
                                  vlError *error) {
  if (!def || !wavelengths || !efficiency)
    return vl_fail_argument(error, "efficiency: an argument is missing");
  vlResult result = check_curve(filter, count, wavelengths, efficiency, error);
  vlSensorFilter *f = result == VL_OK ? filter_of(def, filter, error) : NULL;
  if (!f)
    return VL_ERROR_ARGUMENT;
  uint32_t at = 0; /* the pair at or after the wavelength */
  for (int i = 0; i < VL_SENSOR_WAVELENGTHS; i++) {
    double wavelength = VL_SENSOR_FIRST_WAVELENGTH + i;
    while (at < count && wavelengths[at] < wavelength)
      at++;
    f->efficiency[i] = 0.0f;
    if (at < count && wavelengths[at] == wavelength) {
      f->efficiency[i] = (float)efficiency[at];
    } else if (at > 0 && at < count) {
      double t = (wavelength - wavelengths[at - 1]) / (wavelengths[at] - wavelengths[at - 1]);
      double low = efficiency[at - 1];
      f->efficiency[i] = (float)(low + t * (efficiency[at] - low));
    }
  }
  return VL_OK;
}

vlResult vl_sensor_set_curves(vlSensorDef *def, const char *name, double peak, vlError *error) {
  const vlSensorCurves *curves = vl_sensor_find(name);
  if (!curves) {
    const char *names[64];
    char known[VL_GIVEN_MESSAGE];
    size_t count = 0;
    for (; count < vl_sensor_count && count < 64; count++)
      names[count] = vl_sensor_curves[count].name;
    vl_tell_names(known, sizeof known, name ? name : "", names, count);
    return vl_fail_argument(error, "curves: no measured sensor is called \"%s\"%s",
                            vl_short_text(name ? name : "").text, known);
  }
  if (!(peak > 0.0 && peak <= 1.0))
    return vl_fail_argument(
        error, "peak must be above 0 and at most 1 electrons per photon; it is %g", peak);
  double largest = 0.0;
  double wavelengths[VL_SENSOR_SAMPLES];
  double efficiency[3][VL_SENSOR_SAMPLES];
  for (int i = 0; i < VL_SENSOR_SAMPLES; i++) {
    wavelengths[i] = 380.0 + 10.0 * i;
    for (int c = 0; c < 3; c++) {
      double value = fmax((double)curves->rgb[3 * i + c], 0.0) / wavelengths[i];
      efficiency[c][i] = value;
      largest = fmax(largest, value);
    }
  }
  for (int c = 0; c < 3; c++) {
    for (int i = 0; i < VL_SENSOR_SAMPLES; i++)
      efficiency[c][i] = fmin(efficiency[c][i] * peak / largest, 1.0);
    VL_TRY(vl_sensor_set_efficiency(def, "RGB"[c], VL_SENSOR_SAMPLES, wavelengths,
                                    efficiency[c], error));
  }
  return VL_OK;
}

/* ---- checks ------------------------------------------------------------------------------ */

/* Checks the numbers of a def by their rows. ARGUMENT: `field must be ...; it is ... unit`. */
static vlResult check_rows(const vlKindRow *rows, const void *def, vlError *error) {
  char message[VL_GIVEN_MESSAGE];
  VL_EACH_PARAMETER(row, rows) {
    if (row->flags & VL_PARAMETER_RULE)
      continue;
    if (!vl_parameter_check(row, def, vl_setting_keyword(row), message))
      return vl_fail_argument(error, "%s%s%s", message, row->unit ? " " : "",
                              row->unit ? row->unit : "");
  }
  return VL_OK;
}

vlResult vl_exposure_check(const vlExposureDef *exposure, vlError *error) {
  if (exposure->cookie != VL_COOKIE_EXPOSURE)
    return vl_fail_argument(error, VL_BAD_COOKIE);
  return check_rows(&vl_exposure_settings_row, exposure, error);
}

static vlResult check_mosaic(const vlSensorDef *def, vlError *error) {
  uint64_t cells = (uint64_t)def->pattern_width * def->pattern_height;
  if (!cells || cells > VL_SENSOR_CELLS || def->filter_count > VL_SENSOR_FILTERS)
    return vl_fail_argument(error,
                            "pattern must have 1 to %d cells, and there may be %d filters",
                            VL_SENSOR_CELLS, VL_SENSOR_FILTERS);
  for (uint64_t i = 0; i < cells; i++)
    if (vl_sensor_filter_index(def, def->pattern[i]) == def->filter_count)
      return vl_fail_argument(error,
                              "pattern has the filter %c, of which there is no efficiency",
                              isalpha((unsigned char)def->pattern[i]) ? def->pattern[i] : '?');
  for (uint32_t f = 0; f < def->filter_count; f++)
    for (int i = 0; i < VL_SENSOR_WAVELENGTHS; i++) {
      double value = (double)def->filters[f].efficiency[i];
      if (!(value >= 0.0 && value <= 1.0))
        return vl_fail_argument(
            error,
            "efficiency of %c must be from 0 to 1 electrons per photon; it is %g "
            "at %d nm",
            def->filters[f].name, value, VL_SENSOR_FIRST_WAVELENGTH + i);
    }
  return VL_OK;
}

static vlResult check_light(const vlSensorDef *def, vlError *error) {
  double sum = 0.0;
  for (int i = 0; i < 9; i++) {
    sum += def->crosstalk[i];
    if (!(def->crosstalk[i] >= 0.0))
      return vl_fail_argument(error, "crosstalk must have shares from 0 on; one is %g",
                              def->crosstalk[i]);
  }
  if (!(sum > 1.0 - 1e-6 && sum < 1.0 + 1e-6))
    return vl_fail_argument(error, "crosstalk must have shares of sum 1; it is %.9g", sum);
  if (def->angle_count > VL_SENSOR_ANGLES)
    return vl_fail_argument(error, "microlens must have at most %d pairs; it has %u",
                            VL_SENSOR_ANGLES, def->angle_count);
  for (uint32_t i = 0; i < def->angle_count; i++) {
    if (!(def->angles[i] >= 0.0 && def->angles[i] <= 90.0) ||
        (i && !(def->angles[i] > def->angles[i - 1])))
      return vl_fail_argument(
          error,
          "microlens must have ascending angles from 0 to 90 degrees; one is %g "
          "degrees",
          def->angles[i]);
    if (!(def->responses[i] >= 0.0 && def->responses[i] <= 1.0))
      return vl_fail_argument(error, "microlens must have responses from 0 to 1; one is %g",
                              def->responses[i]);
  }
  return VL_OK;
}

/* ---- sensors ----------------------------------------------------------------------------- */

vlResult vl_sensor_create(vlContext *context, const vlSensorDef *def, vlSensor **sensor,
                          vlError *error) {
  vl_error_clear(error);
  if (sensor)
    *sensor = NULL;
  if (!context || !def || !sensor)
    return vl_fail_argument(error, "an argument is null");
  if (def->cookie != VL_COOKIE_SENSOR)
    return vl_fail_argument(error, VL_BAD_COOKIE);
  VL_TRY(check_rows(&vl_sensor_settings_row, def, error));
  VL_TRY(check_mosaic(def, error));
  VL_TRY(check_light(def, error));
  if (def->black_level >= ldexp(1.0, (int)def->bits) - 1.0)
    return vl_fail_argument(
        error, "black_level must be below the largest number of %u bits; it is %g DN",
        def->bits, def->black_level);
  vlSensor *made = vl_alloc(context, sizeof *made);
  if (!made)
    return vl_fail_memory(error);
  *made = (vlSensor){.context = context, .def = *def};
  for (uint32_t i = 0; i < def->pattern_width * def->pattern_height; i++)
    made->cell[i] = (uint8_t)vl_sensor_filter_index(def, def->pattern[i]);
  *sensor = made;
  return VL_OK;
}

void vl_sensor_destroy(vlSensor *sensor) {
  if (sensor)
    vl_free(sensor->context, sensor);
}

const vlSensorDef *vl_sensor_def(const vlSensor *sensor) {
  return &sensor->def;
}

double vl_exposure_seconds(const vlExposureDef *exposure) {
  return exposure->time * vl_precise_exp2(exposure->stops);
}

double vl_exposure_gain(const vlSensorDef *def, const vlExposureDef *exposure) {
  double iso = exposure->iso > 0.0 ? exposure->iso / def->base_iso : 1.0;
  return iso * exposure->gain;
}

double vl_exposure_dark(const vlSensorDef *def, const vlExposureDef *exposure) {
  double warmer = exposure->temperature - def->dark_temperature;
  return def->dark_current * vl_exposure_seconds(exposure) *
         vl_precise_exp2(warmer / def->doubling);
}
