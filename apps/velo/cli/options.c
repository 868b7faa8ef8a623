/* cli/options.c: parses the command line by the command's table. See options.h; the help page
 * is in help.c. */
#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"

/* ---- the nearest name -------------------------------------------------------------------- */

enum { MAX_NAME = 40 };

const char *did_you_mean(const char *prefix, const char *wrong, const char *const *names,
                         int count) {
  static char text[160];
  const char *near = vl_near_name(wrong, names, (size_t)count);
  text[0] = 0;
  if (near)
    text_set(text, "; did you mean \"%s%s\"?", prefix, near);
  return text;
}

/* Names of other programs' options, and velo's. The first that the command has is suggested. */
static const char *const synonyms[][3] = {
    {"width", "resolution", "size"}, {"height", "resolution", "size"},
    {"size", "resolution", NULL},    {"dimensions", "resolution", NULL},
    {"samples", "spp", NULL},        {"pixelsamples", "spp", NULL},
    {"integrator", "tracer", NULL},  {"nthreads", "threads", NULL},
    {"jobs", "threads", NULL},       {"cores", "threads", NULL},
    {"outfile", "output", NULL},     {"out", "output", NULL},
    {"bounces", "max-depth", NULL},  {"depth", "max-depth", NULL},
    {"force", "overwrite", NULL},    {"silent", "quiet", NULL},
    {"timeout", "time", NULL},       {"envmap", "environment", NULL},
    {"hdri", "environment", NULL},   {"background", "environment", NULL},
    {"tonemap", "view", NULL}};

static const Option *find_synonym(const Command *command, const char *name) {
  for (size_t i = 0; i < LENGTH(synonyms); i++)
    for (int k = 1; k < 3 && strcmp(synonyms[i][0], name) == 0; k++)
      for (const Option *o = command->options; o->name; o++)
        if (synonyms[i][k] && strcmp(o->name, synonyms[i][k]) == 0)
          return o;
  return NULL;
}

static int unknown_option(const Command *command, const char *name, const char *prefix) {
  const Option *synonym = strcmp(prefix, "--") == 0 ? find_synonym(command, name) : NULL;
  if (synonym)
    return report_usage("unknown option \"--%s\"; did you mean \"--%s%s%s\"?", name,
                        synonym->name, synonym->value ? " " : "",
                        synonym->value ? synonym->value : "");
  const char *names[MAX_OPTIONS + 1] = {"help"};
  int count = 1;
  for (const Option *o = command->options; o->name; o++)
    names[count++] = o->name;
  const char *near = did_you_mean("--", name, names, count);
  if (*near)
    return report_usage("unknown option \"%s%s\"%s", prefix, name, near);
  return report_usage("unknown option \"%s%s\"; \"velo help %s\" lists them", prefix, name,
                      command->name);
}

static bool is_end(const Option *option) {
  return option->id == 0 && !option->name;
}

void options_share(Option *options, const Option *from) {
  for (Option *o = options; !is_end(o); o++) {
    const char *help = o->help;
    for (const Option *row = from; !o->name && row->name; row++)
      if (row->id == o->id)
        *o = *row;
    if (help)
      o->help = help;
  }
}

const Choice *option_choices(const Option *option) {
  return option->kind == OPTION_KIND ? kind_choices(option->choices) : option->choices;
}

const char *choice_name(const Choice *choices, int value) {
  for (; choices->name; choices++)
    if (choices->value == value)
      return choices->name;
  return "?";
}

/* ---- values ------------------------------------------------------------------------------ */

/* Reads a decimal number that extends to `end` (null: the end of the text). Hexadecimal, inf
 * and nan are rejected. */
static bool read_number(const char *text, const char *end, double *number) {
  if (!end)
    end = text + strlen(text);
  if (text == end || !(isdigit((unsigned char)*text) || strchr("+-.", *text)))
    return false;
  for (const char *s = text; s < end; s++)
    if (!(isdigit((unsigned char)*s) || strchr("+-.eE", *s)))
      return false;
  char *stop;
  *number = strtod(text, &stop);
  return stop == end && isfinite(*number);
}

static bool read_integer(const char *text, const char *end, int64_t *number) {
  if (!end)
    end = text + strlen(text);
  const char *s = text + (*text == '-' || *text == '+');
  if (s >= end)
    return false;
  for (const char *t = s; t < end; t++)
    if (!isdigit((unsigned char)*t))
      return false;
  errno = 0;
  *number = strtoll(text, NULL, 10);
  return errno == 0;
}

/* Reads a time: 90, 1.5m, 1h30m, 20s; the parts are added. */
static bool read_time(const char *text, double *seconds) {
  *seconds = 0;
  if (read_number(text, NULL, seconds))
    return *seconds > 0;
  const char *s = text;
  while (*s) {
    const char *unit = s + strspn(s, "0123456789.");
    double part, factor = *unit == 'h' ? 3600 : *unit == 'm' ? 60 : *unit == 's' ? 1 : 0;
    if (factor == 0 || !read_number(s, unit, &part))
      return false;
    *seconds += part * factor;
    s = unit + 1;
  }
  return *seconds > 0 && isfinite(*seconds);
}

/* Reads a number of bytes. 500M, 2G, 1.5GB: powers of 1000; KiB, MiB, GiB: powers of 1024. */
static bool read_bytes(const char *text, int64_t *bytes) {
  static const char units[] = "kMGT";
  const char *unit = text + strspn(text, "0123456789.");
  double number, factor = 1;
  if (!read_number(text, unit, &number))
    return false;
  const char *found = *unit ? strchr(units, *unit == 'K' ? 'k' : *unit) : NULL;
  if (found) {
    bool binary = unit[1] == 'i';
    for (const char *u = units; u <= found; u++)
      factor *= binary ? 1024 : 1000;
    unit += 1 + binary;
  }
  if (*unit == 'B')
    unit++;
  *bytes = number * factor < 9e18 ? (int64_t)(number * factor) : INT64_MAX;
  return !*unit && *bytes > 0;
}

bool option_is_in(int id, const int *ids, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (ids[i] == id)
      return true;
  return false;
}

double option_radians(double degrees) {
  return degrees * M_PI / 180.0;
}

/* Reads degrees, or radians with the unit: 0.5rad. */
static bool read_angle(const char *text, const char *end, double *radians) {
  if (!end)
    end = text + strlen(text);
  if (end - text > 3 && memcmp(end - 3, "rad", 3) == 0)
    return read_number(text, end - 3, radians);
  if (!read_number(text, end, radians))
    return false;
  *radians = option_radians(*radians);
  return true;
}

/* Reads `count` values separated by commas, into integers or numbers. angles: the numbers are
 * angles. */
static bool read_list(const char *text, int count, int64_t *integers, double *numbers,
                      bool angles) {
  for (int i = 0; i < count; i++) {
    const char *end = i + 1 < count ? strchr(text, ',') : text + strlen(text);
    if (!end)
      return false;
    if (integers ? !read_integer(text, end, &integers[i])
        : angles ? !read_angle(text, end, &numbers[i])
                 : !read_number(text, end, &numbers[i]))
      return false;
    text = end + 1;
  }
  return true;
}

static int bad_value(const Option *option, const char *text, const char *wanted) {
  return report_usage("--%s %s; it is \"%s\"", option->name, wanted, text);
}

/* ---- values of rows ---------------------------------------------------------------------- */

/* The setting whose name or alias is the option's. */
static const vlParameter *setting_of(const char *name) {
  static const vlSettingGroup groups[] = {VL_SETTING_PROGRAM,  VL_SETTING_RENDER,
                                          VL_SETTING_CAMERA,   VL_SETTING_COMPLETE,
                                          VL_SETTING_CHANNELS, VL_SETTING_CONTEXT};
  const vlParameter *row = NULL;
  for (size_t i = 0; i < LENGTH(groups) && !row; i++)
    row = vl_setting(groups[i], name);
  return row;
}

/* The row of an option of one number: of the setting of its name, or with its own range. */
static vlParameter row_of(const Option *option) {
  const bool own = option->min != 0 || option->max != 0;
  const vlParameter *row =
      own ? NULL : setting_of(option->kind == OPTION_SIZE ? "width" : option->name);
  if (row)
    return *row;
  const bool whole = option->kind == OPTION_INTEGER || option->kind == OPTION_SIZE;
  return (vlParameter){.type = whole ? VL_PARAMETER_COUNT : VL_PARAMETER_DOUBLE,
                       .low = option->min,
                       .high = option->max};
}

int option_number(const char *name, const char *text, const vlParameter *row, double *number) {
  char message[VL_GIVEN_MESSAGE];
  int64_t whole = 0;
  double value = 0;
  bool counts = row->type == VL_PARAMETER_COUNT;
  bool read = counts ? read_integer(text, NULL, &whole) : read_number(text, NULL, &value);
  const vlGiven given = {.kind = read ? VL_GIVEN_NUMBER : VL_GIVEN_TEXT,
                         .number = counts ? (double)whole : value,
                         .text = text,
                         .factor = row->factor};
  if (!vl_given_check(row, name, &given, NULL, message))
    return report_usage("%s", message);
  if (number)
    *number = given.number;
  return -1;
}

/* Reads WIDTHxHEIGHT. */
static int read_size(const Option *option, const char *text, int64_t size[2]) {
  const vlParameter row = row_of(option);
  const char *x = strpbrk(text, "xX");
  char side[2][24] = {"", ""};
  if (!x || (size_t)(x - text) >= sizeof side[0] || strlen(x + 1) >= sizeof side[1])
    return report_usage("--%s must be WIDTHxHEIGHT; it is \"%s\"", option->name, text);
  memcpy(side[0], text, (size_t)(x - text));
  strcpy(side[1], x + 1);
  for (int i = 0; i < 2; i++) {
    char name[80];
    double number;
    text_set(name, "--%s WIDTHxHEIGHT: the %s", option->name, i ? "height" : "width");
    TRY(option_number(name, side[i], &row, &number));
    size[i] = (int64_t)number;
  }
  return -1;
}

/* Reads numbers in place of a name. */
static int read_choice_list(const Option *option, const char *text, OptionValue *value) {
  const bool angles = option->list == OPTION_LIST_ANGLES;
  value->integer = OPTION_LIST_GIVEN;
  if (read_list(text, angles ? 2 : 3, NULL, value->numbers, angles))
    return -1;
  return bad_value(
      option, text,
      angles ? "must be a name, or A,E: two angles in degrees" : "must be a name, or X,Y,Z");
}

static int read_choice(const Option *option, const char *text, OptionValue *value) {
  enum { MAX_NAMES = 64 };
  const Choice *choices = option_choices(option);
  const char *names[MAX_NAMES + 1] = {NULL};
  char what[80];
  char message[VL_GIVEN_MESSAGE];
  double index;
  if (option->list != OPTION_NO_LIST && *text && strchr("+-.0123456789", *text))
    return read_choice_list(option, text, value);
  for (int i = 0; i < MAX_NAMES && choices[i].name; i++)
    names[i] = choices[i].name;
  const vlParameter row = {.type = VL_PARAMETER_CHOICE, .choices = names};
  const vlGiven given = {.kind = VL_GIVEN_TEXT, .text = text};
  text_set(what, "--%s", option->name);
  if (!vl_given_check(&row, what, &given, &index, message))
    return report_usage("%s", message);
  value->integer = choices[(int)index].value;
  return -1;
}

/* Reads a value of OPTION_INTEGER or OPTION_NUMBER. */
static int read_row(const Option *option, const char *text, OptionValue *value) {
  const vlParameter row = row_of(option);
  char name[80];
  text_set(name, "--%s", option->name);
  int status = option_number(name, text, &row, &value->number);
  if (option->kind == OPTION_INTEGER)
    value->integer = (int64_t)value->number;
  return status;
}

/* Reads a value of OPTION_ANGLE, in the range of its row. */
static int read_angle_row(const Option *option, const char *text, OptionValue *value) {
  const vlParameter row = row_of(option);
  char name[80], message[VL_GIVEN_MESSAGE];
  text_set(name, "--%s", option->name);
  if (!read_angle(text, NULL, &value->numbers[0]))
    return option_number(name, text, &row, &value->number);
  const vlGiven given = {.kind = VL_GIVEN_NUMBER,
                         .number = value->numbers[0] / row.factor,
                         .text = text,
                         .shown = text,
                         .factor = row.factor};
  value->number = given.number;
  return vl_given_check(&row, name, &given, NULL, message) ? -1 : report_usage("%s", message);
}

/* Puts the value of an option into the member of a def that a row describes. */
static void put_value(const Option *option, const OptionValue *value, const vlParameter *row,
                      void *def) {
  const bool is_text = option->kind == OPTION_TEXT || option->kind == OPTION_SEARCH;
  const bool is_name = option->kind == OPTION_CHOICE || option->kind == OPTION_KIND;
  if (is_text && row->type == VL_PARAMETER_STRING)
    memcpy((char *)def + row->offset, &value->text, sizeof value->text);
  else if (is_name && value->integer != OPTION_LIST_GIVEN)
    vl_given_put(row, (double)value->integer, def);
  else if (option->kind == OPTION_INTEGER || option->kind == OPTION_NUMBER)
    vl_given_put(row, value->number, def);
  else if (option->kind == OPTION_ANGLE)
    vl_given_put(row, value->numbers[0], def);
  else if (option->kind == OPTION_FLAG)
    vl_given_put(row, 1, def);
}

void options_put(const Option *options, const OptionValue *values, vlSettingGroup group,
                 void *def) {
  for (const Option *o = options; !is_end(o); o++) {
    const vlParameter *row = values[o->id].given ? vl_setting(group, o->name) : NULL;
    if (row)
      put_value(o, &values[o->id], row, def);
  }
}

uint32_t option_count(const OptionValue *value, uint32_t otherwise) {
  return value->given ? (uint32_t)value->integer : otherwise;
}

void option_size(const OptionValue *value, uint32_t *width, uint32_t *height) {
  *width = value->given ? (uint32_t)value->integers[0] : *width;
  *height = value->given ? (uint32_t)value->integers[1] : *height;
}

int option_crop(const OptionValue *value, uint32_t window[4]) {
  if (!value->given)
    return -1;
  if (value->integers[2] > window[2] || value->integers[3] > window[3])
    return report_usage("--crop \"%s\": the image has only %u x %u pixels", value->text,
                        window[2], window[3]);
  for (int i = 0; i < 4; i++)
    window[i] = (uint32_t)value->integers[i];
  return -1;
}

/* Reads x0,y0,x1,y1. */
static int read_crop(const Option *option, const char *text, int64_t *crop) {
  if (read_list(text, 4, crop, NULL, false) && crop[0] >= 0 && crop[1] >= 0 &&
      crop[0] < crop[2] && crop[1] < crop[3])
    return -1;
  return bad_value(option, text, "must be x0,y0,x1,y1 in pixels with x0 < x1 and y0 < y1");
}

/* Reads x0,x1,y0,y1. */
static int read_fractions(const Option *option, const char *text, double *window) {
  if (read_list(text, 4, NULL, window, false) && window[0] >= 0 && window[0] < window[1] &&
      window[1] <= 1 && window[2] >= 0 && window[2] < window[3] && window[3] <= 1)
    return -1;
  return bad_value(option, text,
                   "must be x0,x1,y0,y1, fractions from 0 to 1 with x0 < x1 and y0 < y1");
}

/* Adds a text to a list. */
static int add_text(const Option *option, const char *text, const char **list, int *count) {
  if (*count == MAX_TEXTS)
    return report_usage("--%s: at most %d", option->name, MAX_TEXTS);
  list[(*count)++] = text;
  return -1;
}

static int add_search(const Option *option, const char *text, Arguments *arguments) {
  size_t n = strlen(arguments->search);
  if (n + strlen(text) + 2 > sizeof arguments->search)
    return report_usage("--%s: too long", option->name);
  snprintf(arguments->search + n, sizeof arguments->search - n, "%s%s", n ? ":" : "", text);
  arguments->values[option->id].text = arguments->search;
  return -1;
}

/* Reads a value that is any text. */
static int read_text(const Option *option, const char *text, Arguments *arguments) {
  if (!*text)
    return bad_value(option, text, "must not be empty");
  if (option->kind == OPTION_TEXTS)
    return add_text(option, text, arguments->texts, &arguments->text_count);
  if (option->kind == OPTION_FOLDERS)
    return add_text(option, text, arguments->folders, &arguments->folder_count);
  return option->kind == OPTION_SEARCH ? add_search(option, text, arguments) : -1;
}

/* Returns -1, or the exit code after a report. */
static int read_kind(const Option *option, const char *text, Arguments *arguments) {
  OptionValue *value = &arguments->values[option->id];
  switch (option->kind) {
    case OPTION_FLAG:
      return -1;
    case OPTION_INTEGER:
    case OPTION_NUMBER:
      return read_row(option, text, value);
    case OPTION_ANGLE:
      return read_angle_row(option, text, value);
    case OPTION_POINT:
      return read_list(text, 3, NULL, value->numbers, false)
                 ? -1
                 : bad_value(option, text, "must be X,Y,Z");
    case OPTION_TIME:
      return read_time(text, &value->number)
                 ? -1
                 : bad_value(option, text,
                             "must be a time above 0 such as 30, 30s, 5m or 1h30m");
    case OPTION_BYTES:
      return read_bytes(text, &value->integer)
                 ? -1
                 : bad_value(option, text, "must be a size such as 500M, 2G or 1.5GiB");
    case OPTION_SIZE:
      return read_size(option, text, value->integers);
    case OPTION_CROP:
      return read_crop(option, text, value->integers);
    case OPTION_FRACTIONS:
      return read_fractions(option, text, value->numbers);
    case OPTION_KIND:
    case OPTION_CHOICE:
      return read_choice(option, text, value);
    case OPTION_TEXT:
    case OPTION_TEXTS:
    case OPTION_FOLDERS:
    case OPTION_SEARCH:
      break;
  }
  return read_text(option, text, arguments);
}

static int read_value(const Option *option, const char *text, Arguments *arguments) {
  OptionValue *value = &arguments->values[option->id];
  value->text = text;
  const int status = read_kind(option, text, arguments);
  value->given = status < 0;
  return status;
}

/* ---- the line ---------------------------------------------------------------------------- */

static const Option *find_option(const Command *command, const char *name, size_t length,
                                 char letter) {
  for (const Option *o = command->options; o->name; o++)
    if (letter ? o->letter == letter : strncmp(o->name, name, length) == 0 && !o->name[length])
      return o;
  return NULL;
}

/* Parses one argument that begins with a dash, and the next one as its value when it needs
 * one. */
static int parse_option(const Command *command, char ***rest, char **end,
                        Arguments *arguments) {
  const char *word = **rest;
  bool is_long = word[1] == '-';
  if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
    options_print_help(command, false);
    return STATUS_OK;
  }
  const char *name = word + (is_long ? 2 : 1);
  size_t length = is_long ? strcspn(name, "=") : 1;
  const Option *option = find_option(command, name, length, is_long ? 0 : *name);
  if (!option) {
    char plain[MAX_NAME + 1];
    text_set(plain, "%.*s", (int)(is_long ? length : strlen(name)), name);
    return unknown_option(command, plain, is_long ? "--" : "-");
  }
  const char *value =
      is_long ? (name[length] == '=' ? name + length + 1 : NULL) : (name[1] ? name + 1 : NULL);
  if (option->kind == OPTION_FLAG) {
    if (value)
      return report_usage("%s%.*s takes no value", is_long ? "--" : "-", (int)length, name);
    return read_value(option, "", arguments);
  }
  if (!value) {
    if (*rest + 1 == end)
      return report_usage("%s%.*s needs a value: %s", is_long ? "--" : "-", (int)length, name,
                          option->value);
    value = *++*rest;
  }
  return read_value(option, value, arguments);
}

static const char *name_of(const Arguments *arguments, int id) {
  const Option *option = arguments->command->options;
  while (option->id != id)
    option++;
  return option->name;
}

int options_exclude(const Arguments *arguments, int one, int other) {
  if (!arguments->values[one].given || !arguments->values[other].given)
    return -1;
  return report_usage("--%s and --%s exclude each other", name_of(arguments, one),
                      name_of(arguments, other));
}

int options_too_few(const Command *command) {
  return report_usage("%s: too few arguments; usage: velo %s %s", command->name, command->name,
                      command->usage);
}

int options_parse(const Command *command, int argc, char **argv, Arguments *arguments) {
  memset(arguments, 0, sizeof *arguments);
  arguments->command = command;
  char **end = argv + argc;
  bool only_operands = false;
  for (char **rest = argv; rest < end; rest++) {
    if (!only_operands && strcmp(*rest, "--") == 0) {
      only_operands = true;
    } else if (!only_operands && (*rest)[0] == '-' && (*rest)[1] &&
               !strchr(".0123456789", (*rest)[1])) { /* a negative number is not an option */
      TRY(parse_option(command, &rest, end, arguments));
    } else if (arguments->operand_count == command->operands + command->optional_operands) {
      return report_usage("%s: one argument too many: \"%s\"", command->name, *rest);
    } else {
      if (arguments->operand_count < MAX_OPERANDS)
        arguments->operands[arguments->operand_count] = *rest;
      argv[arguments->operand_count++] = *rest; /* earlier words are read already */
    }
  }
  arguments->all_operands = (const char *const *)argv;
  return arguments->operand_count < command->operands ? options_too_few(command) : -1;
}
