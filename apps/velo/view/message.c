/* view/message.c: see message.h. */
#include "view/message.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

static const char *const kinds[] = {"seen",    "camera", "undo",    "redo",    "reset",   "settings",
                                    "pick",    "focus",  "save",    "command", "overlay", "outline",
                                    "outside", "paths",  "cameras", "steer",   "scene"};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The following functions return false for a value of a wrong type or out of range. A missing value is right. */

static bool read_count(const json_t *object, const char *key, double most, uint32_t *value, bool *given) {
  const json_t *item = json_object_get(object, key);
  if (!item) return true;
  if (!json_is_integer(item)) return false;
  json_int_t number = json_integer_value(item);
  if (number < 0 || (double)number > most) return false;
  *value = (uint32_t)number;
  if (given) *given = true;
  return true;
}

static bool read_double(const json_t *object, const char *key, double limit, double *value) {
  const json_t *item = json_object_get(object, key);
  if (!item) return true;
  if (!json_is_number(item)) return false;
  *value = json_number_value(item);
  return isfinite(*value) && fabs(*value) <= limit;
}

static bool read_bool(const json_t *object, const char *key, bool *value, bool *given) {
  const json_t *item = json_object_get(object, key);
  if (!item) return true;
  if (!json_is_boolean(item)) return false;
  *value = json_is_true(item);
  if (given) *given = true;
  return true;
}

static bool copy_text(const json_t *item, char *text, size_t size) {
  if (!json_is_string(item) || json_string_length(item) >= size) return false;
  const char *from = json_string_value(item);
  if (strlen(from) != json_string_length(item)) return false;
  for (const char *s = from; *s; s++)
    if ((unsigned char)*s < 0x20 || *s == 0x7f) return false;
  memcpy(text, from, strlen(from) + 1);
  return true;
}

static bool read_text(const json_t *object, const char *key, char text[MESSAGE_NAME], bool *given) {
  const json_t *item = json_object_get(object, key);
  if (!item) return true;
  if (given) *given = true;
  return copy_text(item, text, MESSAGE_NAME);
}

/* An array of `count` whole numbers; null: all 0. */
static bool read_counts(const json_t *object, const char *key, uint32_t count, uint32_t *values, bool *given) {
  const json_t *item = json_object_get(object, key);
  if (!item) return true;
  *given = true;
  if (json_is_null(item)) return true;
  if (!json_is_array(item) || json_array_size(item) != count) return false;
  for (uint32_t i = 0; i < count; i++) {
    const json_t *number = json_array_get(item, i);
    if (!json_is_integer(number) || json_integer_value(number) < 0 || json_integer_value(number) > 65536) return false;
    values[i] = (uint32_t)json_integer_value(number);
  }
  return true;
}

static bool read_field(const char *name, const json_t *value, MessageField *field) {
  if (strlen(name) >= sizeof field->name) return false;
  memcpy(field->name, name, strlen(name) + 1);
  field->null = json_is_null(value);
  if (field->null) return true;
  if (json_is_string(value)) return copy_text(value, field->text, sizeof field->text);
  if (json_is_number(value)) {
    field->count = 1;
    field->numbers[0] = json_number_value(value);
    return isfinite(field->numbers[0]);
  }
  if (!json_is_array(value) || json_array_size(value) > MESSAGE_NUMBERS) return false;
  field->count = (uint32_t)json_array_size(value);
  for (uint32_t i = 0; i < field->count; i++) {
    const json_t *number = json_array_get(value, i);
    if (!json_is_number(number)) return false;
    field->numbers[i] = json_number_value(number);
    if (!isfinite(field->numbers[i])) return false;
  }
  field->null = field->count == 0;
  return true;
}

static bool read_fields(const json_t *object, ViewMessage *message) {
  json_t *set = json_object_get(object, "set");
  if (!set) return true;
  if (!json_is_object(set) || json_object_size(set) > MESSAGE_FIELDS) return false;
  const char *name;
  json_t *value;
  json_object_foreach(set, name,
                      value) if (!read_field(name, value, &message->fields[message->field_count++])) return false;
  return true;
}

static bool read_members(const json_t *object, ViewMessage *m, const char **why) {
  bool numbers = read_count(object, "serial", 4294967295.0, &m->serial, NULL) &&
                 read_count(object, "change", 4294967295.0, &m->change, NULL) &&
                 read_count(object, "gesture", 4294967295.0, &m->gesture, NULL) &&
                 read_count(object, "id", 4294967295.0, &m->id, NULL) && read_double(object, "x", 65536, &m->x) &&
                 read_double(object, "y", 65536, &m->y) && read_double(object, "exposure", 64, &m->exposure) &&
                 read_count(object, "samples", 65536, &m->samples, NULL) &&
                 read_count(object, "show", 64, &m->show, NULL) &&
                 read_count(object, "spp", 1 << 24, &m->spp, &m->has_spp) && (!m->has_spp || m->spp > 0);
  if (!numbers) {
    *why = "a number is of a wrong type or out of range";
    return false;
  }
  bool rest = read_bool(object, "paused", &m->paused, &m->has_paused) && read_bool(object, "boxes", &m->boxes, NULL) &&
              read_bool(object, "curves", &m->curves, NULL) && read_bool(object, "field", &m->field, NULL) &&
              read_bool(object, "mark", &m->mark, NULL) && read_bool(object, "by_sample", &m->by_sample, NULL) &&
              read_counts(object, "crop", 4, m->crop, &m->has_crop) &&
              read_counts(object, "size", 2, m->size, &m->has_size);
  if (!rest) {
    *why = "a setting is of a wrong type or out of range";
    return false;
  }
  bool texts = read_text(object, "channel", m->channel, &m->has_channel) && read_text(object, "what", m->what, NULL) &&
               read_text(object, "name", m->name, NULL) && read_text(object, "dialect", m->dialect, NULL) &&
               read_text(object, "view", m->view, NULL);
  if (!texts) {
    *why = "a text is of a wrong type or too long";
    return false;
  }
  if (!read_fields(object, m)) {
    *why = "a field of the camera is of a wrong type";
    return false;
  }
  return true;
}

bool message_parse(const char *text, size_t size, ViewMessage *message, const char **why) {
  memset(message, 0, sizeof *message);
  *why = "not a JSON object";
  if (size > MESSAGE_LARGEST) {
    *why = "too long";
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
  while (kind < KINDS && !(type && strcmp(type, kinds[kind]) == 0)) kind++;
  *why = "unknown type";
  bool good = kind < KINDS;
  message->kind = good ? (MessageKind)kind : MESSAGE_SEEN;
  good = good && read_members(object, message, why);
  json_decref(object);
  return good;
}
