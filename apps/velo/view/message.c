/* view/message.c: see message.h. */
#include "view/message.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const kinds[] = {"seen",     "camera",  "undo",    "redo",    "reset",
                                    "settings", "pick",    "focus",   "save",    "command",
                                    "verify",   "overlay", "outline", "outside", "paths",
                                    "cameras",  "steer",   "scene",   "sensor",  "time"};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The following functions return false for a value of a wrong type or out of range, and say
 * why. A missing value is right. */

typedef struct Reader {
  const json_t *object;
  char *why; /* VL_GIVEN_MESSAGE bytes */
} Reader;

static const vlParameter serial_row = {.type = VL_PARAMETER_COUNT};
static const vlParameter shutter_row = {.type = VL_PARAMETER_DOUBLE, .low = 0, .high = 1e6};

static bool refuse(const Reader *r, const char *format, const char *key) {
  snprintf(r->why, VL_GIVEN_MESSAGE, format, key);
  return false;
}

static vlGiven given_of(const json_t *item) {
  vlGiven given = {.kind = VL_GIVEN_OTHER};
  if (json_is_null(item))
    given.kind = VL_GIVEN_NOTHING;
  if (json_is_boolean(item))
    given = (vlGiven){.kind = VL_GIVEN_FLAG, .number = json_is_true(item)};
  if (json_is_number(item))
    given = (vlGiven){.kind = VL_GIVEN_NUMBER, .number = json_number_value(item)};
  if (json_is_string(item))
    given = (vlGiven){.kind = VL_GIVEN_TEXT, .text = json_string_value(item)};
  return given;
}

static bool read_number(const Reader *r, const char *key, const vlParameter *row, double *value,
                        bool *given) {
  const json_t *item = json_object_get(r->object, key);
  if (!item)
    return true;
  const vlGiven found = given_of(item);
  if (!vl_given_check(row, key, &found, value, r->why))
    return false;
  if (given)
    *given = true;
  return true;
}

static bool read_setting(const Reader *r, const char *key, double *value) {
  return read_number(r, key, vl_setting(VL_SETTING_PROGRAM, key), value, NULL);
}

static bool read_count(const Reader *r, const char *key, const vlParameter *row,
                       uint32_t *value, bool *given) {
  double number = *value;
  if (!read_number(r, key, row, &number, given))
    return false;
  *value = (uint32_t)number;
  return true;
}

static bool read_bool(const Reader *r, const char *key, bool *value, bool *given) {
  static const vlParameter row = {.type = VL_PARAMETER_BOOL};
  double number = *value;
  if (!read_number(r, key, &row, &number, given))
    return false;
  *value = number != 0;
  return true;
}

static bool copy_text(const json_t *item, char *text, size_t size) {
  if (!json_is_string(item) || json_string_length(item) >= size)
    return false;
  const char *from = json_string_value(item);
  if (strlen(from) != json_string_length(item))
    return false;
  for (const char *s = from; *s; s++)
    if ((unsigned char)*s < 0x20 || *s == 0x7f)
      return false;
  memcpy(text, from, strlen(from) + 1);
  return true;
}

static bool read_text(const Reader *r, const char *key, char text[MESSAGE_NAME], bool *given) {
  const json_t *item = json_object_get(r->object, key);
  if (!item)
    return true;
  if (given)
    *given = true;
  return copy_text(item, text, MESSAGE_NAME) ||
         refuse(r, "%s must be text of at most 199 bytes", key);
}

/* An array of `count` numbers of sides or edges; null: all 0. */
static bool read_counts(const Reader *r, const char *key, uint32_t count, uint32_t *values,
                        bool *given) {
  const json_t *item = json_object_get(r->object, key);
  const vlParameter edge = {.type = VL_PARAMETER_COUNT,
                            .high = vl_setting(VL_SETTING_PROGRAM, "width")->high};
  if (!item)
    return true;
  *given = true;
  if (json_is_null(item))
    return true;
  if (!json_is_array(item) || json_array_size(item) != count)
    return refuse(
        r, count == 2 ? "%s must be a list of 2 numbers" : "%s must be a list of 4 numbers",
        key);
  for (uint32_t i = 0; i < count; i++) {
    double number;
    const vlGiven found = given_of(json_array_get(item, i));
    if (!vl_given_check(&edge, key, &found, &number, r->why))
      return false;
    values[i] = (uint32_t)number;
  }
  return true;
}

static bool read_field(const char *name, const json_t *value, MessageField *field) {
  if (strlen(name) >= sizeof field->name)
    return false;
  memcpy(field->name, name, strlen(name) + 1);
  field->null = json_is_null(value);
  if (field->null)
    return true;
  if (json_is_string(value))
    return copy_text(value, field->text, sizeof field->text);
  if (json_is_number(value)) {
    field->count = 1;
    field->numbers[0] = json_number_value(value);
    return isfinite(field->numbers[0]);
  }
  if (!json_is_array(value) || json_array_size(value) > MESSAGE_NUMBERS)
    return false;
  field->count = (uint32_t)json_array_size(value);
  for (uint32_t i = 0; i < field->count; i++) {
    const json_t *number = json_array_get(value, i);
    if (!json_is_number(number))
      return false;
    field->numbers[i] = json_number_value(number);
    if (!isfinite(field->numbers[i]))
      return false;
  }
  field->null = field->count == 0;
  return true;
}

static bool read_fields(const Reader *r, ViewMessage *message) {
  json_t *set = json_object_get(r->object, "set");
  if (!set)
    return true;
  if (!json_is_object(set) || json_object_size(set) > MESSAGE_FIELDS)
    return refuse(r, "%s must be names and values", "set");
  const char *name;
  json_t *value;
  json_object_foreach(set, name, value) {
    MessageField *field = &message->fields[message->field_count++];
    if (!read_field(name, value, field))
      return refuse(r, "set: %.40s is of a wrong type", name);
  }
  return true;
}

static bool read_members(const Reader *r, ViewMessage *m) {
  const vlParameter *samples = vl_setting(VL_SETTING_PROGRAM, "samples");
  const vlParameter *show = vl_setting(VL_SETTING_PROGRAM, "show");
  const vlParameter *time = vl_setting(VL_SETTING_LOAD, "time");
  return read_count(r, "serial", &serial_row, &m->serial, NULL) &&
         read_count(r, "change", &serial_row, &m->change, NULL) &&
         read_count(r, "gesture", &serial_row, &m->gesture, NULL) &&
         read_count(r, "id", &serial_row, &m->id, NULL) && read_setting(r, "x", &m->x) &&
         read_setting(r, "y", &m->y) && read_setting(r, "exposure", &m->exposure) &&
         read_number(r, "at", time, &m->at, NULL) &&
         read_number(r, "shutter", &shutter_row, &m->shutter, NULL) &&
         read_count(r, "samples", samples, &m->samples, NULL) &&
         read_count(r, "show", show, &m->show, NULL) &&
         read_count(r, "spp", vl_setting(VL_SETTING_RENDER, "spp"), &m->spp, &m->has_spp) &&
         read_bool(r, "paused", &m->paused, &m->has_paused) &&
         read_bool(r, "denoise", &m->denoise, &m->has_denoise) &&
         read_bool(r, "boxes", &m->boxes, NULL) && read_bool(r, "curves", &m->curves, NULL) &&
         read_bool(r, "field", &m->field, NULL) && read_bool(r, "mark", &m->mark, NULL) &&
         read_bool(r, "by_sample", &m->by_sample, NULL) && read_bool(r, "end", &m->end, NULL) &&
         read_counts(r, "crop", 4, m->crop, &m->has_crop) &&
         read_counts(r, "size", 2, m->size, &m->has_size) &&
         read_text(r, "channel", m->channel, &m->has_channel) &&
         read_text(r, "what", m->what, NULL) && read_text(r, "name", m->name, NULL) &&
         read_text(r, "dialect", m->dialect, NULL) && read_text(r, "view", m->view, NULL) &&
         read_fields(r, m);
}

bool message_parse(const char *text, size_t size, ViewMessage *message,
                   char why[VL_GIVEN_MESSAGE]) {
  memset(message, 0, sizeof *message);
  strcpy(why, "not a JSON object");
  if (size > MESSAGE_MAX_SIZE) {
    strcpy(why, "too long");
    return false;
  }
  json_error_t error;
  json_t *object = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
  if (!json_is_object(object)) {
    json_decref(object);
    return false;
  }
  const char *type = json_string_value(json_object_get(object, "type"));
  int kind = 0;
  while (kind < KINDS && !(type && strcmp(type, kinds[kind]) == 0))
    kind++;
  if (kind == KINDS)
    vl_unknown_name("type of message", "", type ? type : "", kinds, KINDS, why);
  const Reader reader = {object, why};
  message->kind = kind < KINDS ? (MessageKind)kind : MESSAGE_SEEN;
  bool good = kind < KINDS && read_members(&reader, message);
  json_decref(object);
  return good;
}
