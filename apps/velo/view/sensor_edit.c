/* view/sensor_edit.c: see sensor_edit.h. */
#include "view/sensor_edit.h"

#include <string.h>

#include "cli/macros.h"
#include "velo/setting.h"

static const char *const whites[] = {"D65", "A", "auto"};
enum { WHITES = LENGTH(whites) };
/* Those of an exposure that pages may set. */
static const char *const rows[] = {"exposure_time", "f_number", "iso",  "gain",
                                   "temperature",   "seed",     "frame"};
enum { ROWS = LENGTH(rows) };

ViewSensor sensor_default(void) {
  ViewSensor sensor = {.metered = true, .exposure = vl_default_exposure_def()};
  strcpy(sensor.preset, "generic_rggb");
  return sensor;
}

vlResult sensor_find(const ViewSensors *sensors, const char *name, vlSensorDef *def,
                     vlError *error) {
  if (!sensors->own[0] || strcmp(name, sensors->own) != 0)
    return vl_sensor_preset(name, def, error);
  *def = sensors->file;
  return VL_OK;
}

static vlResult set_preset(const MessageField *field, const ViewSensors *sensors,
                           ViewSensor *sensor, vlError *error) {
  vlSensorDef def;
  if (field->null || field->count)
    return message_refuse(error, "preset must be the name of a sensor");
  TRY_RESULT(sensor_find(sensors, field->text, &def, error));
  text_set(sensor->preset, "%s", field->text);
  return VL_OK;
}

static vlResult set_white(const MessageField *field, ViewSensor *sensor, vlError *error) {
  char why[VL_GIVEN_MESSAGE];
  if (field->null || field->count)
    return message_refuse(error, "white must be D65, A or auto");
  for (int i = 0; i < WHITES; i++)
    if (strcmp(field->text, whites[i]) == 0) {
      sensor->white = (ViewWhite)i;
      return VL_OK;
    }
  vl_unknown_name("white", "", field->text, whites, WHITES, why);
  return message_refuse(error, "%s", why);
}

/* A number of the exposure, by its row. */
static vlResult set_number(const MessageField *field, ViewSensor *sensor, vlError *error) {
  char why[VL_GIVEN_MESSAGE];
  const vlParameter *row = vl_setting(VL_SETTING_EXPOSURE, field->name);
  vlGiven given = {.kind = VL_GIVEN_OTHER};
  const bool is_time = strcmp(field->name, rows[0]) == 0;
  double number;
  if (is_time && field->null) {
    sensor->metered = true;
    return VL_OK;
  }
  if (field->null)
    given.kind = VL_GIVEN_NOTHING;
  else if (field->count == 1)
    given = (vlGiven){.kind = VL_GIVEN_NUMBER, .number = field->numbers[0]};
  else if (!field->count)
    given = (vlGiven){.kind = VL_GIVEN_TEXT, .text = field->text};
  if (!vl_given_check(row, field->name, &given, &number, why))
    return message_refuse(error, "%s", why);
  vl_given_put(row, number, &sensor->exposure);
  sensor->metered = sensor->metered && !is_time;
  return VL_OK;
}

static vlResult set_field(const MessageField *field, const ViewSensors *sensors,
                          ViewSensor *sensor, vlError *error) {
  char why[VL_GIVEN_MESSAGE];
  const char *names[ROWS + 2] = {"preset", "white"};
  if (strcmp(field->name, "preset") == 0)
    return set_preset(field, sensors, sensor, error);
  if (strcmp(field->name, "white") == 0)
    return set_white(field, sensor, error);
  for (int i = 0; i < ROWS; i++)
    if (strcmp(field->name, rows[i]) == 0)
      return set_number(field, sensor, error);
  memcpy(names + 2, rows, sizeof rows);
  vl_unknown_name("field of the sensor", "", field->name, names, ROWS + 2, why);
  return message_refuse(error, "%s", why);
}

vlResult sensor_edit(const ViewSensor *now, const ViewSensors *sensors,
                     const ViewMessage *message, ViewSensor *result, vlError *error) {
  ViewSensor next = *now;
  for (uint32_t i = 0; i < message->field_count; i++)
    TRY_RESULT(set_field(&message->fields[i], sensors, &next, error));
  *result = next;
  return VL_OK;
}

const char *sensor_white_name(uint32_t index) {
  return index < WHITES ? whites[index] : NULL;
}
