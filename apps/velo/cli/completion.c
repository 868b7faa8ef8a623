/* cli/completion.c: see completion.h. */
#include "cli/completion.h"

#include <stdio.h>
#include <string.h>

#include "cli/command_words.h"
#include "cli/macros.h"

const Choice shell_choices[] = {
    {"bash", SHELL_BASH}, {"zsh", SHELL_ZSH}, {"fish", SHELL_FISH}, {0}};

/* ---- what completes a value -------------------------------------------------------------- */

typedef enum Values { VALUES_UNKNOWN, VALUES_NAMES, VALUES_FILES, VALUES_FOLDERS } Values;

/* The placeholder of a text tells whether it is a file. */
static Values option_values(const Option *o) {
  static const char *const files[] = {"FILE", "IMAGE", "IMAGE.exr", "FILM", "RESULT", "OTHER"};
  switch (o->kind) {
    case OPTION_CHOICE:
    case OPTION_KIND:
      return VALUES_NAMES;
    case OPTION_FOLDERS:
    case OPTION_SEARCH:
      return VALUES_FOLDERS;
    case OPTION_TEXT:
    case OPTION_TEXTS:
      for (size_t i = 0; i < LENGTH(files); i++)
        if (strcmp(o->value, files[i]) == 0)
          return VALUES_FILES;
      return strcmp(o->value, "DIR") == 0 || strcmp(o->value, "FOLDER") == 0 ? VALUES_FOLDERS
                                                                             : VALUES_UNKNOWN;
    case OPTION_FLAG:
    case OPTION_INTEGER:
    case OPTION_NUMBER:
    case OPTION_ANGLE:
    case OPTION_POINT:
    case OPTION_TIME:
    case OPTION_BYTES:
    case OPTION_SIZE:
    case OPTION_CROP:
    case OPTION_FRACTIONS:
      break;
  }
  return VALUES_UNKNOWN;
}

static void put_names(const Option *o) {
  for (const Choice *c = option_choices(o); c->name; c++)
    printf("%s%s", c == option_choices(o) ? "" : " ", c->name);
}

/* Prints what a shell completes a value with. words: by Values; end: behind the names. */
static void put_values(const Option *o, const char *const words[], char end) {
  const Values values = option_values(o);
  fputs(words[values], stdout);
  if (values == VALUES_NAMES) {
    put_names(o);
    putchar(end);
  }
}

/* Whether the operand of a command is a family of velo/schema.h. */
static bool takes_family(const Command *command) {
  return strstr(command->usage, "FAMILY") != NULL;
}

static void put_families(void) {
  const vlKindFamily *family;
  for (uint32_t i = 0; (family = vl_kind_family(i)); i++)
    printf("%s%s", i ? " " : "", family->name);
}

/* ---- words of the commands --------------------------------------------------------------- */

/* Whether the operand of a command is a command: that of `velo help`. */
static bool takes_command(const Command *command) {
  return strstr(command->usage, "COMMAND") != NULL;
}

static void put_first_word(const Command *command) {
  printf("%.*s", command_first_length(command), command->name);
}

/* Prints the first words of all commands. */
static void put_first_words(const Command *const *commands) {
  for (const Command *const *c = commands; *c; c++) {
    if (!command_leads(commands, *c))
      continue;
    fputs(c == commands ? "" : " ", stdout);
    put_first_word(*c);
  }
}

/* Prints the second words of the commands that begin as `command`. */
static void put_second_words(const Command *const *commands, const Command *command) {
  const char *gap = "";
  for (const Command *const *c = commands; *c; c++) {
    if (!command_same_first(*c, command))
      continue;
    printf("%s%s", gap, command_second_word(*c));
    gap = " ";
  }
}

/* Length of the first clause of a help text, without a parenthesis that it would cut. */
static size_t clause_length(const char *text) {
  size_t n = 0, open = 0;
  while (text[n] && !(strchr(".;:", text[n]) && (text[n + 1] == ' ' || !text[n + 1]))) {
    if (text[n] == '(')
      open = n;
    if (text[n] == ')')
      open = 0;
    n++;
  }
  return open ? open - 1 : n;
}

/* Prints the first clause of a text inside single quotes; `escaped` characters get a
 * backslash. */
static void put_clause(const char *text, const char *escaped, bool fish) {
  size_t n = clause_length(text);
  for (size_t i = 0; i < n; i++) {
    if (text[i] == '\'') {
      fputs(fish ? "\\'" : "'\\''", stdout);
    } else {
      if (strchr(escaped, text[i]))
        putchar('\\');
      putchar(text[i]);
    }
  }
}

/* ---- bash -------------------------------------------------------------------------------- */

static const char bash_head[] =
    "# bash completion of velo; written by `velo help --completion bash`\n"
    "_velo() {\n"
    "  local cur=${COMP_WORDS[COMP_CWORD]} option= command= at=2 kind=files names= "
    "options=\n"
    "  ((COMP_CWORD > 1)) && option=${COMP_WORDS[COMP_CWORD - 1]}\n"
    "  # --option=value is three words\n"
    "  if [[ $cur == = ]]; then\n"
    "    cur=\n"
    "  elif [[ $option == = ]]; then\n"
    "    option=${COMP_WORDS[COMP_CWORD - 2]}\n"
    "  fi\n"
    "  command=${COMP_WORDS[1]}\n"
    "  case $command in\n";

static const char bash_tail[] =
    "  esac\n"
    "  if [[ $kind != value* && $kind != names && $cur == -* ]]; then\n"
    "    kind=names names=$options\n"
    "  fi\n"
    "  COMPREPLY=()\n"
    "  case ${kind#value} in\n"
    "    names | operand) mapfile -t COMPREPLY < <(compgen -W \"$names\" -- \"$cur\") ;;\n"
    "    files)\n"
    "      compopt -o filenames 2>/dev/null\n"
    "      mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
    "      ;;\n"
    "    folders)\n"
    "      compopt -o filenames 2>/dev/null\n"
    "      mapfile -t COMPREPLY < <(compgen -d -- \"$cur\")\n"
    "      ;;\n"
    "  esac\n"
    "}\n"
    "complete -F _velo velo\n";

/* Prints the second words of each group: before GROUP between WORDS after. */
static void put_groups(const Command *const *commands, const char *before, const char *between,
                       const char *after) {
  for (const Command *const *c = commands; *c; c++) {
    if (!command_leads_group(commands, *c))
      continue;
    fputs(before, stdout);
    put_first_word(*c);
    fputs(between, stdout);
    put_second_words(commands, *c);
    fputs(after, stdout);
  }
}

static void bash_option(const Option *o) {
  static const char *const words[] = {[VALUES_UNKNOWN] = "value",
                                      [VALUES_NAMES] = "names names='",
                                      [VALUES_FILES] = "valuefiles",
                                      [VALUES_FOLDERS] = "valuefolders"};
  if (o->kind == OPTION_FLAG)
    return;
  printf("        ");
  if (o->letter)
    printf("-%c | ", o->letter);
  printf("--%s) kind=", o->name);
  put_values(o, words, '\'');
  printf(" ;;\n");
}

static void bash_command(const Command *const *commands, const Command *command) {
  printf("    '%s')\n      options='", command->name);
  for (const Option *o = command->options; o->name; o++) {
    printf("--%s ", o->name);
    if (o->letter)
      printf("-%c ", o->letter);
  }
  printf("--help -h'\n");
  if (takes_family(command)) {
    printf("      kind=operand names='");
    put_families();
    printf("'\n");
  }
  if (takes_command(command)) {
    printf(
        "      kind=operand\n"
        "      case ${COMP_WORDS[COMP_CWORD - 1]} in\n"
        "        help) names='");
    put_first_words(commands);
    printf("' ;;\n");
    put_groups(commands, "        ", ") names='", "' ;;\n");
    printf("      esac\n");
  }
  if (command->options->name) {
    printf("      case $option in\n");
    for (const Option *o = command->options; o->name; o++)
      bash_option(o);
    printf("      esac\n");
  }
  printf("      ;;\n");
}

static void print_bash(const Command *const *commands) {
  fputs(bash_head, stdout);
  put_groups(commands, "    ", ")\n      command+=\" ${COMP_WORDS[2]}\" at=3 names='",
             "'\n      ;;\n");
  printf("  esac\n  if ((COMP_CWORD == 1)); then\n    names='");
  put_first_words(commands);
  printf(
      " --version --help'\n"
      "  fi\n"
      "  ((COMP_CWORD < at)) && command= kind=names\n"
      "  case $command in\n");
  for (const Command *const *c = commands; *c; c++)
    bash_command(commands, *c);
  fputs(bash_tail, stdout);
}

/* ---- zsh --------------------------------------------------------------------------------- */

static void zsh_option(const Option *o) {
  static const char *const words[] = {[VALUES_UNKNOWN] = " ",
                                      [VALUES_NAMES] = "(",
                                      [VALUES_FILES] = "_files",
                                      [VALUES_FOLDERS] = "_files -/"};
  bool repeated =
      o->kind == OPTION_TEXTS || o->kind == OPTION_FOLDERS || o->kind == OPTION_SEARCH;
  const char *end = o->kind == OPTION_FLAG ? "" : "=";
  printf("        ");
  if (o->letter) {
    if (repeated)
      printf("'*'");
    if (!repeated)
      printf("'(-%c --%s)'", o->letter, o->name);
    printf("{-%c%s,--%s%s}'", o->letter, *end ? "+" : "", o->name, end);
  } else {
    printf("'%s--%s%s", repeated ? "*" : "", o->name, end);
  }
  putchar('[');
  put_clause(o->help, "[]:\\", false);
  putchar(']');
  if (o->kind != OPTION_FLAG) {
    putchar(':');
    for (const char *c = o->value; *c; c++)
      printf("%s%c", *c == ':' ? "\\" : "", *c);
    putchar(':');
    put_values(o, words, ')');
  }
  printf("' \\\n");
}

/* Prints a call of _describe: commands with their summaries. family: null for the first
 * words. */
static void zsh_describe(const Command *const *commands, const Command *family) {
  printf("    names=(\n");
  for (const Command *const *c = commands; *c; c++) {
    if (family ? !command_same_first(*c, family) : !command_leads(commands, *c))
      continue;
    const int n = command_first_length(*c);
    const char *second = command_second_word(*c);
    if (family)
      printf("      '%s:", second);
    else
      printf("      '%.*s:", n, (*c)->name);
    if (second && !family)
      printf("commands about %.*ss", n, (*c)->name);
    else
      put_clause((*c)->summary, ":\\", false);
    printf("'\n");
  }
  printf("    )\n    _describe -t commands 'velo command' names\n    return\n");
}

static void zsh_command(const Command *const *commands, const Command *command) {
  printf("    '%s')\n      _arguments -s -S \\\n", command->name);
  for (const Option *o = command->options; o->name; o++)
    zsh_option(o);
  printf("        '(-h --help)'{-h,--help}'[print the options]' \\\n        ");
  if (takes_family(command)) {
    printf("'1:family:(");
    put_families();
    printf(")'\n");
  } else if (takes_command(command)) {
    printf("'1:command:(");
    put_first_words(commands);
    printf(")' '2:command: '\n");
  } else {
    printf("'*:file:_files'\n");
  }
  printf("      ;;\n");
}

static void print_zsh(const Command *const *commands) {
  printf(
      "#compdef velo\n"
      "# written by `velo help --completion zsh`\n"
      "_velo() {\n"
      "  local command=$words[2]\n"
      "  local -a names\n");
  printf("  if ((CURRENT == 2)); then\n");
  zsh_describe(commands, NULL);
  printf("  fi\n");
  for (const Command *const *c = commands; *c; c++) {
    if (!command_leads_group(commands, *c))
      continue;
    printf("  if [[ $command == ");
    put_first_word(*c);
    printf(" ]] && ((CURRENT == 3)); then\n");
    zsh_describe(commands, *c);
    printf("  fi\n");
  }
  printf("  case $command in\n    ");
  const char *gap = "";
  for (const Command *const *c = commands; *c; c++) {
    if (!command_leads_group(commands, *c))
      continue;
    fputs(gap, stdout);
    put_first_word(*c);
    gap = " | ";
  }
  printf(
      ")\n"
      "      command+=\" $words[3]\"\n"
      "      shift 2 words\n"
      "      ((CURRENT -= 2))\n"
      "      ;;\n"
      "    *)\n"
      "      shift words\n"
      "      ((CURRENT -= 1))\n"
      "      ;;\n"
      "  esac\n"
      "  case $command in\n");
  for (const Command *const *c = commands; *c; c++)
    zsh_command(commands, *c);
  printf("  esac\n}\n_velo \"$@\"\n");
}

/* ---- fish -------------------------------------------------------------------------------- */

static const char fish_head[] =
    "# fish completion of velo; written by `velo help --completion fish`\n"
    "function __velo_words_are --description 'whether the words before the cursor are "
    "exactly these'\n"
    "  set -l words (commandline -opc)\n"
    "  set -e words[1]\n"
    "  test \"$words\" = \"$argv\"\n"
    "end\n"
    "function __velo_command_is --description 'whether the words before the cursor begin "
    "with these'\n"
    "  set -l words (commandline -opc)\n"
    "  set -e words[1]\n"
    "  set -l n (count $argv)\n"
    "  test (count $words) -ge $n; and test \"$words[1..$n]\" = \"$argv\"\n"
    "end\n";

static void fish_option(const Command *command, const Option *o) {
  static const char *const words[] = {
      [VALUES_UNKNOWN] = " -x",
      [VALUES_NAMES] = " -x -a '",
      [VALUES_FILES] = " -r -F",
      [VALUES_FOLDERS] = " -x -a '(__fish_complete_directories)'"};
  printf("complete -c velo -n '__velo_command_is %s' -l %s", command->name, o->name);
  if (o->letter)
    printf(" -s %c", o->letter);
  if (o->kind != OPTION_FLAG)
    put_values(o, words, '\'');
  printf(" -d '");
  put_clause(o->help, "\\", true);
  printf("'\n");
}

static void fish_word(const char *condition, int length, const char *word, const char *text) {
  printf("complete -c velo -f -n '%s' -a '%.*s'", condition, length, word);
  if (text) {
    printf(" -d '");
    put_clause(text, "\\", true);
    putchar('\'');
  }
  putchar('\n');
}

static void fish_words(const Command *const *commands, const Command *command) {
  const int n = command_first_length(command);
  const char *second = command_second_word(command);
  char condition[80];
  if (command_leads(commands, command)) {
    fish_word("__velo_words_are", n, command->name, second ? NULL : command->summary);
    fish_word("__velo_words_are help", n, command->name, NULL);
  }
  if (!second)
    return;
  text_set(condition, "__velo_words_are %.*s", n, command->name);
  fish_word(condition, 100, second, command->summary);
  text_set(condition, "__velo_words_are help %.*s", n, command->name);
  fish_word(condition, 100, second, NULL);
}

static void fish_command(const Command *command) {
  for (const Option *o = command->options; o->name; o++)
    fish_option(command, o);
  printf("complete -c velo -n '__velo_command_is %s' -l help -s h -d 'print the options'\n",
         command->name);
  if (takes_family(command)) {
    printf("complete -c velo -f -n '__velo_command_is %s' -a '", command->name);
    put_families();
    printf("'\n");
  }
  if (takes_command(command))
    printf("complete -c velo -f -n '__velo_command_is %s'\n", command->name);
}

static void print_fish(const Command *const *commands) {
  fputs(fish_head, stdout);
  for (const Command *const *c = commands; *c; c++)
    fish_words(commands, *c);
  for (const Command *const *c = commands; *c; c++)
    fish_command(*c);
}

void completion_print(Shell shell, const Command *const *commands) {
  switch (shell) {
    case SHELL_BASH:
      print_bash(commands);
      break;
    case SHELL_ZSH:
      print_zsh(commands);
      break;
    case SHELL_FISH:
      print_fish(commands);
      break;
  }
}
