/* cli/options.h: the command line by table. Each command lists its options; parsing, checks,
 * suggestions ("did you mean") and the help page use that list. */
#ifndef APP_CLI_OPTIONS_H
#define APP_CLI_OPTIONS_H

#include "cli/choice.h"
#include "velo/base.h"
#include "velo/setting.h"

typedef enum OptionKind {
  OPTION_FLAG,
  OPTION_INTEGER,   /* in [min, max] */
  OPTION_NUMBER,    /* in [min, max] */
  OPTION_ANGLE,     /* degrees, or 0.5rad; sets number (degrees) and numbers[0] (radians) */
  OPTION_POINT,     /* X,Y,Z; sets numbers */
  OPTION_TIME,      /* in seconds: 30, 30s, 5m, 1h30m */
  OPTION_BYTES,     /* 500M, 2G, 1.5GiB; sets integer */
  OPTION_SIZE,      /* WxH, each in [min, max] */
  OPTION_CROP,      /* x0,y0,x1,y1, integers */
  OPTION_FRACTIONS, /* x0,x1,y0,y1 in [0, 1] */
  OPTION_CHOICE,    /* one of choices */
  OPTION_KIND,      /* one of the kinds of the family that choices names */
  OPTION_TEXT,
  OPTION_TEXTS,   /* may be repeated; at most one such option per command */
  OPTION_FOLDERS, /* likewise, a separate list */
  OPTION_SEARCH   /* likewise: folders, joined by ':' */
} OptionKind;

/* Numbers in place of a name: the value's integer is then OPTION_LIST_GIVEN. */
typedef enum OptionList {
  OPTION_NO_LIST,
  OPTION_LIST_ANGLES, /* A,B: as of OPTION_ANGLE; sets numbers, radians */
  OPTION_LIST_POINT   /* as of OPTION_POINT */
} OptionList;
enum { OPTION_LIST_GIVEN = -1 };

/* A row of a table ends with its last member that is not zero. A row without a name is an
 * option of `velo render`: options_share fills in what is not given here. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
typedef struct Option {
  int id;           /* index into Arguments.values */
  const char *name; /* without dashes; null ends the list, where the id is 0 */
  const char *help; /* the help page wraps it */
  OptionKind kind;
  const char *value; /* placeholder in the help page; null for flags */
  double min, max;   /* both 0: the range of the setting of that name (velo/setting.h) */
  const Choice *choices;
  OptionList list; /* of OPTION_CHOICE: what may stand in place of a name */
  char letter;     /* 0: none */
} Option;

enum { MAX_OPTIONS = 113, MAX_TEXTS = 32, MAX_OPERANDS = 4 };

typedef struct OptionValue {
  bool given;
  int64_t integer; /* integer; value of the choice */
  double number;   /* number; time in seconds */
  int64_t integers[4];
  double numbers[4];
  const char *text; /* the text as given; null: not given */
} OptionValue;

typedef struct Arguments {
  const struct Command *command; /* whose line it is */
  OptionValue values[MAX_OPTIONS];
  const char *texts[MAX_TEXTS];
  int text_count;
  const char *folders[MAX_TEXTS];
  int folder_count;
  char search[4096]; /* text of the option of kind OPTION_SEARCH: folders joined by ':' */
  const char *operands[MAX_OPERANDS]; /* the first MAX_OPERANDS operands */
  const char *const *all_operands;    /* all operands; points into argv */
  int operand_count;
  bool channels_later; /* --continue: --channels was given, but not for the film */
} Arguments;

/* A heading in the help page, before the option of that id. */
typedef struct Section {
  int first;         /* id of the option */
  const char *title; /* null ends the list */
} Section;

/* The context that a command gets. CONTEXT_OWN: none, it opens its own if it needs one. */
typedef enum ContextUse {
  CONTEXT_OWN,
  CONTEXT_ONE, /* of one thread */
  CONTEXT_ALL  /* of all threads, or of --threads */
} ContextUse;

typedef struct Command {
  const char *name;     /* "image diff"; null ends a list */
  const char *usage;    /* text after the name: "FILE [options]" */
  const char *summary;  /* one line */
  const char *text;     /* paragraphs between usage and options */
  const char *examples; /* lines after the options */
  Option *options;
  const Section *sections; /* null: the options are one section */
  const char *brief; /* for long pages: what `velo help` prints without --all between usage and
                        hint, lines of at most 80 columns with examples and the most used
                        options; null: the page is printed whole */
  int operands, optional_operands; /* how many are needed, and how many more may follow */
  ContextUse context;
  /* Returns the exit code. What it prints to stdout is flushed and checked afterwards. */
  int (*run)(const Arguments *arguments, vlContext *context);
} Command;

/* The row of commands whose result can be one JSON object. */
#define JSON_OPTION(id) \
  { (id), "json", "print one JSON object to stdout" }

/* result: what the command makes: "image". */
#define THREADS_OPTION(id, result)                                               \
  {                                                                              \
    (id), "threads",                                                             \
        "number of worker threads; default: one for each processor. The " result \
        " does not depend on it",                                                \
        OPTION_INTEGER, "N", .letter = 't'                                       \
  }

/* Gives each row without a name the members of the row of `from` with the same id, and its help
 * unless it has one of its own. For all commands, before anything else reads their rows. */
void options_share(Option *options, const Option *from);
/* Parses argv without the names of program and command. Returns -1 to continue, otherwise the
 * exit code after reporting (0 after --help). */
int options_parse(const Command *command, int argc, char **argv, Arguments *arguments);
/* Reports that both options are given, if they are. Returns -1 or the exit code. */
int options_exclude(const Arguments *arguments, int one, int other);
/* Reports that the command needs more operands. Returns the exit code. */
int options_too_few(const Command *command);
/* all: the whole page, also of a command that has a brief one. */
void options_print_help(const Command *command, bool all);

typedef struct ExitStatus {
  const char *code; /* null ends the list */
  const char *meaning;
} ExitStatus;

extern const ExitStatus exit_statuses[];
/* Prints the exit codes as a list. */
void options_print_exit_statuses(void);

/* For "render": "; did you mean \"render\"?". Empty when no name is near. Valid until the next
 * call. */
const char *did_you_mean(const char *prefix, const char *wrong, const char *const *names,
                         int count);
/* Puts the given values of options whose names are settings of a group into its def: numbers,
 * flags, names of choices, texts. Other kinds of values are left to the caller. values: of all
 * options. */
void options_put(const Option *options, const OptionValue *values, vlSettingGroup group,
                 void *def);
/* The whole number that was given, else another. */
uint32_t option_count(const OptionValue *value, uint32_t otherwise);
/* The size that was given, of OPTION_SIZE; else both numbers stay. */
void option_size(const OptionValue *value, uint32_t *width, uint32_t *height);
/* The pixels that were given, of OPTION_CROP, in place of the whole image in window; where none
 * were, it stays. -1, or the exit code after reporting that the image is smaller. */
int option_crop(const OptionValue *value, uint32_t window[4]);
/* Reads a number by a row, in the row's unit. -1: it is read; else the exit code, after a
 * report. name: of the value in the message. number may be null. */
int option_number(const char *name, const char *text, const vlParameter *row, double *number);
/* Whether an option's id is among `count` others. */
bool option_is_in(int id, const int *ids, size_t count);
/* Radians of degrees, as options convert them. */
double option_radians(double degrees);
/* The names that an option takes; null: any text. */
const Choice *option_choices(const Option *option);
/* The name of a choice's value. */
const char *choice_name(const Choice *choices, int value);

#endif
