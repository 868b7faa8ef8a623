/* cli/command_words.c: see command_words.h. */
#include "cli/command_words.h"

#include <string.h>

int command_first_length(const Command *command) {
  return (int)strcspn(command->name, " ");
}

const char *command_second_word(const Command *command) {
  const char *gap = strchr(command->name, ' ');
  return gap ? gap + 1 : NULL;
}

bool command_begins_with(const Command *command, const char *word) {
  const size_t n = strlen(word);
  return n == (size_t)command_first_length(command) && strncmp(command->name, word, n) == 0;
}

bool command_same_first(const Command *a, const Command *b) {
  const int n = command_first_length(a);
  return n == command_first_length(b) && strncmp(a->name, b->name, (size_t)n) == 0;
}

bool command_leads(const Command *const *commands, const Command *command) {
  while (!command_same_first(*commands, command))
    commands++;
  return *commands == command;
}

bool command_leads_group(const Command *const *commands, const Command *command) {
  return command_second_word(command) && command_leads(commands, command);
}

const Command *command_find(const Command *const *commands, int count, const char *const *words,
                            int *used) {
  for (const Command *const *c = commands; count > 0 && *c; c++) {
    const char *second = command_second_word(*c);
    *used = second ? 2 : 1;
    if (*used <= count && command_begins_with(*c, words[0]) &&
        (!second || strcmp(second, words[1]) == 0))
      return *c;
  }
  return NULL;
}
