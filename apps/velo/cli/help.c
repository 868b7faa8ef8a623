/* cli/help.c: the help page of a command, from its table. See options.h. */
#include <stdio.h>
#include <string.h>

#include "cli/options.h"

enum { HELP_COLUMN = 32, HELP_WIDTH = 100 };

/* The text with its own line breaks, each line indented to the help column; *column says where the first one starts. */
static void print_indented(const char *text, int column) {
  while (*text) {
    size_t n = strcspn(text, "\n");
    printf("%*s%.*s\n", HELP_COLUMN - column, "", (int)n, text);
    text += n + (text[n] == '\n');
    column = 0;
  }
}

/* "a, b (or c), d": accepted names, aliases in parentheses, wrapped. */
static void print_choices(const Choice *choices) {
  int column = HELP_COLUMN;
  printf("%*s", HELP_COLUMN, "");
  for (const Choice *c = choices; c->name;) {
    char word[128];
    int n = snprintf(word, sizeof word, "%s", c->name);
    const Choice *alias = c + 1;
    for (; alias->name && alias->value == c->value; alias++)
      n += snprintf(word + n, sizeof word - (size_t)n, "%s%s", alias == c + 1 ? " (or " : ", ", alias->name);
    if (alias > c + 1) n += snprintf(word + n, sizeof word - (size_t)n, ")");
    if (alias->name) n += snprintf(word + n, sizeof word - (size_t)n, ",");
    if (column + n + 1 > HELP_WIDTH) {
      printf("\n%*s", HELP_COLUMN, "");
      column = HELP_COLUMN;
    }
    printf("%s%s", column > HELP_COLUMN ? " " : "", word);
    column += n + 1;
    c = alias;
  }
  printf("\n");
}

void options_print_help(const Command *command) {
  printf("usage: velo %s %s\n\n%s\n", command->name, command->usage, command->text);
  if (!command->options->name) return;
  printf("\noptions:\n");
  for (const Option *o = command->options; o->name; o++) {
    char head[80];
    int n = o->letter ? snprintf(head, sizeof head, "  -%c, --%s", o->letter, o->name)
                      : snprintf(head, sizeof head, "      --%s", o->name);
    if (o->value) n += snprintf(head + n, sizeof head - (size_t)n, " %s", o->value);
    printf("%s", head);
    if (n + 2 > HELP_COLUMN) {
      printf("\n");
      n = 0;
    }
    print_indented(o->help, n);
    if (o->choices) print_choices(o->choices);
  }
  printf("  -h, --help%*sthis page\n", HELP_COLUMN - 12, "");
}
