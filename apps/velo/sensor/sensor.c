/* sensor/sensor.c: see sensor.h. */
#include "sensor/sensor.h"

#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "velo/setting.h"

bool sensor_is_file(const char *name) {
  const char *dot = strrchr(name, '.');
  return strchr(name, '/') || (dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0));
}

int sensor_open(vlContext *context, const char *option, const char *name, vlSensor **sensor) {
  vlSensorDef def = vl_default_sensor_def();
  vlError error = {0};
  bool file = sensor_is_file(name);
  vlResult result =
      file ? vl_sensor_read(context, name, &def, &error) : vl_sensor_preset(name, &def, &error);
  if (result == VL_ERROR_ARGUMENT)
    return report_usage("%s: %s (a sensor file has the suffix .yaml)", option, error.message);
  if (result == VL_OK)
    result = vl_sensor_create(context, &def, sensor, &error);
  return report_error(&error, result, file ? name : NULL);
}

int exposure_options(const Arguments *arguments, vlExposureDef *exposure) {
  for (const Option *o = arguments->command->options; o->name; o++) {
    const OptionValue *value = &arguments->values[o->id];
    const vlParameter *row = value->given ? vl_setting(VL_SETTING_EXPOSURE, o->name) : NULL;
    char name[64];
    double number;
    if (!row)
      continue;
    text_set(name, "--%s", o->name);
    TRY(option_number(name, value->text, row, &number));
    vl_given_put(row, number, exposure);
  }
  return -1;
}
