/* schema/check.c: checks a value by the row of its parameter or setting: one that somebody
 * gave, or a member of a def. All messages about values of rows are written here: the name,
 * what it must be, the value, the nearest name. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "base/unset.h"
#include "schema/schema.h"
#include "velo/setting.h"

/* ---- what a value must be ---------------------------------------------------------------- */

/* Writes a whole number without an exponent, others with up to 6 digits: angles in degrees are
 * rounded. */
static const char *put_number(char text[40], double number) {
  bool whole = fabs(number) < 1e15 && number == floor(number);
  snprintf(text, 40, whole ? "%.0f" : "%.6g", number);
  return text;
}

/* Writes "a whole number from 1 to 64", "a number above 0, or infinity". factor: as in
 * vlGiven. */
static void put_number_rule(const vlParameter *row, double factor, char *rule, size_t size) {
  const char *const thing = row->type == VL_PARAMETER_COUNT ? "whole number" : "number";
  char low[40];
  char high[40];
  put_number(low, vl_parameter_low(row) / factor);
  put_number(high, vl_parameter_high(row) / factor);
  bool above = row->flags & VL_PARAMETER_ABOVE_LOW;
  bool below = row->flags & VL_PARAMETER_BELOW_HIGH;
  bool has_low = isfinite(vl_parameter_low(row));
  bool has_high = isfinite(vl_parameter_high(row));
  if (has_low && has_high && !above && !below)
    snprintf(rule, size, "a %s from %s to %s", thing, low, high);
  else if (has_low && has_high)
    snprintf(rule, size, "a %s %s %s and %s %s", thing, above ? "above" : "of at least", low,
             below ? "below" : "at most", high);
  else if (has_low)
    snprintf(rule, size, "a %s %s %s", thing, above ? "above" : "of at least", low);
  else if (has_high)
    snprintf(rule, size, "a %s %s %s", thing, below ? "below" : "of at most", high);
  else
    snprintf(rule, size, "a finite %s", thing);
  size_t used = strlen(rule);
  const bool in_radians =
      factor == 1 && row->factor != 0 && row->unit && strcmp(row->unit, "degrees") == 0;
  const char *unit = in_radians ? "radians" : factor != 1 ? row->unit : NULL;
  if (unit)
    used += (size_t)snprintf(rule + used, size - used, " %s", unit);
  if (row->flags & VL_PARAMETER_INFINITE)
    snprintf(rule + used, size - used, ", or infinity");
}

/* As many whole names as fit; "..." stands for the others. */
static void put_choices(const char *const *choices, char *rule, size_t size) {
  const char *const more = ", ...";
  size_t used = (size_t)snprintf(rule, size, "one of ");
  for (int i = 0; choices[i]; i++) {
    const size_t rest = choices[i + 1] ? strlen(more) : 0;
    if (used + 2 + strlen(choices[i]) + rest >= size) {
      snprintf(rule + used, size - used, "%s", more);
      return;
    }
    used += (size_t)snprintf(rule + used, size - used, "%s%s", i ? ", " : "", choices[i]);
  }
}

static void put_rule(const vlParameter *row, double factor, char *rule, size_t size) {
  const char *known = vl_member_types[row->type].rule;
  if (known)
    snprintf(rule, size, "%s", known);
  else if (row->type == VL_PARAMETER_CHOICE)
    put_choices(row->choices, rule, size);
  else
    put_number_rule(row, factor, rule, size);
}

/* ---- whether it is that ------------------------------------------------------------------ */

/* Compares letters and digits only, whatever their case: "off-axis" is "OFF_AXIS". */
static bool same_word(const char *a, const char *b) {
  for (;; a++, b++) {
    while (*a == '_' || *a == '-' || *a == ' ')
      a++;
    while (*b == '_' || *b == '-' || *b == ' ')
      b++;
    char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a;
    char y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
    if (x != y)
      return false;
    if (!x)
      return true;
  }
}

static int find_word(const char *const *choices, const char *word) {
  for (int i = 0; choices[i]; i++)
    if (same_word(choices[i], word))
      return i;
  return -1;
}

static bool fits_text(const vlParameter *row, const vlGiven *given) {
  if (given->kind == VL_GIVEN_NOTHING)
    return !(row->flags & VL_PARAMETER_REQUIRED);
  return given->kind == VL_GIVEN_TEXT && (given->text[0] || row->type == VL_PARAMETER_STRING);
}

static bool fits_number(const vlParameter *row, const vlGiven *given, double number) {
  if (given->kind == VL_GIVEN_NOTHING)
    return row->flags & VL_PARAMETER_UNSET;
  /* A NaN that somebody gives is a wrong number, also if its bits are those of VL_UNSET. */
  return given->kind == VL_GIVEN_NUMBER && !isnan(given->number) && vl_number_fits(row, number);
}

static bool fits(const vlParameter *row, const vlGiven *given, double factor, double *number) {
  const vlMemberType *t = &vl_member_types[row->type];
  *number = 0;
  if (row->type == VL_PARAMETER_BOOL) {
    *number = given->number != 0;
    return given->kind == VL_GIVEN_FLAG;
  }
  if (row->type == VL_PARAMETER_CHOICE) {
    *number = given->kind == VL_GIVEN_TEXT ? find_word(row->choices, given->text) : -1;
    return *number >= 0;
  }
  if (t->text)
    return fits_text(row, given);
  if (!t->numbers && !t->spectral) /* a texture or a block */
    return t->textured && given->kind == VL_GIVEN_NOTHING;
  *number = given->kind == VL_GIVEN_NOTHING ? VL_UNSET : factor * given->number;
  return fits_number(row, given, *number);
}

/* ---- messages ---------------------------------------------------------------------------- */

static void put_value(const vlParameter *row, const vlGiven *given, char *value, size_t size) {
  bool unit = given->factor != 0 && given->factor != 1 && row->unit;
  char number[40];
  switch (given->kind) {
    case VL_GIVEN_NOTHING:
      snprintf(value, size, "nothing");
      break;
    case VL_GIVEN_FLAG:
      snprintf(value, size, "%s", given->number != 0 ? "true" : "false");
      break;
    case VL_GIVEN_NUMBER:
      snprintf(value, size, "%s%s%s", put_number(number, given->number), unit ? " " : "",
               unit ? row->unit : "");
      break;
    case VL_GIVEN_TEXT:
      snprintf(value, size, "\"%s\"", vl_argument_text(given->text).text);
      break;
    case VL_GIVEN_OTHER:
      snprintf(value, size, "of another type");
      break;
  }
}

static void put_near(const char *name, const char *const *names, size_t count,
                     const char *prefix, char *text, size_t size) {
  const char *near = vl_near_name(name, names, count);
  text[0] = 0;
  if (near)
    snprintf(text, size, "; did you mean \"%s%s\"?", prefix, near);
}

/* Writes `NAME must be RULE; it is VALUE`, or as much of it as has room. */
static void put_wrong(const vlParameter *row, const char *name, const vlGiven *given,
                      char *message, size_t size) {
  char rule[256];
  char value[270];
  char near[80] = "";
  double factor = given->factor != 0 ? given->factor : 1;
  put_rule(row, factor, rule, sizeof rule);
  if (row->flags & VL_PARAMETER_UNSET && given->kind == VL_GIVEN_NOTHING)
    snprintf(rule + strlen(rule), sizeof rule - strlen(rule), ", or nothing");
  put_value(row, given, value, sizeof value);
  if (row->type == VL_PARAMETER_CHOICE && given->kind == VL_GIVEN_TEXT)
    put_near(given->text, row->choices, vl_choice_count(row), "", near, sizeof near);
  snprintf(message, size, "%s must be %s; it is %s%s", name, rule,
           given->shown ? given->shown : value, near);
}

bool vl_given_check(const vlParameter *row, const char *name, const vlGiven *given,
                    double *number, char message[VL_GIVEN_MESSAGE]) {
  double unused;
  if (fits(row, given, given->factor != 0 ? given->factor : 1, number ? number : &unused))
    return true;
  put_wrong(row, name, given, message, VL_GIVEN_MESSAGE);
  return false;
}

const char *vl_near_name(const char *name, const char *const *names, size_t count) {
  size_t length = strlen(name);
  const char *near = vl_nearest_name(name, names, count);
  for (size_t i = 0; i < count && !near && length >= 2; i++)
    if (strncmp(names[i], name, length) == 0)
      near = names[i]; /* an abbreviation */
  return near;
}

void vl_unknown_name(const char *thing, const char *prefix, const char *name,
                     const char *const *names, size_t count, char message[VL_GIVEN_MESSAGE]) {
  int used = snprintf(message, VL_GIVEN_MESSAGE, "unknown %s \"%s%s\"", thing, prefix,
                      vl_argument_text(name).text);
  size_t room = VL_GIVEN_MESSAGE - (size_t)used;
  put_near(name, names, count, prefix, message + used, room);
  if (message[used])
    return;
  char list[VL_GIVEN_MESSAGE] = "";
  for (size_t i = 0; i < count; i++)
    vl_list_name(list, room > 20 ? room - 20 : 0, names[i]);
  snprintf(message + used, room, "; known are%s", list + (list[0] == ':'));
}

/* ---- members of defs --------------------------------------------------------------------- */

void vl_parameter_complain(const vlParameter *p, const char *name, double wrong,
                           char message[VL_GIVEN_MESSAGE]) {
  double factor = p->factor != 0 ? p->factor : 1;
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = wrong / factor, .factor = factor};
  if (vl_member_types[p->type].text)
    snprintf(message, VL_GIVEN_MESSAGE, "%s is missing", name);
  else
    put_wrong(p, name, &given, message, VL_GIVEN_MESSAGE);
}

bool vl_parameter_check(const vlParameter *p, const void *def, const char *name,
                        char message[VL_GIVEN_MESSAGE]) {
  double wrong;
  if (vl_parameter_fits(p, def, &wrong))
    return true;
  vl_parameter_complain(p, name, wrong, message);
  return false;
}

bool vl_choices_check(vlSettingGroup group, size_t begin, size_t size, const void *part,
                      char message[VL_GIVEN_MESSAGE]) {
  const vlKindRow *row = vl_settings(group);
  VL_EACH_PARAMETER(whole, row) {
    vlParameter p = *whole; /* as a member of the part */
    if (p.type != VL_PARAMETER_CHOICE || p.offset < begin || p.offset >= begin + size)
      continue;
    p.offset -= begin;
    if (!vl_parameter_check(&p, part, vl_setting_keyword(whole), message))
      return false;
  }
  return true;
}
