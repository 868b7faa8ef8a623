/* cli/completion.h: completion scripts of shells, made from the tables of the commands: `velo
 * help --completion`. */
#ifndef APP_CLI_COMPLETION_H
#define APP_CLI_COMPLETION_H

#include "cli/options.h"

typedef enum Shell { SHELL_BASH, SHELL_ZSH, SHELL_FISH } Shell;
extern const Choice shell_choices[];

/* Prints the completion script of velo for this shell to stdout: commands, options, the names
 * that options take, files and folders. commands: null ends them. */
void completion_print(Shell shell, const Command *const *commands);

#endif
