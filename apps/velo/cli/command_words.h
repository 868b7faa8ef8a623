/* cli/command_words.h: the words of commands: "image diff" has two, and belongs to the group
 * "image". Lists of commands end with null. */
#ifndef APP_CLI_COMMAND_WORDS_H
#define APP_CLI_COMMAND_WORDS_H

#include "cli/options.h"

/* Length of a command's first word. */
int command_first_length(const Command *command);
/* Null: it has one word. */
const char *command_second_word(const Command *command);
/* Whether the first word of a command is this one; whether it is that of another. */
bool command_begins_with(const Command *command, const char *word);
bool command_same_first(const Command *a, const Command *b);
/* Whether a command is the first of the list with its first word. */
bool command_leads(const Command *const *commands, const Command *command);
/* Whether it is the first of a group. */
bool command_leads_group(const Command *const *commands, const Command *command);
/* The command that the first of `count` words name, and how many these are; null: none. */
const Command *command_find(const Command *const *commands, int count, const char *const *words,
                            int *used);

#endif
