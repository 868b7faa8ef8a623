/* view/message.c: see message.h. */
#include "view/message.h"

#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "cli/macros.h"

/* The following functions return false for a value of a wrong type or out of range, and say
 * why. */

typedef struct Reader {
  const json_t *object;
  char *why; /* VL_GIVEN_MESSAGE bytes */
} Reader;

typedef enum MemberKind {
  KIND_COUNT,  /* uint32_t */
  KIND_NUMBER, /* double */
  KIND_FLAG,   /* bool */
  KIND_PAIR,   /* uint32_t[2]: numbers of pixels; null: all 0 */
  KIND_BOX,    /* uint32_t[4] */
  KIND_TEXT,   /* char[MESSAGE_NAME] */
  KIND_FIELDS  /* MessageField[] */
} MemberKind;

static const vlParameter serial_row = {.type = VL_PARAMETER_COUNT};
static const vlParameter flag_row = {.type = VL_PARAMETER_BOOL};
static const vlParameter shutter_row = {.type = VL_PARAMETER_DOUBLE, .low = 0, .high = 1e6};

#define TO(MEMBER) offsetof(ViewMessage, MEMBER)

/* What a member is, and where it is put. A number has the limits of its row; without one, of
 * the setting of a group. */
typedef struct Member {
  MessageMember member;
  const char *name;
  MemberKind kind;
  size_t to;
  const vlParameter *row;
  vlSettingGroup group;
  const char *setting; /* null: its name is the member's */
} Member;

static const Member members[] = {
    {MEMBER_SERIAL, "serial", KIND_COUNT, TO(serial), .row = &serial_row},
    {MEMBER_CHANGE, "change", KIND_COUNT, TO(change), .row = &serial_row},
    {MEMBER_GESTURE, "gesture", KIND_COUNT, TO(gesture), .row = &serial_row},
    {MEMBER_ID, "id", KIND_COUNT, TO(id), .row = &serial_row},
    {MEMBER_X, "x", KIND_NUMBER, TO(x), .group = VL_SETTING_PROGRAM},
    {MEMBER_Y, "y", KIND_NUMBER, TO(y), .group = VL_SETTING_PROGRAM},
    {MEMBER_EXPOSURE, "exposure", KIND_NUMBER, TO(exposure), .group = VL_SETTING_PROGRAM},
    {MEMBER_AT, "at", KIND_NUMBER, TO(at), .group = VL_SETTING_LOAD, .setting = "time"},
    {MEMBER_SHUTTER, "shutter", KIND_NUMBER, TO(shutter), .row = &shutter_row},
    {MEMBER_SAMPLES, "samples", KIND_COUNT, TO(samples), .group = VL_SETTING_PROGRAM},
    {MEMBER_SHOW, "show", KIND_COUNT, TO(show), .group = VL_SETTING_PROGRAM},
    {MEMBER_SPP, "spp", KIND_COUNT, TO(spp), .group = VL_SETTING_RENDER},
    {MEMBER_PAUSED, "paused", KIND_FLAG, TO(paused), .row = &flag_row},
    {MEMBER_DENOISE, "denoise", KIND_FLAG, TO(denoise), .row = &flag_row},
    {MEMBER_BOXES, "boxes", KIND_FLAG, TO(boxes), .row = &flag_row},
    {MEMBER_CURVES, "curves", KIND_FLAG, TO(curves), .row = &flag_row},
    {MEMBER_FIELD, "field", KIND_FLAG, TO(field), .row = &flag_row},
    {MEMBER_MARK, "mark", KIND_FLAG, TO(mark), .row = &flag_row},
    {MEMBER_BY_SAMPLE, "by_sample", KIND_FLAG, TO(by_sample), .row = &flag_row},
    {MEMBER_END, "end", KIND_FLAG, TO(end), .row = &flag_row},
    {MEMBER_CROP, "crop", KIND_BOX, TO(crop), .row = NULL},
    {MEMBER_SIZE, "size", KIND_PAIR, TO(size), .row = NULL},
    {MEMBER_CHANNEL, "channel", KIND_TEXT, TO(channel), .row = NULL},
    {MEMBER_WHAT, "what", KIND_TEXT, TO(what), .row = NULL},
    {MEMBER_NAME, "name", KIND_TEXT, TO(name), .row = NULL},
    {MEMBER_DIALECT, "dialect", KIND_TEXT, TO(dialect), .row = NULL},
    {MEMBER_VIEW, "view", KIND_TEXT, TO(view), .row = NULL},
    {MEMBER_SET, "set", KIND_FIELDS, TO(fields), .row = NULL}};

static bool refuse(const Reader *r, const char *format, const char *key) {
  snprintf(r->why, VL_GIVEN_MESSAGE, format, key);
  return false;
}

vlResult message_refuse(vlError *error, const char *format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(error->message, sizeof error->message, format, values);
  va_end(values);
  return error->code = VL_ERROR_ARGUMENT;
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

static bool read_number(const Reader *r, const Member *member, const json_t *item, void *to) {
  const vlGiven given = given_of(item);
  const char *setting = member->setting ? member->setting : member->name;
  const vlParameter *row = member->row ? member->row : vl_setting(member->group, setting);
  double number;
  if (!vl_given_check(row, member->name, &given, &number, r->why))
    return false;
  if (member->kind == KIND_NUMBER)
    *(double *)to = number;
  else if (member->kind == KIND_FLAG)
    *(bool *)to = number != 0;
  else
    *(uint32_t *)to = (uint32_t)number;
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

/* An array of `count` numbers of sides or edges; null: all 0. */
static bool read_counts(const Reader *r, const char *key, uint32_t count, const json_t *item,
                        uint32_t *values) {
  const vlParameter edge = {.type = VL_PARAMETER_COUNT,
                            .high = vl_setting(VL_SETTING_PROGRAM, "width")->high};
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

static bool read_fields(const Reader *r, json_t *set, ViewMessage *message) {
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

static bool read_member(const Reader *r, const Member *member, ViewMessage *message) {
  json_t *item = json_object_get(r->object, member->name);
  void *to = (char *)message + member->to;
  if (!item)
    return true;
  message->given |= member->member;
  switch (member->kind) {
    case KIND_COUNT:
    case KIND_NUMBER:
    case KIND_FLAG:
      return read_number(r, member, item, to);
    case KIND_PAIR:
      return read_counts(r, member->name, 2, item, to);
    case KIND_BOX:
      return read_counts(r, member->name, 4, item, to);
    case KIND_TEXT:
      return copy_text(item, to, MESSAGE_NAME) ||
             refuse(r, "%s must be text of at most 199 bytes", member->name);
    case KIND_FIELDS:
      return read_fields(r, item, message);
  }
  return false;
}

static bool read_members(const Reader *r, ViewMessage *message) {
  const uint32_t wanted = message->type->members | MEMBER_CHANGE | MEMBER_ID;
  for (size_t i = 0; i < LENGTH(members); i++)
    if ((wanted & (uint32_t)members[i].member) && !read_member(r, &members[i], message))
      return false;
  return true;
}

/* The type of a message; null after saying which there are. */
static const MessageType *find_type(const MessageType *types, const Reader *r) {
  const char *name = json_string_value(json_object_get(r->object, "type"));
  const char *names[MESSAGE_TYPES];
  int count = 0;
  for (const MessageType *type = types; type->name; type++) {
    if (name && strcmp(name, type->name) == 0)
      return type;
    names[count++] = type->name;
  }
  vl_unknown_name("type of message", "", name ? name : "", names, count, r->why);
  return NULL;
}

bool message_parse(const MessageType *types, const char *text, size_t size,
                   ViewMessage *message, char why[VL_GIVEN_MESSAGE]) {
  memset(message, 0, sizeof *message);
  strcpy(why, "not a JSON object");
  if (size > MESSAGE_MAX_SIZE) {
    strcpy(why, "too long");
    return false;
  }
  json_error_t error;
  json_t *object = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
  const Reader reader = {object, why};
  message->type = json_is_object(object) ? find_type(types, &reader) : NULL;
  bool good = message->type && read_members(&reader, message);
  json_decref(object);
  return good;
}
