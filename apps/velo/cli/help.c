/* cli/help.c: the help page of a command, made from its table: usage, description, options in
 * sections, examples. See options.h. */
#include <stdio.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/options.h"
#include "cli/text.h"

enum { HELP_COLUMN = 30, HELP_WIDTH = 80 };

/* Prints a text, wrapped. Lines are indented by `indent`; the first starts at *column. One line
 * break in the text counts as a blank, two end a paragraph. A line that begins with a blank is
 * printed unchanged. */
static void print_wrapped(const char *text, int indent, int column) {
  while (*text) {
    if (*text == '\n') {
      bool paragraph = text[1] == '\n' || text[1] == ' ';
      if (paragraph) {
        printf(text[1] == '\n' ? "\n\n" : "\n");
        column = 0;
      }
      text += text[1] == '\n' ? 2 : 1;
      continue;
    }
    if (*text == ' ') {
      size_t skipped = column == 0 ? strcspn(text, "\n") : strspn(text, " ");
      if (column == 0)
        column = printf("%.*s", (int)skipped, text);
      text += skipped;
      continue;
    }
    size_t n = strcspn(text, " \n");
    if (column > indent && column + 1 + (int)n > HELP_WIDTH) {
      printf("\n");
      column = 0;
    }
    int gap = column < indent ? indent - column : column > 0 && column > indent ? 1 : 0;
    printf("%*s%.*s", gap, "", (int)n, text);
    column += gap + (int)n;
    text += n;
  }
  printf("\n");
}

const ExitStatus exit_statuses[] = {
    {"0", "done"},
    {"1", "findings of scene check, image diff or check over a threshold, or out of memory"},
    {"2", "wrong command line"},
    {"3", "wrong scene or image"},
    {"4", "missing file"},
    {"5", "reading or writing failed"},
    {"128 + signal",
     "stopped by it: 129 SIGHUP, 130 Ctrl-C, 138 SIGUSR1, 140 SIGUSR2, 143 SIGTERM, 152 "
     "SIGXCPU"},
    {0}};

void options_print_exit_statuses(void) {
  printf("exit codes:\n");
  for (const ExitStatus *s = exit_statuses; s->code; s++)
    print_wrapped(s->meaning, 16, printf("  %-12s", s->code));
}

/* Prints "a, b (or c), d": the accepted names with aliases in parentheses. */
static void print_choices(const Choice *choices) {
  char list[1200] = "";
  for (const Choice *c = choices; c->name;) {
    const Choice *alias = c + 1;
    text_add(list, sizeof list, "%s%s", list[0] ? " " : "", c->name);
    for (; alias->name && alias->value == c->value; alias++)
      text_add(list, sizeof list, "%s%s", alias == c + 1 ? " (or " : ", ", alias->name);
    text_add(list, sizeof list, "%s%s", alias > c + 1 ? ")" : "", alias->name ? "," : "");
    c = alias;
  }
  print_wrapped(list, HELP_COLUMN, 0);
}

static void print_option(const Option *o) {
  char head[80];
  int n = o->letter ? text_set(head, "  -%c, --%s", o->letter, o->name)
                    : text_set(head, "      --%s", o->name);
  if (o->value)
    n += snprintf(head + n, sizeof head - (size_t)n, " %s", o->value);
  printf("%s", head);
  if (n + 2 > HELP_COLUMN) {
    printf("\n");
    n = 0;
  }
  print_wrapped(o->help, HELP_COLUMN, n);
  if (option_choices(o))
    print_choices(option_choices(o));
}

static void print_examples(const char *text) {
  printf("\nexamples:\n");
  while (text && *text) {
    size_t n = strcspn(text, "\n");
    printf("  %.*s\n", (int)n, text);
    text += n + (text[n] == '\n');
  }
}

void options_print_help(const Command *command, bool all) {
  int column = printf("usage: velo %s", command->name);
  print_wrapped(command->usage, column + 1, column);
  printf("\n");
  if (command->brief && !all) {
    int count = 1; /* --help */
    for (const Option *o = command->options; o->name; o++)
      count++;
    printf("%s\nAll %d options: velo help %s --all\n", command->brief, count, command->name);
    return;
  }
  print_wrapped(command->text, 0, 0);
  if (!command->sections)
    printf("\noptions:\n");
  for (const Option *o = command->options; o->name; o++) {
    for (const Section *s = command->sections; s && s->title; s++)
      if (s->first == o->id)
        printf("\n%s:\n", s->title);
    print_option(o);
  }
  printf("%s  -h, --help%*sthis page\n", command->sections ? "\n" : "", HELP_COLUMN - 12, "");
  print_examples(command->examples);
}
