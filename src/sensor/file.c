/* sensor/file.c: reads sensor files: YAML whose numbers have units ("read_noise: 2.3 e-"). The
 * fields are those of the rows (schema/sensors.c), and a few that are lists or names. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/text.h"
#include "camera_files/files.h"
#include "schema/schema.h"
#include "sensor/sensor.h"

enum { MAX_PAIRS = 1024 };

/* Units that stand for others: factor and offset give the value in the row's unit. */
static const struct {
  const char *unit, *row;
  double factor, offset;
} units[] = {
    {"nm", "um", 1e-3, 0},       {"mm", "um", 1e3, 0},      {"µm", "um", 1, 0},
    {"μm", "um", 1, 0},          {"e-/ms", "e-/s", 1e3, 0}, {"e-/min", "e-/s", 1.0 / 60.0, 0},
    {"ke-", "e-", 1e3, 0},       {"e", "e-", 1, 0},         {"e/s", "e-/s", 1, 0},
    {"e/DN", "e-/DN", 1, 0},     {"C", "degC", 1, 0},       {"°C", "degC", 1, 0},
    {"K", "degC", 1, -273.15},   {"bit", "bits", 1, 0},     {"deg", "degrees", 1, 0},
    {"degree", "degrees", 1, 0}, {"°", "degrees", 1, 0},    {"ADU", "DN", 1, 0},
    {"LSB", "DN", 1, 0},         {"e-/ADU", "e-/DN", 1, 0}, {"ms", "s", 1e-3, 0},
    {"us", "s", 1e-6, 0}};

/* Reads "2.3 e-" for a row: true, *value in the row's unit. A share may be in percent. */
static bool with_unit(const char *text, const vlParameter *row, double *value) {
  char *unit;
  double number = strtod(text, &unit);
  if (unit == text || !isfinite(number))
    return false;
  unit += strspn(unit, " ");
  *value = number;
  if (!row->unit) {
    *value = vl_text_is(unit, "%") ? number / 100.0 : number;
    return !*unit || (vl_text_is(unit, "%") && row->type == VL_PARAMETER_DOUBLE);
  }
  if (vl_text_is(unit, row->unit))
    return true;
  for (size_t i = 0; i < VL_LENGTH(units); i++)
    if (vl_text_is(units[i].row, row->unit) && vl_text_is(unit, units[i].unit)) {
      *value = number * units[i].factor + units[i].offset;
      return true;
    }
  return false;
}

/* A field of one number. Numbers without a unit are refused where the row has one. */
static vlResult read_number(const vlCameraFile *file, const json_t *object, const char *key,
                            const vlParameter *row, double *value) {
  const json_t *item = json_object_get(object, key);
  const char *text = json_string_value(item);
  const char *unit = row->unit ? row->unit : "";
  if (text ? !with_unit(text, row, value) : !json_is_number(item))
    return vl_camera_wrong_in(file, object, key, "%s must be a number%s%s; it is %s%.60s%s",
                              key, row->unit ? " with the unit " : "", unit, text ? "\"" : "",
                              text ? vl_short_text(text).text : "no number", text ? "\"" : "");
  if (!text && row->unit)
    return vl_camera_wrong_in(file, object, key, "%s needs its unit: %s: %.9g %s", key, key,
                              json_number_value(item), unit);
  if (!text)
    *value = json_number_value(item);
  char message[VL_GIVEN_MESSAGE];
  vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = *value};
  if (!vl_given_check(row, key, &given, value, message))
    return vl_camera_wrong_in(file, object, key, "%.300s%s%s", message, row->unit ? " " : "",
                              unit);
  return VL_OK;
}

/* ---- fields of their own ---------------------------------------------------------------- */

/* Reports at a field what a function of the sensor says. */
static vlResult reported(const vlCameraFile *file, const json_t *object, const char *key,
                         vlResult result, const vlError *why) {
  return result == VL_OK ? VL_OK
                         : vl_camera_wrong_in(file, object, key, "%.380s", why->message);
}

static vlResult read_efficiency(const vlCameraFile *file, const json_t *tree,
                                vlSensorDef *def) {
  const json_t *map = json_object_get(tree, "efficiency");
  const char *name;
  json_t *item;
  if (!json_is_object(map))
    return vl_camera_wrong_in(file, tree, "efficiency",
                              "efficiency must be a map from filters to lists of pairs: "
                              "{G: [[500, 0.4], [550, 0.6]]}");
  double *values = vl_alloc_array(file->context, 4 * MAX_PAIRS, sizeof *values);
  if (!values)
    return vl_fail_memory(file->error);
  vlResult result = VL_OK;
  json_object_foreach((json_t *)map, name, item) {
    double *wavelengths = values + 2 * (size_t)MAX_PAIRS;
    double *efficiency = wavelengths + MAX_PAIRS;
    uint32_t count = 0;
    vlError why = {0};
    if (strlen(name) != 1) {
      result = vl_camera_wrong_in(file, map, name,
                                  "efficiency: the name of a filter must be one letter; it is "
                                  "\"%s\"",
                                  vl_short_text(name).text);
    } else if (json_is_number(item)) { /* the same at all wavelengths */
      wavelengths[0] = 1.0;
      wavelengths[1] = 99999.0;
      efficiency[0] = efficiency[1] = json_number_value(item);
      count = 4;
    } else {
      result = vl_camera_numbers(file, map, name, values, 2, 2 * MAX_PAIRS, &count);
      for (uint32_t i = 0; i < count / 2; i++) {
        wavelengths[i] = values[2 * i];
        efficiency[i] = values[2 * i + 1];
      }
      if (result == VL_OK && count % 2)
        result = vl_camera_wrong_in(file, map, name,
                                    "efficiency of %s must be a list of pairs: wavelength in "
                                    "nm, electrons per photon",
                                    name);
    }
    if (result == VL_OK)
      result = reported(
          file, map, name,
          vl_sensor_set_efficiency(def, name[0], count / 2, wavelengths, efficiency, &why),
          &why);
    if (result != VL_OK)
      break;
  }
  vl_free(file->context, values);
  return result;
}

static vlResult read_microlens(const vlCameraFile *file, const json_t *tree, vlSensorDef *def) {
  double values[2 * VL_SENSOR_ANGLES];
  uint32_t count = 0;
  VL_TRY(vl_camera_numbers(file, tree, "microlens", values, 2, 2 * VL_SENSOR_ANGLES, &count));
  if (count % 2)
    return vl_camera_wrong_in(file, tree, "microlens",
                              "microlens must be a list of pairs: angle in degrees, response");
  def->angle_count = count / 2;
  for (uint32_t i = 0; i < def->angle_count; i++) {
    def->angles[i] = values[2 * i];
    def->responses[i] = values[2 * i + 1];
  }
  return VL_OK;
}

/* A field of text; null with *result if it is none. */
static const char *read_text(const vlCameraFile *file, const json_t *tree, const char *key,
                             vlResult *result) {
  const char *text = json_string_value(json_object_get(tree, key));
  if (!text)
    *result = vl_camera_wrong_in(file, tree, key, "%s must be text", key);
  return text;
}

static vlResult read_curves(const vlCameraFile *file, const json_t *tree, vlSensorDef *def) {
  static const vlParameter share = {
      .type = VL_PARAMETER_DOUBLE, .member = "peak", .low = 0, .high = 1};
  double peak = 0.55;
  vlResult result = VL_OK;
  vlError why = {0};
  if (json_object_get(tree, "peak"))
    result = read_number(file, tree, "peak", &share, &peak);
  const char *name = result == VL_OK ? read_text(file, tree, "curves", &result) : NULL;
  return name
             ? reported(file, tree, "curves", vl_sensor_set_curves(def, name, peak, &why), &why)
             : result;
}

/* One field with a reader of its own. */
static vlResult read_own(const vlCameraFile *file, const json_t *tree, const char *key,
                         vlSensorDef *def) {
  vlResult result = VL_OK;
  vlError why = {0};
  if (vl_text_is(key, "efficiency"))
    return read_efficiency(file, tree, def);
  if (vl_text_is(key, "curves"))
    return read_curves(file, tree, def);
  if (vl_text_is(key, "microlens"))
    return read_microlens(file, tree, def);
  if (vl_text_is(key, "crosstalk"))
    return vl_camera_numbers(file, tree, key, def->crosstalk, 9, 9, NULL);
  if (vl_text_is(key, "peak"))
    return json_object_get(tree, "curves")
               ? VL_OK
               : vl_camera_wrong_in(file, tree, key, "peak goes with curves");
  const char *text = read_text(file, tree, key, &result);
  if (text && vl_text_is(key, "pattern"))
    return reported(file, tree, key, vl_sensor_set_pattern(def, text, &why), &why);
  return result;
}

/* ---- the file --------------------------------------------------------------------------- */

static vlResult unknown_field(const vlCameraFile *file, const json_t *tree, const char *key) {
  const vlKindRow *rows = &vl_sensor_settings_row;
  const char *names[64];
  char message[VL_GIVEN_MESSAGE];
  size_t count = 0;
  for (uint32_t i = 0; i < rows->parameter_count && count < 64; i++)
    names[count++] = vl_setting_keyword(&rows->parameters[i]);
  vl_unknown_name("field", "", key, names, count, message);
  return vl_camera_wrong_in(file, tree, key, "%.380s", message);
}

/* The row of a field; null: there is none. */
static const vlParameter *row_of(const char *key) {
  const vlKindRow *rows = &vl_sensor_settings_row;
  for (uint32_t i = 0; i < rows->parameter_count; i++)
    if (vl_text_is(key, vl_setting_keyword(&rows->parameters[i])))
      return &rows->parameters[i];
  return NULL;
}

static vlResult read_tree(const vlCameraFile *file, const json_t *tree, vlSensorDef *def) {
  const char *key;
  json_t *item;
  vlResult result = VL_OK;
  vlError why = {0};
  if (!json_is_object(tree))
    return vl_camera_wrong_in(file, tree, NULL,
                              "not a sensor file: it must have fields, such as "
                              "\"full_well: 10000 e-\"");
  if (json_object_get(tree, "preset")) { /* first, wherever it stands */
    const char *name = read_text(file, tree, "preset", &result);
    if (name)
      result = reported(file, tree, "preset", vl_sensor_preset(name, def, &why), &why);
  }
  if (result == VL_OK && json_object_get(tree, "efficiency") &&
      !json_object_get(tree, "preset"))
    def->filter_count = 0; /* the default's filter is not the file's */
  json_object_foreach((json_t *)tree, key, item) {
    const vlParameter *row = row_of(key);
    double value;
    if (result != VL_OK)
      break;
    if (!row) {
      result = unknown_field(file, tree, key);
    } else if (row->flags & VL_PARAMETER_RULE) {
      result = read_own(file, tree, key, def);
    } else {
      result = read_number(file, tree, key, row, &value);
      if (result == VL_OK)
        vl_given_put(row, value, def);
    }
  }
  return result;
}

/* What is wrong with the sensor as a whole, at the field that the message begins with. */
static vlResult check_whole(const vlCameraFile *file, const json_t *tree,
                            const vlSensorDef *def) {
  vlSensor *sensor = NULL;
  vlError why = {0};
  vlResult result = vl_sensor_create(file->context, def, &sensor, &why);
  vl_sensor_destroy(sensor);
  if (result != VL_ERROR_ARGUMENT)
    return result == VL_OK ? VL_OK : vl_fail_memory(file->error);
  char key[64] = "";
  size_t length = strcspn(why.message, " ");
  memcpy(key, why.message, length < sizeof key ? length : 0);
  return vl_camera_wrong_in(file, tree, key, "%.380s", why.message);
}

vlResult vl_sensor_read(vlContext *context, const char *path, vlSensorDef *def,
                        vlError *error) {
  vl_error_clear(error);
  if (!context || !path || !def)
    return vl_fail_argument(error, "an argument is null");
  char *text = NULL;
  size_t size = 0;
  VL_TRY(vl_file_read_given(context, path, true, &text, &size, error));
  vlCameraFileDef unused = vl_default_camera_file_def();
  vlCameraLocations locations = {0};
  vlCameraFile file = {.context = context,
                       .path = path,
                       .dialect = "sensor",
                       .def = &unused,
                       .error = error,
                       .locations = &locations};
  vlSensorDef read = vl_default_sensor_def();
  json_t *tree = NULL;
  void *locale = vl_machine_set_numerals();
  vlResult result = vl_camera_yaml(&file, text, size, &tree);
  locations.root = tree;
  if (result == VL_OK)
    result = read_tree(&file, tree, &read);
  if (result == VL_OK)
    result = check_whole(&file, tree, &read);
  if (result == VL_OK)
    *def = read;
  vl_machine_restore_numerals(locale);
  json_decref(tree);
  vl_camera_locations_free(&file);
  vl_free(context, text);
  return result;
}
