/* cli/manual.c: see manual.h. The format is man(7). */
#include "cli/manual.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "velo/base.h"

enum { LINE_WIDTH = 76 };

/* ---- text -------------------------------------------------------------------------------- */

static void put_escaped(char c, bool minus) {
  switch (c) {
    case '\\':
      fputs("\\e", stdout);
      break;
    case '-':
      fputs(minus ? "\\-" : "-", stdout);
      break;
    case '\'':
      fputs("\\(aq", stdout);
      break;
    case '^':
      fputs("\\(ha", stdout);
      break;
    case '~':
      fputs("\\(ti", stdout);
      break;
    default:
      putchar(c);
  }
}

/* Prints text of a command line: each dash is a minus sign. */
static void put_literal(const char *text) {
  if (*text == '.')
    fputs("\\&", stdout);
  for (; *text; text++)
    put_escaped(*text, true);
}

/* Prints one word of prose. `code`: whether it lies between backquotes, which make the text
 * bold. */
static void put_word(const char *word, size_t length, bool *code) {
  bool option = (length >= 2 && word[0] == '-') ||
                (length >= 3 && !isalnum((unsigned char)word[0]) && word[1] == '-');
  if (*word == '.')
    fputs("\\&", stdout);
  for (size_t i = 0; i < length; i++) {
    if (word[i] == '`') {
      *code = !*code;
      fputs(*code ? "\\fB" : "\\fR", stdout);
    } else {
      put_escaped(word[i], option || *code);
    }
  }
}

static bool ends_sentence(const char *word, size_t length) {
  while (length > 1 && strchr(")\"`", word[length - 1]))
    length--;
  return length > 1 && strchr(".?!", word[length - 1]);
}

/* Prints prose in lines of at most LINE_WIDTH characters and a new line for each sentence.
 * `paragraph` is the request that begins a paragraph. A line that begins with a blank is
 * printed unchanged, as in the help page. */
static void put_prose(const char *text, const char *paragraph) {
  bool code = false, verbatim = false;
  size_t column = 0;
  while (*text) {
    if (*text == '\n') {
      bool blank = text[1] == '\n';
      if (column)
        putchar('\n');
      column = 0;
      text += blank ? 2 : 1;
      if (verbatim && *text != ' ') {
        printf(".EE\n");
        verbatim = false;
      }
      if (blank)
        printf("%s\n", paragraph);
      continue;
    }
    if (*text == ' ' && column == 0) {
      size_t n = strcspn(text, "\n");
      if (!verbatim)
        printf(".EX\n");
      verbatim = true;
      for (size_t i = 0; i < n; i++)
        put_escaped(text[i], true);
      column = n;
      text += n;
      continue;
    }
    if (*text == ' ')
      text += strspn(text, " ");
    size_t n = strcspn(text, " \n");
    if (n == 0)
      continue;
    if (column)
      putchar(column + 1 + n > LINE_WIDTH ? '\n' : ' ');
    column = column && column + 1 + n <= LINE_WIDTH ? column + 1 + n : n;
    put_word(text, n, &code);
    bool sentence = ends_sentence(text, n);
    text += n;
    if (*text == '\n' && text[1] != '\n' && text[1] != ' ')
      text++; /* one line break counts as a blank */
    if (sentence && *text && *text != '\n') {
      putchar('\n');
      text += strspn(text, " ");
      column = 0;
    }
  }
  if (column)
    putchar('\n');
  if (verbatim)
    printf(".EE\n");
}

/* ---- parts of a page --------------------------------------------------------------------- */

/* Prints the words of a command's name, with dashes between them. */
static void put_joined(const char *name, bool upper) {
  for (const char *c = name; *c; c++) {
    if (*c == ' ')
      fputs("\\-", stdout);
    else
      putchar(upper ? toupper((unsigned char)*c) : *c);
  }
}

/* Prints the title line and the section NAME. name: "image diff"; empty: the program. */
static void put_title(const char *name, const char *summary) {
  char date[32] = "", *end;
  const char *epoch = getenv("SOURCE_DATE_EPOCH");
  time_t seconds = epoch ? (time_t)strtoll(epoch, &end, 10) : 0;
  struct tm day;
  if (epoch && end != epoch && gmtime_r(&seconds, &day))
    strftime(date, sizeof date, "%Y-%m-%d", &day);
  printf(".\\\" written by velo help --man%s%s\n.TH VELO", *name ? " " : "", name);
  if (*name)
    printf("\\-");
  put_joined(name, true);
  printf(" 1 \"%s\" \"velo %d.%d.%d\" \"User Commands\"\n", date, VL_VERSION_MAJOR,
         VL_VERSION_MINOR, VL_VERSION_PATCH);
  printf(".SH NAME\nvelo");
  if (*name)
    printf("\\-");
  put_joined(name, false);
  printf(" \\- ");
  put_literal(summary);
  printf("\n");
}

static void put_choices(const Choice *choices) {
  for (const Choice *c = choices; c->name;) {
    const Choice *alias = c + 1;
    printf("\\fB");
    put_literal(c->name);
    printf("\\fR");
    for (; alias->name && alias->value == c->value; alias++) {
      printf(alias == c + 1 ? " (or \\fB" : ", \\fB");
      put_literal(alias->name);
      printf("\\fR");
    }
    printf("%s%s\n", alias > c + 1 ? ")" : "", alias->name ? "," : "");
    c = alias;
  }
}

static void put_option(const Option *o) {
  printf(".TP\n");
  if (o->letter)
    printf("\\fB\\-%c\\fR, ", o->letter);
  printf("\\fB\\-\\-");
  put_literal(o->name);
  printf("\\fR");
  if (o->value) {
    printf(" \\fI");
    put_literal(o->value);
    printf("\\fR");
  }
  printf("\n");
  put_prose(o->help, ".sp");
  if (option_choices(o))
    put_choices(option_choices(o));
}

static void put_exit_status(void) {
  printf(".SH EXIT STATUS\n");
  for (const ExitStatus *s = exit_statuses; s->code; s++) {
    printf(".TP\n.B %s\n", s->code);
    put_prose(s->meaning, ".sp");
  }
}

/* ---- pages ------------------------------------------------------------------------------- */

void manual_print_command(const Command *command) {
  put_title(command->name, command->summary);
  printf(".SH SYNOPSIS\n\\fBvelo %s\\fR ", command->name);
  put_literal(command->usage);
  printf("\n.SH DESCRIPTION\n");
  put_prose(command->text, ".PP");
  printf(".SH OPTIONS\n");
  for (const Option *o = command->options; o->name; o++) {
    for (const Section *s = command->sections; s && s->title; s++)
      if (s->first == o->id)
        printf(".SS \"%s\"\n", s->title);
    put_option(o);
  }
  printf(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint the options\n");
  put_exit_status();
  printf(".SH EXAMPLES\n.EX\n");
  for (const char *line = command->examples; line && *line;) {
    size_t n = strcspn(line, "\n");
    for (size_t i = 0; i < n; i++)
      put_escaped(line[i], true);
    putchar('\n');
    line += n + (line[n] == '\n');
  }
  printf(".EE\n.SH SEE ALSO\n.BR velo (1)\n");
}

void manual_print_program(const Command *const *commands) {
  put_title("", "photorealistic renderer");
  printf(
      ".SH SYNOPSIS\n"
      "\\fBvelo\\fR COMMAND ...\n"
      ".br\n"
      "\\fBvelo help\\fR [COMMAND]\n"
      ".br\n"
      "\\fBvelo \\-\\-version\\fR\n");
  printf(".SH DESCRIPTION\n");
  put_prose(
      "velo renders scenes of pbrt-v4, glTF, OBJ, PLY, STL and OFF by spectral path tracing, "
      "with verified camera models. An image has the same bits for any number of threads. "
      "Further commands inspect and convert scenes, images, cameras and film files. Each "
      "command has a manual page of its own.",
      ".PP");
  printf(".SH COMMANDS\n");
  for (const Command *const *c = commands; *c; c++) {
    printf(".TP\n.BR velo\\-");
    put_joined((*c)->name, false);
    printf(" (1)\n");
    put_prose((*c)->summary, ".sp");
  }
  printf(".SH ENVIRONMENT\n.TP\n.B VELO_ISA\n");
  put_prose(
      "instruction set that is used, as --isa of `velo render`. The image does not depend on "
      "it.",
      ".sp");
  put_exit_status();
  printf(".SH EXAMPLES\n.EX\nvelo render scene.pbrt \\-o image.png\nvelo help render\n.EE\n");
}
