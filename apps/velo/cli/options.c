/* cli/options.c: parses the command line by the command's table. See options.h; the help page is in help.c. */
#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/kinds.h"
#include "cli/report.h"

/* ---- the nearest name -------------------------------------------------------------------------------------------- */

enum { LONGEST_NAME = 40 };

/* Edit distance between a and b: insertions, deletions, changes and swaps of letters; case ignored. */
static int edit_distance(const char *a, const char *b) {
  int n = (int)strlen(a), m = (int)strlen(b);
  if (n > LONGEST_NAME || m > LONGEST_NAME) return LONGEST_NAME;
  int d[LONGEST_NAME + 1][LONGEST_NAME + 1];
  for (int i = 0; i <= n; i++) {
    for (int j = 0; j <= m; j++) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      int same = tolower((unsigned char)a[i - 1]) == tolower((unsigned char)b[j - 1]);
      int best = d[i - 1][j - 1] + !same;
      if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
      if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && d[i - 2][j - 2] + 1 < best)
        best = d[i - 2][j - 2] + 1;
      d[i][j] = best;
    }
  }
  return d[n][m];
}

const char *did_you_mean(const char *prefix, const char *wrong, const char *const *names, int count) {
  static char text[160];
  const char *best = NULL;
  int best_distance = LONGEST_NAME, length = (int)strlen(wrong);
  for (int i = 0; i < count; i++) {
    int distance = edit_distance(wrong, names[i]);
    /* An abbreviation counts as one wrong letter. */
    if (length >= 2 && strncmp(names[i], wrong, (size_t)length) == 0) distance = distance < 1 ? distance : 1;
    if (distance < best_distance) {
      best_distance = distance;
      best = names[i];
    }
  }
  if (!best || best_distance * 3 > (length > 3 ? length + 1 : 3)) return "";
  snprintf(text, sizeof text, "; did you mean \"%s%s\"?", prefix, best);
  return text;
}

/* Names of other programs' options, and velo's. The first that the command has is suggested. */
static const char *const synonyms[][3] = {{"width", "resolution", "size"}, {"height", "resolution", "size"},
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
  for (size_t i = 0; i < sizeof synonyms / sizeof *synonyms; i++)
    for (int k = 1; k < 3 && strcmp(synonyms[i][0], name) == 0; k++)
      for (const Option *o = command->options; o->name; o++)
        if (synonyms[i][k] && strcmp(o->name, synonyms[i][k]) == 0) return o;
  return NULL;
}

static int unknown_option(const Command *command, const char *name, const char *prefix) {
  const Option *synonym = strcmp(prefix, "--") == 0 ? find_synonym(command, name) : NULL;
  if (synonym)
    return report_usage("unknown option \"--%s\"; did you mean \"--%s%s%s\"?", name, synonym->name,
                        synonym->value ? " " : "", synonym->value ? synonym->value : "");
  const char *names[MAX_OPTIONS + 1] = {"help"};
  int count = 1;
  for (const Option *o = command->options; o->name; o++) names[count++] = o->name;
  const char *near = did_you_mean("--", name, names, count);
  if (*near) return report_usage("unknown option \"%s%s\"%s", prefix, name, near);
  return report_usage("unknown option \"%s%s\"; \"velo help %s\" lists them", prefix, name, command->name);
}

const Choice *option_choices(const Option *option) {
  return option->kind == OPTION_KIND ? kind_choices(option->choices) : option->choices;
}

const char *choice_name(const Choice *choices, int value) {
  for (; choices->name; choices++)
    if (choices->value == value) return choices->name;
  return "?";
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/* Reads a decimal number that extends to `end` (null: the end of the text). Hexadecimal, inf and nan are rejected. */
static bool read_number(const char *text, const char *end, double *number) {
  if (!end) end = text + strlen(text);
  if (text == end || !(isdigit((unsigned char)*text) || strchr("+-.", *text))) return false;
  for (const char *s = text; s < end; s++)
    if (!(isdigit((unsigned char)*s) || strchr("+-.eE", *s))) return false;
  char *stop;
  *number = strtod(text, &stop);
  return stop == end && isfinite(*number);
}

static bool read_integer(const char *text, const char *end, int64_t *number) {
  if (!end) end = text + strlen(text);
  const char *s = text + (*text == '-' || *text == '+');
  if (s >= end) return false;
  for (const char *t = s; t < end; t++)
    if (!isdigit((unsigned char)*t)) return false;
  errno = 0;
  *number = strtoll(text, NULL, 10);
  return errno == 0;
}

/* Reads a time: 90, 1.5m, 1h30m, 20s; the parts are added. */
static bool read_time(const char *text, double *seconds) {
  *seconds = 0;
  if (read_number(text, NULL, seconds)) return *seconds > 0;
  const char *s = text;
  while (*s) {
    const char *unit = s + strspn(s, "0123456789.");
    double part, factor = *unit == 'h' ? 3600 : *unit == 'm' ? 60 : *unit == 's' ? 1 : 0;
    if (factor == 0 || !read_number(s, unit, &part)) return false;
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
  if (!read_number(text, unit, &number)) return false;
  const char *found = *unit ? strchr(units, *unit == 'K' ? 'k' : *unit) : NULL;
  if (found) {
    bool binary = unit[1] == 'i';
    for (const char *u = units; u <= found; u++) factor *= binary ? 1024 : 1000;
    unit += 1 + binary;
  }
  if (*unit == 'B') unit++;
  *bytes = number * factor < 9e18 ? (int64_t)(number * factor) : INT64_MAX;
  return !*unit && *bytes > 0;
}

static bool read_size(const Option *option, const char *text, int64_t size[2]) {
  const char *x = strpbrk(text, "xX");
  if (!x || !read_integer(text, x, &size[0]) || !read_integer(x + 1, NULL, &size[1])) return false;
  for (int i = 0; i < 2; i++)
    if ((double)size[i] < option->min || (double)size[i] > option->max) return false;
  return true;
}

/* Reads four values separated by commas; either pointer may be null. */
static bool read_four(const char *text, int64_t *integers, double *numbers) {
  for (int i = 0; i < 4; i++) {
    const char *end = i < 3 ? strchr(text, ',') : text + strlen(text);
    if (!end) return false;
    if (integers ? !read_integer(text, end, &integers[i]) : !read_number(text, end, &numbers[i])) return false;
    text = end + 1;
  }
  return true;
}

static int bad_value(const Option *option, const char *text, const char *wanted) {
  return report_usage("--%s \"%s\": %s", option->name, text, wanted);
}

static int read_choice(const Option *option, const char *text, OptionValue *value) {
  const char *names[32];
  char list[400] = "";
  int count = 0;
  const Choice *choices = option_choices(option);
  for (const Choice *c = choices; c->name; c++) {
    if (strcmp(c->name, text) == 0) {
      value->integer = c->value;
      return -1;
    }
    if (count < 32) names[count++] = c->name;
    if (c == choices || c->value != c[-1].value) {
      size_t n = strlen(list);
      snprintf(list + n, sizeof list - n, "%s%s", n ? ", " : "", c->name);
    }
  }
  const char *near = did_you_mean("", text, names, count);
  if (*near) return report_usage("--%s: unknown name \"%s\"%s", option->name, text, near);
  return report_usage("--%s: unknown name \"%s\"; accepted are %s", option->name, text, list);
}

static int read_value(const Option *option, const char *text, Arguments *arguments) {
  OptionValue *value = &arguments->values[option->id];
  char wanted[160];
  value->text = text;
  switch (option->kind) {
    case OPTION_FLAG: break;
    case OPTION_INTEGER:
      if (read_integer(text, NULL, &value->integer) && (double)value->integer >= option->min &&
          (double)value->integer <= option->max)
        break;
      snprintf(wanted, sizeof wanted, "must be a whole number from %.0f to %.0f", option->min, option->max);
      return bad_value(option, text, wanted);
    case OPTION_NUMBER:
      if (read_number(text, NULL, &value->number) && value->number >= option->min && value->number <= option->max)
        break;
      snprintf(wanted, sizeof wanted, "must be a number from %g to %g", option->min, option->max);
      return bad_value(option, text, wanted);
    case OPTION_TIME:
      if (read_time(text, &value->number)) break;
      return bad_value(option, text, "must be a time above 0 such as 30, 30s, 5m or 1h30m");
    case OPTION_BYTES:
      if (read_bytes(text, &value->integer)) break;
      return bad_value(option, text, "must be a size such as 500M, 2G or 1.5GiB");
    case OPTION_SIZE:
      if (read_size(option, text, value->integers)) break;
      snprintf(wanted, sizeof wanted, "must be WIDTHxHEIGHT, each from %.0f to %.0f", option->min, option->max);
      return bad_value(option, text, wanted);
    case OPTION_CROP:
      if (read_four(text, value->integers, NULL) && value->integers[0] >= 0 && value->integers[1] >= 0 &&
          value->integers[0] < value->integers[2] && value->integers[1] < value->integers[3])
        break;
      return bad_value(option, text, "must be x0,y0,x1,y1 in pixels with x0 < x1 and y0 < y1");
    case OPTION_FRACTIONS:
      if (read_four(text, NULL, value->numbers) && value->numbers[0] >= 0 && value->numbers[0] < value->numbers[1] &&
          value->numbers[1] <= 1 && value->numbers[2] >= 0 && value->numbers[2] < value->numbers[3] &&
          value->numbers[3] <= 1)
        break;
      return bad_value(option, text, "must be x0,x1,y0,y1, fractions from 0 to 1 with x0 < x1 and y0 < y1");
    case OPTION_KIND:
    case OPTION_CHOICE: {
      int status = read_choice(option, text, value);
      if (status >= 0) return status;
      break;
    }
    case OPTION_TEXT:
      if (!*text) return bad_value(option, text, "must not be empty");
      break;
    case OPTION_TEXTS:
      if (!*text) return bad_value(option, text, "must not be empty");
      if (arguments->text_count == MAX_TEXTS) return report_usage("--%s: at most %d", option->name, MAX_TEXTS);
      arguments->texts[arguments->text_count++] = text;
      break;
    case OPTION_FOLDERS:
      if (!*text) return bad_value(option, text, "must not be empty");
      if (arguments->folder_count == MAX_TEXTS) return report_usage("--%s: at most %d", option->name, MAX_TEXTS);
      arguments->folders[arguments->folder_count++] = text;
      break;
    case OPTION_SEARCH: {
      size_t n = strlen(arguments->search);
      if (!*text) return bad_value(option, text, "must not be empty");
      if (n + strlen(text) + 2 > sizeof arguments->search) return report_usage("--%s: too long", option->name);
      snprintf(arguments->search + n, sizeof arguments->search - n, "%s%s", n ? ":" : "", text);
      value->text = arguments->search;
      break;
    }
  }
  value->given = true;
  return -1;
}

/* ---- the line ---------------------------------------------------------------------------------------------------- */

static const Option *find_option(const Command *command, const char *name, size_t length, char letter) {
  for (const Option *o = command->options; o->name; o++)
    if (letter ? o->letter == letter : strncmp(o->name, name, length) == 0 && !o->name[length]) return o;
  return NULL;
}

/* Parses one argument that begins with a dash, and the next one as its value when it needs one. */
static int parse_option(const Command *command, char ***rest, char **end, Arguments *arguments) {
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
    char plain[LONGEST_NAME + 1];
    snprintf(plain, sizeof plain, "%.*s", (int)(is_long ? length : strlen(name)), name);
    return unknown_option(command, plain, is_long ? "--" : "-");
  }
  const char *value = is_long ? (name[length] == '=' ? name + length + 1 : NULL) : (name[1] ? name + 1 : NULL);
  if (option->kind == OPTION_FLAG) {
    if (value) return report_usage("%s%.*s takes no value", is_long ? "--" : "-", (int)length, name);
    return read_value(option, "", arguments);
  }
  if (!value) {
    if (*rest + 1 == end)
      return report_usage("%s%.*s needs a value: %s", is_long ? "--" : "-", (int)length, name, option->value);
    value = *++*rest;
  }
  return read_value(option, value, arguments);
}

int options_parse(const Command *command, int argc, char **argv, Arguments *arguments) {
  memset(arguments, 0, sizeof *arguments);
  char **end = argv + argc;
  bool only_operands = false;
  for (char **rest = argv; rest < end; rest++) {
    if (!only_operands && strcmp(*rest, "--") == 0) {
      only_operands = true;
    } else if (!only_operands && (*rest)[0] == '-' && (*rest)[1] &&
               !strchr(".0123456789", (*rest)[1])) { /* a negative number is not an option */
      int status = parse_option(command, &rest, end, arguments);
      if (status >= 0) return status;
    } else if (arguments->operand_count == command->max_operands) {
      return report_usage("%s: one argument too many: \"%s\"", command->name, *rest);
    } else {
      if (arguments->operand_count < MAX_OPERANDS) arguments->operands[arguments->operand_count] = *rest;
      argv[arguments->operand_count++] = *rest; /* earlier words are read already */
    }
  }
  arguments->all_operands = (const char *const *)argv;
  if (arguments->operand_count < command->min_operands)
    return report_usage("%s: too few arguments; usage: velo %s %s", command->name, command->name, command->usage);
  return -1;
}
